//! The short tests by cell: the triangles that can stand between the points of a cell and their light points are searched for
//! once per cell, each with the box of light points that its shadow can reach.
//!
//! A surface point discards those that lie on or behind its tangent plane. If none is left, its whole half-ball is visible
//! without a single test: this is the case for most points of a scene with open spaces.

use std::ops::Range;

use glam::{IVec3, Vec3};
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{Region, TangentPlanes, Triangle};

use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::surface::SurfacePoint;

/// A triangle that may block segments that start in a cell.
pub(super) struct Candidate {
    pub(super) triangle: Triangle,
    /// The range of its rows in [`CellOccluders::rows`].
    rows: Range<usize>,
}

/// The triangles that can block segments that start in a cell.
#[derive(Default)]
pub(super) struct CellOccluders {
    found: Vec<u32>,
    pub(super) candidates: Vec<Candidate>,
    /// Runs of template bits.
    rows: Vec<Range<u16>>,
}

impl CellOccluders {
    /// Collects the triangles that matter to segments from the [origins](SurfacePoint::origin) of `points`, all in `cell`.
    pub(super) fn collect(&mut self, scene: &PreparedScene, mesh: &LightMesh, cell: IVec3, points: &[SurfacePoint]) {
        let origins = &Bounds::around(points.iter().map(|point| point.origin));
        let reach = mesh.radius + mesh.slack();
        let planes = points.iter().map(|point| (point.origin, point.normal));
        let region = Region::within(Bounds { min: origins.min - reach, max: origins.max + reach })
            .above(TangentPlanes::new(origins.min, planes, mesh.slack()));
        scene.geometry.accelerator.triangles_in(&region, &mut self.found);
        self.candidates.clear();
        self.rows.clear();
        for &index in &self.found {
            let triangle = scene.geometry.triangles.at(index);
            let corners = triangle.corners();
            if plane_is_near(&corners, origins, reach)
                && let Some((low, high)) = shadow_box(mesh, cell, origins, &corners)
            {
                let first = self.rows.len();
                add_rows(&mut self.rows, mesh, low, high);
                if self.rows.len() > first {
                    self.candidates.push(Candidate { triangle, rows: first..self.rows.len() });
                }
            }
        }
    }

    /// The light points that `candidate` can hide from a surface point of the cell, as runs of bits: neighbours along x.
    #[inline(always)]
    pub(super) fn rows(&self, candidate: &Candidate) -> &[Range<u16>] {
        &self.rows[candidate.rows.clone()]
    }
}

/// Adds the rows of the template between two offsets, both included.
fn add_rows(rows: &mut Vec<Range<u16>>, mesh: &LightMesh, low: IVec3, high: IVec3) {
    for z in low.z..=high.z {
        for y in low.y..=high.y {
            let row = mesh.template.row(y, z, low.x, high.x);
            if !row.is_empty() {
                rows.push(row.start as u16..row.end as u16);
            }
        }
    }
}

/// Whether the plane of a triangle comes nearer than `reach` to a box.
#[inline(always)]
fn plane_is_near([a, b, c]: &[Vec3; 3], region: &Bounds, reach: f32) -> bool {
    let normal = (b - a).cross(c - a);
    let apart = normal.dot(region.center() - a).abs() - 0.5 * normal.abs().dot(region.extent());
    apart <= 0.0 || apart * apart <= reach * reach * normal.length_squared()
}

/// The box of light points, as offsets from `cell`, that a triangle can hide from a point in `origins`; `None` if there is no
/// such light point.
///
/// A hidden light point lies at P + s·(q − P) with P in `origins`, q on the triangle and s ≥ 1. It is nearer to P than the
/// radius r, so s is at most r divided by the distance between the box and the triangle.
#[inline(always)]
pub fn shadow_box(mesh: &LightMesh, cell: IVec3, origins: &Bounds, [a, b, c]: &[Vec3; 3]) -> Option<(IVec3, IVec3)> {
    let slack = Vec3::splat(mesh.slack());
    let reach = Vec3::splat(mesh.radius + mesh.slack());
    // 1. All q − P.
    let low = a.min(*b).min(*c) - origins.max - slack;
    let high = a.max(*b).max(*c) - origins.min + slack;
    // 2. All s·(q − P) within the ball. An infinite s leaves the box of the ball itself.
    let apart = low.max(-high).max(Vec3::ZERO).max_element();
    if apart > reach.x {
        return None;
    }
    let most = if apart > 0.0 { reach.x / apart } else { f32::INFINITY };
    let low = Vec3::select(low.cmplt(Vec3::ZERO), (most * low).max(-reach), low);
    let high = Vec3::select(high.cmpgt(Vec3::ZERO), (most * high).min(reach), high);
    // 3. In steps from the cell.
    let corner = mesh.lattice.point(cell);
    let low = ((origins.min + low - slack - corner) / mesh.lattice.step).ceil().as_ivec3();
    let high = ((origins.max + high + slack - corner) / mesh.lattice.step).floor().as_ivec3();
    let (least, largest) = (IVec3::splat(1 - mesh.template.reach()), IVec3::splat(mesh.template.reach()));
    let (low, high) = (low.max(least), high.min(largest));
    low.cmple(high).all().then_some((low, high))
}
