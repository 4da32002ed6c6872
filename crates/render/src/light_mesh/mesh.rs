//! The light mesh of one image.

use super::lattice::Lattice;
use super::template::Template;

/// Everything that stages need to know about the light mesh of one image.
#[derive(Clone, Debug)]
pub struct LightMesh {
    /// Positions of the light points.
    pub lattice: Lattice,
    /// Formula (6) for the chosen radius.
    pub template: Template,
    /// Interpolation radius r in scene units.
    pub radius: f32,
    /// w of formula (3).
    pub weight: lightmesh_scene::Weight,
}

impl LightMesh {
    /// The smallest `(n, x − P)` that a light point must exceed to be used, in scene units. A thousandth of a step keeps
    /// lattice planes that coincide with a surface from flickering in and out of its half-ball.
    pub fn least_height(&self) -> f32 {
        1e-3 * self.lattice.step
    }

    /// How close a triangle's plane may pass to a segment's origin before the triangle counts as edge-on, in scene units. Below
    /// that, rounding would decide: the distance to the plane of a triangle within reach, R steps away, errs by a few ε R h.
    /// What is ignored leaks light into pixels this close to the foot of a wall without thickness, so the value must not be
    /// larger.
    pub fn edge_on(&self) -> f32 {
        2e-6 * self.lattice.step
    }

    /// How much boxes are enlarged before triangles are looked up for short tests, in scene units: far above rounding, far
    /// below a step.
    pub fn slack(&self) -> f32 {
        1e-3 * self.lattice.step
    }
}
