//! A mesh passed from a loader to the scene.

use glam::{Vec2, Vec3};

use crate::{MeshPart, Objects, Position};

/// One mesh as assembled by a loader. It is passed by value: no part of a large file is held twice.
#[derive(Debug)]
pub struct LoadedMesh<P> {
    /// Vertices in the file's coordinates, `Vec3` or `DVec3`.
    pub positions: Vec<P>,
    /// Normals by vertex, or none; need not be unit length.
    pub normals: Vec<Vec3>,
    /// Texture coordinates by vertex, or none.
    pub uvs: Vec<Vec2>,
    /// Linear colours by vertex, or none.
    pub colors: Vec<Vec3>,
    /// Three vertex indices per triangle, all in range.
    pub triangles: Vec<[u32; 3]>,
    /// Material by triangle.
    pub materials: Vec<u32>,
    /// Smoothing group by triangle, 0 for those that are flat; or none: all are in one.
    pub groups: Vec<u32>,
    /// The object of each triangle; none if the file has no names.
    pub objects: Objects,
}

impl<P: Position> LoadedMesh<P> {
    /// The mesh without its materials.
    pub fn part(&self) -> MeshPart<'_, P> {
        let LoadedMesh { positions, normals, uvs, colors, triangles, .. } = self;
        MeshPart { positions, normals, uvs, colors, opacities: &[], triangles }
    }

    /// Replaces the vertices by those that `chosen` lists, in that order. Triangles stay unchanged.
    pub(crate) fn choose_vertices(&mut self, chosen: impl Iterator<Item = u32> + Clone) {
        fn choose<T: Copy>(values: &mut Vec<T>, chosen: impl Iterator<Item = u32>) {
            if !values.is_empty() {
                *values = chosen.map(|vertex| values[vertex as usize]).collect();
            }
        }
        choose(&mut self.positions, chosen.clone());
        choose(&mut self.normals, chosen.clone());
        choose(&mut self.uvs, chosen.clone());
        choose(&mut self.colors, chosen);
    }

    /// Adds a copy of a vertex without its normal.
    pub(crate) fn copy_vertex(&mut self, vertex: usize) {
        fn copy<T: Copy>(values: &mut Vec<T>, vertex: usize) {
            if !values.is_empty() {
                values.push(values[vertex]);
            }
        }
        copy(&mut self.positions, vertex);
        copy(&mut self.uvs, vertex);
        copy(&mut self.colors, vertex);
        self.normals.push(Vec3::ZERO);
    }

    /// Drops vertices that no triangle uses: one that is far away would move the local frame.
    pub fn drop_unused_vertices(&mut self) {
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&vertex| used[vertex as usize] = true);
        if used.iter().all(|&used| used) {
            return;
        }
        let mut place = Vec::with_capacity(used.len());
        let mut kept = 0;
        for &used in &used {
            place.push(kept);
            kept += u32::from(used);
        }
        self.choose_vertices((0..used.len() as u32).filter(|&vertex| used[vertex as usize]));
        self.triangles.iter_mut().flatten().for_each(|vertex| *vertex = place[*vertex as usize]);
    }
}
