//! The plain short tests: every segment through the acceleration structure. The reference.

use glam::Vec3;
use lightmesh_trace::accel::triangle::dot_along_x;
use lightmesh_trace::accel::{ShortSegments, ShortTest};

use super::MaskCounts;
use crate::data::masks::population;
use crate::light_mesh::{CellPoints, LightMesh};
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

/// Room for the segments of one surface point.
#[derive(Default)]
pub(crate) struct Scratch {
    bits: Vec<usize>,
    directions: Vec<Vec3>,
    blocked: Vec<bool>,
}

impl Scratch {
    /// The mask of one surface point, cell by cell.
    pub(crate) fn mask(
        &mut self,
        scene: &PreparedScene,
        mesh: &LightMesh,
        points: &CellPoints,
        point: &SurfacePoint,
        mask: &mut [u32],
    ) -> MaskCounts {
        let Scratch { bits, directions, blocked } = self;

        // 1, 2. The half-ball.
        half_ball(mesh, points, point, mask);
        bits.clear();
        bits.extend((0..mesh.template.len()).filter(|bit| mask[bit / 32] >> (bit % 32) & 1 != 0));

        // 3. Its segments.
        directions.clear();
        directions.extend(bits.iter().map(|&bit| points.get(bit) - point.origin));
        blocked.clear();
        blocked.resize(bits.len(), false);
        let test = ShortTest { origin: point.origin, normal: point.normal, edge_on: mesh.edge_on() };
        let geometry = &scene.geometry;
        let segments = ShortSegments { test, directions, slack: mesh.slack(), alpha_mask: &geometry.alpha_mask };
        geometry.accelerator.short_segments(&segments, blocked);
        for (&bit, _) in bits.iter().zip(blocked.iter()).filter(|(_, blocked)| **blocked) {
            mask[bit / 32] &= !(1 << (bit % 32));
        }
        MaskCounts { half_ball: bits.len() as u64, used: population(mask), tested: bits.len() as u64 }
    }
}

/// Conditions 1 and 2 of formula (2), one light point after another.
fn half_ball(mesh: &LightMesh, points: &CellPoints, point: &SurfacePoint, mask: &mut [u32]) {
    mask.fill(0);
    for bit in 0..mesh.template.len() {
        let d = points.get(bit) - point.position;
        if dot_along_x(d, d) < mesh.radius * mesh.radius && dot_along_x(point.normal, d) > mesh.least_height() {
            mask[bit / 32] |= 1 << (bit % 32);
        }
    }
}
