//! Which cached light points a motion invalidates.
//!
//! What a light point sees of a light depends only on triangles between them. So it is the same as before if no triangle that moved comes
//! near the hull of the point and the light, where it was and where it is: the hull of two boxes is the union of all boxes between them,
//! and whether one of these meets a third box is a matter of an interval on each axis.

use glam::Vec3;
use lightmesh_layout::constants::{BRICK_BITS, POINT_BITS};
use lightmesh_scene::{Bounds, LightKind};

use crate::deformation::union;
use crate::light_mesh::{BrickKey, Lattice, point_of};
use crate::prepared::PreparedGeometry;

/// Tells which bricks of light points a motion invalidates for a light.
pub struct Invalidation<'a> {
    /// Around what moved, and enlarged for rounding.
    boxes: Vec<Bounds>,
    lattice: &'a Lattice,
    /// Beyond all triangles, before and now.
    far: f32,
}

impl<'a> Invalidation<'a> {
    /// By what moved in `geometry`, which has light points at `lattice`.
    pub(crate) fn new(boxes: &[Bounds], lattice: &'a Lattice, geometry: &PreparedGeometry) -> Invalidation<'a> {
        let everything = boxes.iter().copied().fold(geometry.bounds, union);
        let size = everything.farthest().max(everything.diagonal());
        let margin = 1e-3 * lattice.step + 1e-5 * size;
        let enlarged = |bounds: &Bounds| Bounds { min: bounds.min - margin, max: bounds.max + margin };
        Invalidation { boxes: boxes.iter().map(enlarged).collect(), lattice, far: 4.0 * (size + lattice.step) }
    }

    /// Whether what light points of a brick see of a light of this kind may have changed.
    pub(crate) fn by(&self, brick: BrickKey, light: &LightKind) -> bool {
        let first = self.lattice.point(point_of(brick << POINT_BITS));
        let last = first + self.lattice.step * ((1 << BRICK_BITS) - 1) as f32;
        let points = Bounds { min: first, max: last };
        let light = self.extent(light, &points);
        self.boxes.iter().any(|moved| meets_between(&points, &light, moved))
    }

    /// A box around a light; around where its rays leave the scene, if it is infinitely far away.
    fn extent(&self, light: &LightKind, points: &Bounds) -> Bounds {
        let around = |middle: Vec3, half: Vec3| Bounds { min: middle - half, max: middle + half };
        match *light {
            LightKind::Point { position, spread } => around(position, Vec3::splat(spread)),
            LightKind::Sphere { position, radius }
            | LightKind::Spot { position, radius, .. }
            | LightKind::Disk { position, radius, .. } => around(position, Vec3::splat(radius)),
            LightKind::Rectangle { position, half_u, half_v } => around(position, half_u.abs() + half_v.abs()),
            LightKind::Directional { direction, angle } => {
                let length = self.far + points.center().length();
                let aside = length * (0.5 * angle).tan();
                let around_center = around(points.center() - length * direction, Vec3::splat(aside));
                let half = 0.5 * points.extent();
                Bounds { min: around_center.min - half, max: around_center.max + half }
            }
        }
    }
}

/// Whether a box meets the hull of two others.
pub fn meets_between(from: &Bounds, to: &Bounds, other: &Bounds) -> bool {
    let (mut least, mut most) = (0.0f32, 1.0f32);
    for axis in 0..3 {
        // The boxes between begin below the other's end, and end above its beginning.
        for (start, end) in [
            (from.min[axis] - other.max[axis], to.min[axis] - other.max[axis]),
            (other.min[axis] - from.max[axis], other.min[axis] - to.max[axis]),
        ] {
            // At the share s of the way: start + s (end - start) <= 0.
            match (start <= 0.0, end <= 0.0) {
                (true, true) => {}
                (false, false) => return false,
                (true, false) => most = most.min(start / (start - end)),
                (false, true) => least = least.max(start / (start - end)),
            }
        }
    }
    least <= most + 1e-5
}
