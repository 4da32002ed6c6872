//! The short tests by cell: the triangles that can stand between the points of a cell and their light points are looked up
//! once a cell.
//!
//! An object point drops those that lie on or behind its tangent plane, or whose plane it cannot reach. If none is left, its
//! whole half-ball is visible without a single test: so it is for most points of a scene with open spaces.

use fearless_simd::{f32x8, prelude::*};
use glam::{IVec3, Vec3};
use lightmesh_scene::Bounds;

use super::lanes::{self, LANES};
use super::{CellPoints, MaskCounts, population};
use crate::accel::ShortTest;
use crate::accel::triangle::Occluder;
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

/// The triangles that can block a segment which starts in one cell, one lane a triangle.
#[derive(Default)]
pub(crate) struct CellOccluders {
    found: Vec<u32>,
    corners: Vec<[Vec3; 3]>,
    /// Components of the three corners, then centre and radius of a ball around the triangle.
    lanes: [Vec<f32>; 13],
}

impl CellOccluders {
    /// Collects the triangles near `cell`.
    pub(crate) fn collect(&mut self, scene: &PreparedScene, mesh: &LightMesh, cell: IVec3) {
        let reach = mesh.radius + mesh.slack();
        let (low, high) = (mesh.lattice.point(cell), mesh.lattice.point(cell + IVec3::ONE));
        let region = Bounds { min: low - Vec3::splat(reach), max: high + Vec3::splat(reach) };
        scene.accelerator.triangles_in(&region, &mut self.found);

        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        self.corners.clear();
        self.corners.extend(
            (self.found.iter().map(|&index| scene.triangles[index as usize].corners()))
                .filter(|corners| plane_is_near(corners, middle, half, reach)),
        );
        for lane in &mut self.lanes {
            lane.clear();
        }
        // Padding: triangles at NaN fail every comparison.
        let count = self.corners.len().next_multiple_of(LANES);
        for lane in &mut self.lanes {
            lane.resize(count, f32::NAN);
        }
        for (index, corners) in self.corners.iter().enumerate() {
            let [a, b, c] = *corners;
            let (center, radius) = ball_around(corners);
            for (point, first) in [(a, 0), (b, 3), (c, 6), (center, 9)] {
                self.lanes[first][index] = point.x;
                self.lanes[first + 1][index] = point.y;
                self.lanes[first + 2][index] = point.z;
            }
            self.lanes[12][index] = radius;
        }
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
        for first in (0..self.lanes[0].len()).step_by(LANES) {
            let mut near = self.in_the_way(simd, first, point, reach);
            while near != 0 {
                let corners = self.corners[first + near.trailing_zeros() as usize];
                near &= near - 1;
                let Some(occluder) = test.occluder(corners) else { continue };
                if out_of_reach(&occluder, reach) {
                    continue;
                }
                tested = half_ball;
                points.clear_blocked(simd, point.origin, &occluder, mask);
            }
        }
        MaskCounts { half_ball, used: population(mask), tested }
    }

    /// Bit k: triangle `first + k` rises over the tangent plane at `point` and comes nearer than `reach`.
    #[inline(always)]
    fn in_the_way<S: Simd>(&self, simd: S, first: usize, point: &SurfacePoint, reach: f32) -> u32 {
        let normal = lanes::splat(simd, point.normal);
        let a = lanes::dot(normal, self.relative(simd, 0, first, point.origin));
        let b = lanes::dot(normal, self.relative(simd, 3, first, point.origin));
        let c = lanes::dot(normal, self.relative(simd, 6, first, point.origin));
        let center = self.relative(simd, 9, first, point.origin);
        let apart = f32x8::from_slice(simd, &self.lanes[12][first..first + LANES]) + reach;
        let near = lanes::dot(center, center).simd_le(apart * apart);
        (a.max(b).max(c).simd_gt(0.0) & near).to_bitmask() as u32
    }

    /// Eight points whose components stand in three lanes from `lane` on, relative to `from`.
    #[inline(always)]
    fn relative<S: Simd>(&self, simd: S, lane: usize, first: usize, from: Vec3) -> [f32x8<S>; 3] {
        let [x, y, z] = [&self.lanes[lane], &self.lanes[lane + 1], &self.lanes[lane + 2]];
        [
            f32x8::from_slice(simd, &x[first..first + LANES]) - from.x,
            f32x8::from_slice(simd, &y[first..first + LANES]) - from.y,
            f32x8::from_slice(simd, &z[first..first + LANES]) - from.z,
        ]
    }
}

/// Whether the plane of a triangle comes nearer than `reach` to a box.
#[inline(always)]
fn plane_is_near([a, b, c]: &[Vec3; 3], middle: Vec3, half: Vec3, reach: f32) -> bool {
    let normal = (b - a).cross(c - a);
    let apart = normal.dot(middle - a).abs() - normal.abs().dot(half);
    apart <= 0.0 || apart * apart <= reach * reach * normal.length_squared()
}

/// Centre and radius of a ball that holds a triangle.
#[inline(always)]
fn ball_around([a, b, c]: &[Vec3; 3]) -> (Vec3, f32) {
    let center = 0.5 * (a.min(*b).min(*c) + a.max(*b).max(*c));
    let square = a.distance_squared(center).max(b.distance_squared(center)).max(c.distance_squared(center));
    // Rounded up, so that the ball holds the corners as they are.
    (center, square.sqrt() * (1.0 + 4.0 * f32::EPSILON))
}

/// Whether the triangle's plane is farther than `reach` from the segments' origin.
#[inline(always)]
fn out_of_reach(occluder: &Occluder, reach: f32) -> bool {
    let [a, b, c] = occluder.sides;
    let area = a + b + c;
    occluder.volume * occluder.volume > reach * reach * area.length_squared()
}
