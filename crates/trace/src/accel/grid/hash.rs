//! Tells apart lists of triangles: a saved grid belongs to one, and so does what light points see.

use xxhash_rust::xxh3::Xxh3;

use crate::accel::Triangle;

/// Hash of a list of triangles: corners and indices, in order, and which of them are cut out.
pub fn geometry_hash(triangles: &[Triangle]) -> u64 {
    let mut hash = Xxh3::new();
    for triangle in triangles {
        let corners = triangle.corners().map(|corner| corner.to_array().map(f32::to_le_bytes));
        hash.update(corners.as_flattened().as_flattened());
        hash.update(&triangle.index().to_le_bytes());
        if triangle.cut() != 0 {
            hash.update(b"cut out");
        }
    }
    hash.digest()
}
