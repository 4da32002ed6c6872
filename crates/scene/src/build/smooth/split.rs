//! Vertices with several normals become several vertices.

use glam::Vec3;
use lightmesh_memory::{Budget, OverBudget};

use super::{buckets::Buckets, error::Unsmooth, steps::count_step};
use crate::Position;
use crate::build::loaded_mesh::LoadedMesh;

/// A corner whose triangle is flat: its vertex has a zero normal.
pub(super) const FLAT: u32 = u32::MAX;

/// Gives each corner the normal with its number, [`FLAT`], or, where there is none, any. Vertices with several of these are copied behind the
/// others, so that a mesh without creases keeps its vertices.
pub(super) fn split<P: Position>(
    mesh: &mut LoadedMesh<P>,
    number: impl Fn(u32) -> Option<u32>,
    normal: impl Fn(u32) -> Vec3,
    budget: &Budget,
) -> Result<(), Unsmooth> {
    let (vertices, corners) = (mesh.positions.len(), 3 * mesh.triangles.len());
    let vertex = |corner: u32| mesh.triangles.as_flattened()[corner as usize];
    let mut lists = Buckets::new(vertices, corners, |corner| number(corner).map(|_| vertex(corner)));
    let mut added = 0;
    lists.each(|_, corners| {
        corners.sort_unstable_by_key(|&corner| {
            count_step();
            (number(corner), corner)
        });
        added += corners.chunk_by(|&a, &b| number(a) == number(b)).count().saturating_sub(1);
    });
    if vertices + added > u32::MAX as usize {
        return Err(Unsmooth::TooMany);
    }
    grow(mesh, added, budget)?;
    let mut next = vertices;
    lists.each(|vertex, corners| {
        for (copy, same) in corners.chunk_by(|&a, &b| number(a) == number(b)).enumerate() {
            let place = if copy == 0 { vertex } else { next };
            if copy > 0 {
                mesh.copy_vertex(vertex);
                next += 1;
            }
            mesh.normals[place] = number(same[0]).filter(|&number| number != FLAT).map_or(Vec3::ZERO, &normal);
            let triangles = mesh.triangles.as_flattened_mut();
            same.iter().for_each(|&corner| triangles[corner as usize] = place as u32);
        }
    });
    Ok(())
}

/// Makes room for more vertices, and for normals.
fn grow<P: Position>(mesh: &mut LoadedMesh<P>, added: usize, budget: &Budget) -> Result<(), OverBudget> {
    fn bytes<T>(values: &[T]) -> u64 {
        if values.is_empty() { 0 } else { size_of::<T>() as u64 }
    }
    fn reserve<T>(values: &mut Vec<T>, added: usize) {
        if !values.is_empty() {
            values.reserve_exact(added);
        }
    }
    let count = mesh.positions.len() + added;
    // What grows is held twice while it is copied.
    let copied = bytes(&mesh.positions) + bytes(&mesh.uvs) + bytes(&mesh.colors);
    let needed = size_of::<Vec3>() as u64 + if added > 0 { copied } else { 0 };
    budget.check(count as u64 * needed)?;
    reserve(&mut mesh.positions, added);
    reserve(&mut mesh.uvs, added);
    reserve(&mut mesh.colors, added);
    mesh.normals = Vec::with_capacity(count);
    mesh.normals.resize(mesh.positions.len(), Vec3::ZERO);
    Ok(())
}
