//! The short tests by cell: the triangles that can stand between the points of a cell and their light points are looked up
//! once a cell.
//!
//! An object point drops those that lie on or behind its tangent plane, or whose plane it cannot reach. If none is left, its
//! whole half-ball is visible without a single test: so it is for most points of a scene with open spaces.

use fearless_simd::prelude::*;
use glam::{IVec3, Vec3};
use lightmesh_scene::Bounds;

use super::{CellPoints, MaskCounts, population};
use crate::accel::ShortTest;
use crate::accel::triangle::Occluder;
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

/// The triangles that can block a segment which starts in one cell.
#[derive(Default)]
pub(crate) struct CellOccluders {
    found: Vec<u32>,
    corners: Vec<[Vec3; 3]>,
}

impl CellOccluders {
    /// Collects the triangles near `cell`.
    pub(crate) fn collect(&mut self, scene: &PreparedScene, mesh: &LightMesh, cell: IVec3) {
        let reach = Vec3::splat(mesh.radius + mesh.slack());
        let region = Bounds {
            min: mesh.lattice.point(cell) - reach,
            max: mesh.lattice.point(cell + IVec3::ONE) + reach,
        };
        scene.accelerator.triangles_in(&region, &mut self.found);
        self.corners.clear();
        self.corners.extend(self.found.iter().map(|&index| scene.triangles[index as usize].corners()));
    }

    /// The mask of one object point of the cell.
    #[inline(always)]
    pub(crate) fn mask<S: Simd>(
        &self,
        simd: S,
        mesh: &LightMesh,
        points: &CellPoints,
        point: &SurfacePoint,
        mask: &mut [u32],
    ) -> MaskCounts {
        // 1, 2. The half-ball.
        points.half_ball(simd, point.position, point.normal, mesh, mask);
        let half_ball = population(mask);

        // 3. What stands in its way.
        let test = ShortTest { origin: point.origin, normal: point.normal, edge_on: mesh.edge_on() };
        let reach = mesh.radius + mesh.slack();
        let mut tested = 0;
        for &corners in &self.corners {
            let Some(occluder) = test.occluder(corners) else { continue };
            if out_of_reach(&occluder, reach) {
                continue;
            }
            tested = half_ball;
            points.clear_blocked(simd, point.origin, &occluder, mask);
        }
        MaskCounts { half_ball, used: population(mask), tested }
    }
}

/// Whether the triangle's plane is farther than `reach` from the segments' origin.
#[inline(always)]
fn out_of_reach(occluder: &Occluder, reach: f32) -> bool {
    let [a, b, c] = occluder.sides;
    let area = a + b + c;
    occluder.volume * occluder.volume > reach * reach * area.length_squared()
}
