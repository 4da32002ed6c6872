//! What a panorama gives to surfaces with nothing in between: integrals over all directions.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::directions::direction;
use super::harmonics::{Irradiance, basis};
use super::levels;
use super::panorama::Environment;

/// Irradiance changes so slowly that it is computed from a mean with no more columns than this.
const MAX_COLUMNS: u32 = 256;

impl Environment {
    /// The mean radiance over all directions, without what is lights.
    pub fn mean(&self) -> Vec3 {
        self.all_irradiance().mean
    }

    /// The irradiance of surfaces with a unit normal n, without that of lights, divided by π, within a few percent (Ramamoorthi, Hanrahan: *An Efficient
    /// Representation for Irradiance Environment Maps*, SIGGRAPH 2001): coefficients of 1, x, y, z, xy, yz, zx, z² and x² − y².
    pub fn irradiance_terms(&self) -> [Vec3; 9] {
        self.all_irradiance().terms
    }

    fn all_irradiance(&self) -> &Irradiance {
        let rest = self.gathered();
        rest.levels.irradiance.get_or_init(|| Irradiance::of(&rest.integrals(basis)))
    }

    /// What a surface that faces `normal` receives of the image, without the sun and with nothing in between.
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        let normal = normal.as_dvec3();
        let [sum] = self.integrals(|direction| [normal.dot(direction).max(0.0)]);
        sum.as_vec3()
    }

    /// The integrals of radiance times weights over all directions.
    fn integrals<const N: usize>(&self, weights: impl Fn(DVec3) -> [f64; N]) -> [DVec3; N] {
        let coarse = self.levels().iter().find(|level| level.size[0] <= MAX_COLUMNS);
        let (size, texels) = match coarse.filter(|_| self.size[0] > MAX_COLUMNS) {
            Some(level) => (level.size, &level.texels),
            None => (self.size, &self.levels.image),
        };
        let mut sums = [DVec3::ZERO; N];
        for (row, texels) in texels.chunks_exact(size[0] as usize).enumerate() {
            let solid = f64::from(levels::band(row as u32, size[1])) * TAU / f64::from(size[0]);
            for (column, texel) in texels.iter().enumerate() {
                let toward = direction(self.frame(), size, [column as u32, row as u32]).as_dvec3();
                let light = solid * Vec3::from_array(*texel).as_dvec3();
                for (sum, weight) in sums.iter_mut().zip(weights(toward)) {
                    *sum += weight * light;
                }
            }
        }
        sums
    }
}
