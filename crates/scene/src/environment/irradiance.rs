//! What a panorama gives to surfaces with nothing in between: integrals over all directions.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::{Environment, levels};

/// Irradiance changes so slowly that it is computed from a mean with fewer columns than this.
const MOST_COLUMNS: u32 = 512;

impl Environment {
    /// The mean radiance over all directions, without the sun.
    pub fn mean(&self) -> Vec3 {
        (self.integral(|_| 1.0) / (4.0 * PI)).as_vec3()
    }

    /// What a surface that faces `normal` receives of the image, without the sun and with nothing in between.
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        let normal = normal.as_dvec3();
        self.integral(|direction| normal.dot(direction).max(0.0)).as_vec3()
    }

    /// The irradiance of surfaces with a unit normal n, divided by π, within a few percent (Ramamoorthi, Hanrahan: *An Efficient
    /// Representation for Irradiance Environment Maps*, SIGGRAPH 2001): coefficients of 1, x, y, z, xy, yz, zx, z² and x² − y².
    pub fn irradiance_terms(&self) -> [Vec3; 9] {
        // Spherical harmonics, multiplied by what a cosine keeps of them: 1, 2/3 and 1/4 of each degree.
        let harmonic = |scale: f64, basis: &dyn Fn(DVec3) -> f64| scale * scale * self.integral(basis);
        let constant = harmonic(0.282_095, &|_| 1.0);
        let axis = |basis: &dyn Fn(DVec3) -> f64| 2.0 / 3.0 * harmonic(0.488_603, basis);
        let product = |basis: &dyn Fn(DVec3) -> f64| 0.25 * harmonic(1.092_548, basis);
        let zonal = 0.25 * harmonic(0.315_392, &|d| 3.0 * d.z * d.z - 1.0);
        let terms = [
            constant - zonal,
            axis(&|d| d.x),
            axis(&|d| d.y),
            axis(&|d| d.z),
            product(&|d| d.x * d.y),
            product(&|d| d.y * d.z),
            product(&|d| d.z * d.x),
            3.0 * zonal,
            0.25 * harmonic(0.546_274, &|d| d.x * d.x - d.y * d.y),
        ];
        terms.map(|term| term.as_vec3())
    }

    /// The integral of radiance times `weight` over all directions.
    fn integral(&self, weight: impl Fn(DVec3) -> f64) -> DVec3 {
        let coarse = self.levels().iter().find(|level| level.size[0] <= MOST_COLUMNS);
        let (size, texels) = match coarse.filter(|_| self.size[0] > MOST_COLUMNS) {
            Some(level) => (level.size, &level.texels),
            None => (self.size, &self.levels.image),
        };
        let mut sum = DVec3::ZERO;
        for (row, texels) in texels.chunks_exact(size[0] as usize).enumerate() {
            let mut of_row = DVec3::ZERO;
            for (column, texel) in texels.iter().enumerate() {
                let direction = self.direction_in(size, column as u32, row as u32).as_dvec3();
                of_row += weight(direction) * Vec3::from_array(*texel).as_dvec3();
            }
            sum += of_row * f64::from(levels::band(row as u32, size[1]));
        }
        sum * TAU / f64::from(size[0])
    }
}
