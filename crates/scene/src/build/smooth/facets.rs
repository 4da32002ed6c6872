//! The planes of triangles.

use glam::DVec3;

use super::triangles::Triangles;
use crate::Position;

/// A triangle whose height is at most this part of its longest edge is degenerate: with coordinates in single precision, rounding decides
/// where it points.
const THINNEST: f64 = 1e-6;

/// The unit normal of each triangle.
pub(super) struct Facets(
    /// Zero for degenerate triangles.
    Vec<DVec3>,
);

impl Facets {
    /// Triangles with a vertex that is not usable count as degenerate.
    pub(super) fn new<P: Position>(mesh: &Triangles<P>, usable: impl Fn(&P) -> bool) -> Facets {
        let normal = |triangle: usize| {
            let is_usable = mesh.triangles[triangle].iter().all(|&vertex| usable(&mesh.positions[vertex as usize]));
            if is_usable { normal(mesh.around(3 * triangle as u32)) } else { None }
        };
        Facets((0..mesh.triangles.len()).map(|triangle| normal(triangle).unwrap_or(DVec3::ZERO)).collect())
    }

    /// The normal of the triangle to which a corner belongs; `None` if it is degenerate.
    pub(super) fn of(&self, corner: u32) -> Option<DVec3> {
        Some(self.0[corner as usize / 3]).filter(|&normal| normal != DVec3::ZERO)
    }
}

/// The unit normal; `None` if the triangle is degenerate.
pub fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let across = (b - a).cross(c - a);
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    across.try_normalize().filter(|_| across.length() > THINNEST * longest)
}

/// The angle between two edges.
pub fn corner_angle(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length().atan2(u.dot(v))
}
