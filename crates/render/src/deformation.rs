//! Geometry after a motion: which parts stay, and boxes around those that moved.

use std::sync::Arc;

use lightmesh_scene::{Bounds, Geometry, Instance};
use lightmesh_trace::accel::Triangle;

/// Boxes around what moved, at most: more are put together.
const MAX_BOXES: usize = 64;

/// Whether two geometries are the same but for the places of their vertices, and for normals.
pub(crate) fn differs_only_in_positions(before: &Geometry, now: &Geometry) -> bool {
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
        && a.instances.shapes() == b.instances.shapes()
        && a.instances.list().len() == b.instances.list().len()
        && a.instances.list().iter().zip(b.instances.list()).all(|(a, b)| is_same_shape(a, b))
}

/// Whether both are the same surfaces in the same places, though they may stand in memory twice.
pub fn are_same(a: &Geometry, b: &Geometry) -> bool {
    differs_only_in_positions(a, b)
        && a.mesh.positions == b.mesh.positions
        && a.mesh.normals == b.mesh.normals
        && a.mesh.instances == b.mesh.instances
}

fn is_same_shape(a: &Instance, b: &Instance) -> bool {
    a.triangles == b.triangles && a.first == b.first && a.object == b.object
}

/// Boxes around the triangles that moved, object by object, each around where it was and where it is.
pub(crate) fn boxes([old, new]: [&Geometry; 2], before: &[Triangle], now: &[Triangle]) -> Arc<[Bounds]> {
    let (starts, _) = new.mesh.objects.runs();
    let own = new.mesh.own_triangles().end;
    let ends = starts.iter().skip(1).map(|&start| own.min(start as usize)).chain([own]);
    let first = starts.first().map_or(0, |&start| start as usize);
    let mut boxes: Vec<Bounds> = Vec::new();
    let mut from = first.min(own);
    for end in ends {
        let pairs = before[from..end].iter().zip(&now[from..end]);
        let moved = pairs.filter(|(before, now)| places(before) != places(now));
        let corners = moved.flat_map(|(before, now)| before.corners().into_iter().chain(now.corners()));
        let bounds = Bounds::around(corners.filter(|corner| corner.is_finite()));
        boxes.extend((!bounds.is_empty()).then_some(bounds));
        from = end;
    }
    boxes.extend(boxes_of_instances([old, new], before, now));
    let together = boxes.len().div_ceil(MAX_BOXES).max(1);
    boxes.chunks(together).map(|some| some.iter().copied().reduce(union).unwrap_or(Bounds::EMPTY)).collect()
}

/// The same of instances: those that are elsewhere, and those of shapes that have changed.
fn boxes_of_instances<'a>(
    [old, new]: [&'a Geometry; 2],
    before: &'a [Triangle],
    now: &'a [Triangle],
) -> impl Iterator<Item = Bounds> + 'a {
    let shapes = new.mesh.instances.shapes();
    let has_changed = |shape: &Instance| {
        let stored = shape.triangles.start as usize..shape.triangles.end as usize;
        before[stored.clone()].iter().zip(&now[stored]).any(|(before, now)| places(before) != places(now))
    };
    let any_changed =
        before[shapes.clone()].iter().zip(&now[shapes]).any(|(before, now)| places(before) != places(now));
    let pairs = old.mesh.instances.list().iter().zip(new.mesh.instances.list());
    let moved = pairs.filter(move |(old, new)| old.place != new.place || (any_changed && has_changed(new)));
    moved.map(|(old, new)| union(old.bounds, new.bounds))
}

/// The corners of a triangle, to be compared bit by bit.
fn places(triangle: &Triangle) -> [[u32; 3]; 3] {
    triangle.corners().map(|corner| corner.to_array().map(f32::to_bits))
}

pub(crate) fn union(a: Bounds, b: Bounds) -> Bounds {
    Bounds { min: a.min.min(b.min), max: a.max.max(b.max) }
}
