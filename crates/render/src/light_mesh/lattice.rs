//! The lattice: the positions of light points, and the numbering of formula (7).
//!
//! Light point i lies at (i + offset)·h in the world, whatever the scene contains: neither the scene's extent nor the camera moves it.
//! Indices count from the light point nearest to the origin of the local frame, so that they are small and exact in `f32`.

use glam::{DVec3, IVec3, UVec3, Vec3};
use lightmesh_layout::constants::{INDEX_BIAS, INDEX_BITS};
use lightmesh_scene::Bounds;

use super::lattice_error::LatticeError;
use crate::prepared::PreparedScene;

/// A regular cubic lattice of light points, of which a part covers the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Position of light point (0, 0, 0), local frame: less than a step from zero on each axis.
    pub anchor: Vec3,
    /// Distance h between neighbours, scene units.
    pub step: f32,
    /// The world index of light point (0, 0, 0), of which the lowest 21 bits are kept.
    pub number: UVec3,
    /// The lowest light point that covers the scene.
    pub first: IVec3,
    /// Number of light points along each axis that cover the scene.
    pub dims: [u32; 3],
}

impl Lattice {
    /// Lattice planes are offset from the multiples of h by this fraction of a step. Floors and walls tend to lie on round coordinates;
    /// no light point may lie in one of them.
    const OFFSET: DVec3 = DVec3::new(0.137, 0.241, 0.319);

    /// Multiples of h beyond which double precision cannot distinguish the light points of the world.
    const MOST_IN_WORLD: f64 = (1u64 << 50) as f64;

    /// The lattice of step `step` that reaches `reach` steps beyond the scene's triangles on every side.
    ///
    /// # Errors
    /// [`LatticeError`] if the step is not a positive number, or too small for the scene.
    pub fn around(scene: &PreparedScene, step: f32, reach: f32) -> Result<Lattice, LatticeError> {
        Lattice::covering(scene, &scene.geometry.bounds, step, reach)
    }

    /// The same beyond `bounds` in place of the scene's triangles.
    ///
    /// # Errors
    /// [`LatticeError`] if the step is no positive number, or too small for the bounds.
    pub fn covering(scene: &PreparedScene, bounds: &Bounds, step: f32, reach: f32) -> Result<Lattice, LatticeError> {
        Lattice::new(scene.scene.geometry.origin, bounds, step, reach)
    }

    /// The same for triangles within `bounds`, in a frame whose origin is at `origin` in the world.
    fn new(origin: DVec3, bounds: &Bounds, step: f32, reach: f32) -> Result<Lattice, LatticeError> {
        if !(step > 0.0 && step.is_finite()) {
            return Err(LatticeError::Step { step });
        }
        let bounds = if bounds.is_empty() { Bounds { min: Vec3::ZERO, max: Vec3::ZERO } } else { *bounds };
        let least = least_step(origin, &bounds, reach);
        if f64::from(step) < least {
            let reach = f64::from(bounds.farthest()).max(origin.abs().max_element());
            return Err(LatticeError::TooFine { step, reach, least: least as f32 * 1.001 });
        }
        let h = f64::from(step);
        let nearest = (origin / h).round();
        let number = nearest.rem_euclid(DVec3::splat(f64::from(1u32 << INDEX_BITS))).as_uvec3();
        let anchor = ((nearest + Self::OFFSET) * h - origin).as_vec3();
        let mut lattice = Lattice { anchor, step, number, first: IVec3::ZERO, dims: [0; 3] };
        let margin = margin(reach) as i32;
        lattice.first = lattice.cell(bounds.min) - margin;
        lattice.dims = (lattice.cell(bounds.max) + margin + 1 - lattice.first).as_uvec3().to_array();
        Ok(lattice)
    }

    /// The finest step for a scene and a radius of `reach` steps.
    pub(crate) fn finest(scene: &PreparedScene, reach: f32) -> f32 {
        let bounds = &scene.geometry.bounds;
        if bounds.is_empty() { 0.0 } else { (least_step(scene.scene.geometry.origin, bounds, reach) * 1.001) as f32 }
    }

    /// Position of light point `index`, local frame.
    #[inline(always)]
    pub fn point(&self, index: IVec3) -> Vec3 {
        self.anchor + self.step * index.as_vec3()
    }

    /// The cell that contains `position`.
    #[inline(always)]
    pub fn cell(&self, position: Vec3) -> IVec3 {
        ((position - self.anchor) / self.step).floor().as_ivec3()
    }

    /// Formula (7): the number of light point `index` in row-major order, in a lattice of 2²¹ points along each axis. It repeats beyond.
    #[inline(always)]
    pub fn packed(&self, index: IVec3) -> u64 {
        let world = |number: u32, index: i32| u64::from(number.wrapping_add(index as u32) & ((1 << INDEX_BITS) - 1));
        let [x, y, z] = [0, 1, 2].map(|axis| world(self.number[axis], index[axis]));
        z << (2 * INDEX_BITS) | y << INDEX_BITS | x
    }
}

