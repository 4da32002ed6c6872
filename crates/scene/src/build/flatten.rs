//! A mesh with copies in place of instances, or with boxes.

use std::borrow::Cow;
use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use super::geometry_check::check_room;
use crate::model::placed::{number_of_shape, shapes_of};
use crate::{GeometryError, Instance, Instances, Mesh};

impl Mesh {
    /// The same with a copy of the shape for each instance: the triangles that are where they are stored, then those of the instances in their
    /// order. What is computed of these is the same bit by bit.
    ///
    /// # Errors
    ///
    /// [`GeometryError::TooLarge`]
    pub fn flattened(&self) -> Result<Mesh, GeometryError> {
        let mut flat = self.without_shapes();
        let shapes = shapes_of(self.instances.list().iter());
        let vertices: Vec<Vec<u32>> = shapes.par_iter().map(|shape| self.vertices_of(shape.clone())).collect();
        let vertices_of = |instance: &Instance| &vertices[number_of_shape(&shapes, instance)];
        let count: usize = self.instances.list().iter().map(|instance| vertices_of(instance).len()).sum();
        check_room(flat.positions.len() + count, self.triangle_count())?;
        for instance in self.instances.list() {
            flat.append_instance(self, instance, vertices_of(instance));
        }
        Ok(flat)
    }

    /// The vertices of a shape, each once.
    fn vertices_of(&self, triangles: Range<u32>) -> Vec<u32> {
        self.vertices_of_some(triangles, |_| true)
    }

    /// Without what belongs to shapes.
    fn without_shapes(&self) -> Mesh {
        fn first<T: Copy>(values: &[T], count: usize) -> Vec<T> {
            values[..count.min(values.len())].to_vec()
        }
        let Instances { shapes, vertices, .. } = &self.instances;
        let triangles = self.own_triangles().len();
        let vertices = if shapes.is_empty() { self.positions.len() } else { vertices.start as usize };
        Mesh {
            positions: first(&self.positions, vertices),
            normals: first(&self.normals, vertices),
            uvs: first(&self.uvs, vertices),
            colors: first(&self.colors, vertices),
            opacities: first(&self.opacities, vertices),
            triangles: first(&self.triangles, triangles),
            materials: first(&self.materials, triangles),
            objects: self.objects.without(shapes.clone()),
            instances: Instances::default(),
        }
    }

    fn append_instance(&mut self, from: &Mesh, instance: &Instance, vertices: &[u32]) {
        fn append<T: Copy>(to: &mut Vec<T>, from: &[T], vertices: &[u32]) {
            if !from.is_empty() {
                to.extend(vertices.iter().map(|&vertex| from[vertex as usize]));
            }
        }
        let first = self.positions.len() as u32;
        self.positions.extend(vertices.iter().map(|&vertex| instance.place.point(from.positions[vertex as usize])));
        if !from.normals.is_empty() {
            let normal = |&vertex: &u32| instance.back.normal_back(from.normals[vertex as usize]);
            self.normals.extend(vertices.iter().map(normal));
        }
        append(&mut self.uvs, &from.uvs, vertices);
        append(&mut self.colors, &from.colors, vertices);
        append(&mut self.opacities, &from.opacities, vertices);
        self.objects.begin(self.triangles.len(), from.objects.key(instance.object));
        let stored = instance.triangles.start as usize..instance.triangles.end as usize;
        let place = |vertex: u32| first + vertices.partition_point(|&other| other < vertex) as u32;
        self.triangles.extend(from.triangles[stored.clone()].iter().map(|triangle| triangle.map(place)));
        self.materials.extend_from_slice(&from.materials[stored]);
    }

    /// What the mesh looks like from afar, to choose views of it: the mesh itself, or a flat one; if that had more than `most` triangles, with
    /// boxes in place of instances.
    pub(crate) fn outline(&self, most: usize) -> Cow<'_, Mesh> {
        if self.instances.is_empty() {
            return Cow::Borrowed(self);
        }
        if self.triangle_count() <= most
            && let Ok(flat) = self.flattened()
        {
            return Cow::Owned(flat);
        }
        let mut boxes = self.without_shapes();
        let Mesh { positions, triangles, materials, .. } = &mut boxes;
        for Instance { bounds, triangles: shape, .. } in self.instances.list() {
            let first = positions.len() as u32;
            let corner = |k: u32| {
                let axis = |axis: usize| if k >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
                Vec3::new(axis(0), axis(1), axis(2))
            };
            positions.extend((0..8).map(corner));
            triangles.extend(BOX.map(|triangle| triangle.map(|vertex| first + vertex)));
            materials.extend([self.materials[shape.start as usize]; BOX.len()]);
        }
        let Mesh { normals, uvs, colors, opacities, .. } = &mut boxes;
        normals.clear();
        uvs.clear();
        colors.clear();
        opacities.clear();
        Cow::Owned(boxes)
    }
}

/// The triangles of a box, counter-clockwise seen from outside, by the corners' bits: x, y, z.
const BOX: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];
