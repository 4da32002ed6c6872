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
    pub const OFFSET: DVec3 = DVec3::new(0.137, 0.241, 0.319);

    /// Multiples of h beyond which double precision cannot distinguish the light points of the world.
    const MAX_IN_WORLD: f64 = (1u64 << 50) as f64;

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
    pub fn new(origin: DVec3, bounds: &Bounds, step: f32, reach: f32) -> Result<Lattice, LatticeError> {
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
    here.max(origin.abs().max_element() / Lattice::MAX_IN_WORLD)
}

/// Light points beyond those around the scene: those that its surface points may use, and a margin for rounding.
fn margin(reach: f32) -> f64 {
    f64::from(reach).ceil() + 2.0
}
