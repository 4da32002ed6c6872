//! Does a triangle meet a box? Thirteen separating axes, after Akenine-Möller: *Fast 3D Triangle-Box Overlap Testing* (2001).

use glam::{DVec3, Vec3};

/// Whether the triangle meets the closed box around `center` with half edges `half`. Touching counts.
pub fn triangle_meets_box(corners: [Vec3; 3], center: DVec3, half: DVec3) -> bool {
    let [a, b, c] = corners.map(|corner| corner.as_dvec3() - center);
    // 1. The axes of the box.
    if a.min(b).min(c).cmpgt(half).any() || a.max(b).max(c).cmplt(-half).any() {
        return false;
    }
    // 2. The triangle's normal.
    let edges = [b - a, c - b, a - c];
    let normal = edges[0].cross(edges[1]);
    if normal.dot(a).abs() > normal.abs().dot(half) {
        return false;
    }
    // 3. The products of the triangle's edges with the box's axes.
    edges.iter().all(|&edge| {
        [DVec3::X, DVec3::Y, DVec3::Z].iter().all(|&axis| {
            let axis = axis.cross(edge);
            let [a, b, c] = [a, b, c].map(|corner| axis.dot(corner));
            let reach = axis.abs().dot(half);
            a.min(b).min(c) <= reach && a.max(b).max(c) >= -reach
        })
    })
}
