//! Geometry in which things have moved: what of it stays, and boxes around the rest.

use std::sync::Arc;

use lightmesh_scene::{Bounds, Geometry};

use crate::accel::Triangle;

/// Boxes around what moved, at most: more are put together.
const MOST_BOXES: usize = 64;

/// Whether two geometries are the same but for the places of their vertices, and for normals.
pub(crate) fn differ_by_places(before: &Geometry, now: &Geometry) -> bool {
    let (a, b) = (&before.mesh, &now.mesh);
    before.origin == now.origin
        && before.textures.are_shared_with(&now.textures)
        && before.materials == now.materials
        && a.positions.len() == b.positions.len()
        && a.normals.len() == b.normals.len()
        && a.triangles == b.triangles
        && a.materials == b.materials
        && a.uvs == b.uvs
        && a.colors == b.colors
        && a.opacities == b.opacities
        && a.objects == b.objects
}

/// Boxes around the triangles that moved, object by object, each around where it was and where it is.
pub(crate) fn boxes(geometry: &Geometry, before: &[Triangle], now: &[Triangle]) -> Arc<[Bounds]> {
    let (starts, _) = geometry.mesh.objects.runs();
    let ends = starts.iter().skip(1).map(|&start| start as usize).chain([now.len()]);
    let first = starts.first().map_or(0, |&start| start as usize);
    let mut boxes: Vec<Bounds> = Vec::new();
    let mut from = first.min(now.len());
    for end in ends {
        let pairs = before[from..end].iter().zip(&now[from..end]);
        let moved = pairs.filter(|(before, now)| places(before) != places(now));
        let corners = moved.flat_map(|(before, now)| before.corners().into_iter().chain(now.corners()));
        let bounds = Bounds::around(corners.filter(|corner| corner.is_finite()));
        boxes.extend((!bounds.is_empty()).then_some(bounds));
        from = end;
    }
    let together = boxes.len().div_ceil(MOST_BOXES).max(1);
    boxes.chunks(together).map(|some| some.iter().copied().reduce(around_both).unwrap_or(Bounds::EMPTY)).collect()
}

/// The corners of a triangle, to be compared bit by bit.
fn places(triangle: &Triangle) -> [[u32; 3]; 3] {
    triangle.corners().map(|corner| corner.to_array().map(f32::to_bits))
}

pub(crate) fn around_both(a: Bounds, b: Bounds) -> Bounds {
    Bounds { min: a.min.min(b.min), max: a.max.max(b.max) }
}