/// The smallest step for which no index has more bits than keys have room for: they are exact in `f32`, and three of them fit into 63
/// bits.
fn least_step(origin: DVec3, bounds: &Bounds, reach: f32) -> f64 {
    let here = f64::from(bounds.farthest()) / (f64::from(INDEX_BIAS) - margin(reach) - 2.0);
    here.max(origin.abs().max_element() / Lattice::MOST_IN_WORLD)
}

/// Light points beyond those around the scene: those that its surface points may use, and a margin for rounding.
fn margin(reach: f32) -> f64 {
    f64::from(reach).ceil() + 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const FAR: DVec3 = DVec3::new(512.0, -65536.0, 3.0e6);

    fn cube(size: f32) -> Bounds {
        Bounds { min: Vec3::ZERO, max: Vec3::splat(size) }
    }

    fn lattice(origin: DVec3, bounds: Bounds, step: f32) -> Lattice {
        Lattice::new(origin, &bounds, step, 3.1).unwrap()
    }

    #[test]
    fn every_point_that_a_surface_may_use_is_covered() {
        for origin in [DVec3::ZERO, FAR] {
            let lattice = lattice(origin, cube(10.0), 0.7);
            let low = lattice.cell(Vec3::ZERO) - lattice.first;
            let high = lattice.cell(Vec3::splat(10.0)) - lattice.first;
            assert!(low.min_element() >= 4, "{low}");
            let room = IVec3::from_array(lattice.dims.map(|n| n as i32)) - high;
            assert!(room.min_element() > 5, "{room}");
        }
    }

    #[test]
    fn a_point_lies_in_its_own_cell() {
        let lattice = lattice(FAR, cube(10.0), 0.3);
        for index in [IVec3::new(5, 17, 30), IVec3::new(-5, 0, -1)] {
            assert_eq!(lattice.cell(lattice.point(index) + Vec3::splat(0.15)), index);
        }
    }

    #[test]
    fn light_points_lie_at_multiples_of_the_step_moved_by_the_offset() {
        for (origin, step) in [(DVec3::ZERO, 0.3_f32), (FAR, 0.3), (FAR, 1e3), (DVec3::splat(-0.1), 7.0)] {
            let lattice = lattice(origin, cube(10.0), step);
            for index in [lattice.first, IVec3::ZERO, IVec3::new(3, -4, 5)] {
                let world = origin + lattice.point(index).as_dvec3();
                let steps = world / f64::from(step) - Lattice::OFFSET;
                assert!((steps - steps.round()).abs().max_element() < 1e-5, "h = {step}: {steps}");
                let bits = |axis: usize| (lattice.packed(index) >> (21 * axis) & 0x1f_ffff) as f64;
                let number = DVec3::new(bits(0), bits(1), bits(2));
                assert_eq!(number, steps.round().rem_euclid(DVec3::splat(2_097_152.0)), "h = {step}");
            }
        }
    }

    #[test]
    fn the_extent_of_a_scene_moves_no_light_point() {
        let index = IVec3::new(7, -3, 11);
        let some = lattice(FAR, cube(10.0), 0.3);
        let more = lattice(FAR, Bounds { min: Vec3::splat(-77.7), max: Vec3::splat(1234.5) }, 0.3);
        assert_ne!((some.first, some.dims), (more.first, more.dims));
        assert_eq!((some.point(index), some.packed(index)), (more.point(index), more.packed(index)));
    }

    #[test]
    fn light_points_of_a_scene_have_numbers_of_their_own() {
        let lattice = lattice(DVec3::splat(1.0e6), Bounds { min: Vec3::splat(-1e6), max: Vec3::splat(1e6) }, 1.0);
        let corner = |index: usize| {
            lattice.first
                + IVec3::from_array(
                    [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { 0 } else { lattice.dims[axis] as i32 - 1 }),
                )
        };
        let mut numbers: Vec<u64> = (0..8).map(|index| lattice.packed(corner(index))).collect();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), 8);
        assert!(numbers[7] < 1 << 63);
    }

    #[test]
    fn a_step_that_cannot_be_numbered_is_refused_with_one_that_can() {
        for origin in [DVec3::ZERO, DVec3::splat(1e14)] {
            let Err(LatticeError::TooFine { least, .. }) = Lattice::new(origin, &cube(100.0), 1e-6, 2.1) else {
                panic!("must be rejected");
            };
            assert!(Lattice::new(origin, &cube(100.0), least, 2.1).is_ok());
        }
        for step in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(Lattice::new(DVec3::ZERO, &cube(1.0), step, 2.1), Err(LatticeError::Step { .. })));
        }
    }
}
