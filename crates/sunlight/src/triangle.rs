//! The times when the sun is behind a triangle.
//!
//! Seen from P, the sun is behind a triangle where it is on the inner side of the planes through P and each edge. An edge is asked for with its ends
//! ordered by their coordinates, whichever triangle it belongs to; the triangle on the other side takes the complement. So both have the same ends, to the
//! bit, and no light leaks between them.

use glam::DVec3;

use crate::edge::positive;
use crate::path::SunPath;
use crate::spans::Spans;
use crate::time::RATE;

/// A triangle, as tests of it need it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    corners: [DVec3; 3],
    /// Of length 1; 0 for one without an area.
    normal: DVec3,
    /// For each edge whether it begins at the greater one of its ends.
    is_turned: [bool; 3],
    /// Which object it belongs to.
    pub(crate) object: u32,
}

impl Facet {
    pub(crate) fn new(corners: [DVec3; 3], object: u32) -> Facet {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let is_turned = [0, 1, 2].map(|edge| is_less(corners[(edge + 1) % 3], corners[edge]));
        Facet { corners, normal, is_turned, object }
    }

    /// When the sun is behind it, seen from `point`, within `limits`. A triangle whose plane passes the point within `flat` is seen edge-on and hides
    /// nothing, so that points on faces need not be moved.
    pub(crate) fn hidden(&self, path: &SunPath, point: DVec3, flat: f64, limits: (f64, f64)) -> Spans {
        let corners = self.corners.map(|corner| corner - point);
        let distance = self.normal.dot(corners[0]);
        let limits = (limits.0.max(path.hull.0), limits.1.min(path.hull.1));
        if !(distance.abs() > flat && limits.0 < limits.1) {
            return Spans::default();
        }
        let side = if distance > 0.0 { 1.0 } else { -1.0 };
        // 1. By the values at both ends, and how far the way between them bends at most, an edge may decide all, or nothing.
        let half = 0.5 * RATE * (limits.1 - limits.0);
        let bend = if half < 1.0 { 0.55 * half * half + 1e-12 } else { 3.0 };
        let (first, last) = (path.at(limits.0).0, path.at(limits.1).0);
        let mut is_inside = [false; 3];
        let normals = [0, 1, 2].map(|edge| corners[edge].cross(corners[(edge + 1) % 3]));
        for (edge, m) in normals.into_iter().enumerate() {
            let (low, high) = (side * m.dot(first), side * m.dot(last));
            let bend = bend * m.length();
            if low.max(high) < -bend {
                return Spans::default();
            }
            is_inside[edge] = low.min(high) > bend;
        }
        // 2. The roots of the others.
        let mut hidden = Spans::one(limits.0, limits.1);
        for edge in (0..3).filter(|&edge| !is_inside[edge]) {
            // The product of the ends in the other order, to the bit.
            let m = if self.is_turned[edge] { -normals[edge] } else { normals[edge] };
            let on_side = positive(path, m, limits);
            let is_other = self.is_turned[edge] != (side < 0.0);
            let within = if is_other { on_side.complement(path.hull.0, path.hull.1) } else { on_side };
            hidden = hidden.and(&within);
            if hidden.is_empty() {
                break;
            }
        }
        hidden
    }
}

/// An order of points.
fn is_less(a: DVec3, b: DVec3) -> bool {
    a.x < b.x || a.x == b.x && (a.y < b.y || a.y == b.y && a.z < b.z)
}
