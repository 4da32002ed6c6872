//! The lattice: where light points lie, and the numbering of formula (7).

use glam::{IVec3, Vec3};
use lightmesh_scene::Bounds;

/// A regular cubic lattice of light points around the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Position of light point (0, 0, 0), local frame.
    pub origin: Vec3,
    /// Distance h between neighbours, scene units.
    pub step: f32,
    /// Number of light points along each axis.
    pub dims: [u32; 3],
}

/// A lattice that cannot be numbered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LatticeError {
    /// The step is zero, negative, infinite or NaN.
    #[error("light-mesh step {step} is not a positive number: choose --step H with H above 0, or --step auto")]
    Step {
        /// What was asked for.
        step: f32,
    },
    /// More points along an axis than can be told apart.
    #[error(
        "light-mesh step h = {step} puts {points:.0} light points along one axis of the scene, more than {max}: choose --step {least} or more",
        max = Lattice::MAX_DIM
    )]
    TooFine {
        /// What was asked for.
        step: f32,
        /// Points along the longest axis.
        points: f64,
        /// A step that would do.
        least: f32,
    },
}

impl Lattice {
    /// Most light points along one axis: their indices are exact in `f32`, and three of them fit into 63 bits.
    pub const MAX_DIM: u32 = 1 << 21;

    /// Lattice planes are moved off the scene's own planes by this part of a step. Floors and walls tend to lie on round
    /// coordinates; a light point must not lie in one.
    const OFFSET: Vec3 = Vec3::new(0.137, 0.241, 0.319);

    /// The lattice of step `step` that reaches `reach` steps beyond `bounds` on every side.
    ///
    /// It depends on the scene alone, not on the camera: light points keep their numbers from picture to picture.
    pub fn around(bounds: &Bounds, step: f32, reach: f32) -> Result<Lattice, LatticeError> {
        if !(step > 0.0 && step.is_finite()) {
            return Err(LatticeError::Step { step });
        }
        let margin = f64::from(reach).ceil() + 2.0;
        let extent = if bounds.is_empty() { Vec3::ZERO } else { bounds.extent() };
        let points = extent.to_array().map(|length| (f64::from(length) / f64::from(step)).ceil() + 2.0 * margin + 1.0);
        let most = points.into_iter().fold(0.0, f64::max);
        if most > f64::from(Self::MAX_DIM) {
            let free = f64::from(Self::MAX_DIM) - 2.0 * margin - 2.0;
            let least = (f64::from(extent.max_element()) / free) as f32 * 1.001;
            return Err(LatticeError::TooFine { step, points: most, least });
        }
        let lowest = if bounds.is_empty() { Vec3::ZERO } else { bounds.min };
        let origin = lowest - step * (Vec3::splat(margin as f32) + Self::OFFSET);
        Ok(Lattice { origin, step, dims: points.map(|count| count as u32) })
    }

    /// Position of light point `index`, local frame.
    #[inline(always)]
    pub fn point(&self, index: IVec3) -> Vec3 {
        self.origin + self.step * index.as_vec3()
    }

    /// The cell that holds `position`.
    #[inline(always)]
    pub fn cell(&self, position: Vec3) -> IVec3 {
        ((position - self.origin) / self.step).floor().as_ivec3()
    }

    /// Formula (7): the number of light point `index` in row-major order.
    pub fn packed(&self, index: IVec3) -> u64 {
        let [x, y, z] = index.to_array().map(|i| i as u64);
        let [nx, ny, _] = self.dims.map(u64::from);
        nx * ny * z + nx * y + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(size: f32) -> Bounds {
        Bounds { min: Vec3::ZERO, max: Vec3::splat(size) }
    }

    #[test]
    fn every_point_that_a_surface_may_use_is_inside() {
        let lattice = Lattice::around(&cube(10.0), 0.7, 3.1).unwrap();
        let low = lattice.cell(Vec3::ZERO);
        let high = lattice.cell(Vec3::splat(10.0));
        assert!(low.min_element() >= 4, "{low}");
        let room = IVec3::from_array(lattice.dims.map(|n| n as i32)) - high;
        assert!(room.min_element() > 5, "{room}");
    }

    #[test]
    fn a_point_lies_in_its_own_cell() {
        let lattice = Lattice::around(&cube(10.0), 0.3, 2.1).unwrap();
        let index = IVec3::new(5, 17, 30);
        assert_eq!(lattice.cell(lattice.point(index) + Vec3::splat(0.15)), index);
    }

    #[test]
    fn packed_numbers_do_not_overflow_beyond_1625_cubed() {
        let lattice = Lattice::around(&cube(2000.0), 1.0, 2.1).unwrap();
        let last = IVec3::from_array(lattice.dims.map(|n| n as i32)) - 1;
        let [nx, ny, nz] = lattice.dims.map(u64::from);
        assert!(lattice.packed(last) > u64::from(u32::MAX));
        assert_eq!(lattice.packed(last), nx * ny * nz - 1);
    }

    #[test]
    fn a_step_that_cannot_be_numbered_is_refused_with_one_that_can() {
        let Err(LatticeError::TooFine { least, .. }) = Lattice::around(&cube(100.0), 1e-6, 2.1) else {
            panic!("must be refused");
        };
        assert!(Lattice::around(&cube(100.0), least, 2.1).is_ok());
        for step in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(Lattice::around(&cube(1.0), step, 2.1), Err(LatticeError::Step { .. })));
        }
    }
}
