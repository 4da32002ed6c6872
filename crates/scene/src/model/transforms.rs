//! What transforms make of positions, normals and directions, and which of the results can be used.

use glam::{DMat3, DMat4, DVec3, Vec3};

/// Coordinates above this are treated as damaged, like infinite ones: their squares must fit into `f32`.
pub(crate) const LARGEST_COORDINATE: f64 = 1e18;

/// Whether a world position is usable.
pub(crate) fn is_place(world: DVec3) -> bool {
    world.abs().cmple(DVec3::splat(LARGEST_COORDINATE)).all()
}

/// Normals are transformed by the inverse transpose of the transform of positions. Those of unit length keep their bits if they are not
/// turned: a scene that is written and read again stays the same.
pub fn normal_placement(transform: &DMat4) -> impl Fn(Vec3) -> Vec3 + use<> {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    let stays = DMat3::from_mat4(*transform) == DMat3::IDENTITY;
    let matrix = transform.inverse().transpose();
    move |normal| {
        let exact = normal.as_dvec3();
        if stays && (exact.length_squared() - 1.0).abs() < ROUNDING {
            return normal;
        }
        matrix.transform_vector3(exact).normalize_or_zero().as_vec3()
    }
}

/// Whether front faces become back faces.
pub(crate) fn mirrors(transform: &DMat4) -> bool {
    transform.determinant() < 0.0
}

/// The vector at unit length, or unchanged if it has that length to `f32` precision, so that written values are read back
/// unchanged. `None` if it has no direction.
pub(crate) fn unit(vector: DVec3) -> Option<DVec3> {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    if (vector.length_squared() - 1.0).abs() <= ROUNDING { Some(vector) } else { vector.try_normalize() }
}

/// `up` made perpendicular to the unit vector `direction`, or unchanged if it is so to `f32` precision; `None` if they are
/// parallel.
pub(crate) fn upright(direction: DVec3, up: DVec3) -> Option<DVec3> {
    const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;
    if up.dot(direction).abs() <= ROUNDING {
        return Some(up);
    }
    let side = direction.cross(up);
    (side.length() > ROUNDING).then(|| side.cross(direction).normalize())
}
