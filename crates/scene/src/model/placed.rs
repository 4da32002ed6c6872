//! The triangles of a mesh where rays meet them: those that are stored there, and those of shapes in many places.

use std::ops::Range;

use glam::{DMat4, DVec3, Vec3};
use rayon::prelude::*;

use super::{
    bounds::Bounds,
    instances::{Affine, FIRST_INSTANCED, Instance},
    mesh::Mesh,
};

/// Triangles with larger coordinates are not hit.
const FARTHEST: f32 = (1u64 << 40) as f32;

impl Mesh {
    /// The box around all vertices that a triangle uses.
    pub fn bounds(&self) -> Bounds {
        let used = self.own_triangles().flat_map(|triangle| self.triangles[triangle]);
        let own = Bounds::around(used.map(|vertex| self.positions[vertex as usize]));
        let instances = self.instances.list().iter().map(|instance| instance.bounds);
        instances.fold(own, Bounds::with_box)
    }

    /// Number of triangles that rays may meet, those of instances in all their places.
    pub fn triangle_count(&self) -> usize {
        self.own_triangles().len() + self.instances.triangle_count()
    }

    /// The stored triangles that are where they are stored: those of shapes come after them.
    pub fn own_triangles(&self) -> Range<usize> {
        0..if self.instances.shapes.is_empty() { self.triangles.len() } else { self.instances.shapes().start }
    }

    /// The instance that has a triangle.
    #[inline(always)]
    pub fn instance_of(&self, index: u32) -> Option<&Instance> {
        (index >= FIRST_INSTANCED).then(|| self.instances.of(index))
    }

    /// Where the triangle `index` is stored: its vertices and its material.
    #[inline(always)]
    pub fn stored(&self, index: u32) -> usize {
        match self.instance_of(index) {
            Some(instance) => (instance.triangles.start + (index - instance.first)) as usize,
            None => index as usize,
        }
    }

    /// The number of a triangle's object.
    #[inline]
    pub fn object_of(&self, index: u32) -> u32 {
        self.instance_of(index).map_or_else(|| self.objects.of(index), |instance| instance.object)
    }

    /// The normals of a triangle's corners, where there are normals.
    #[inline(always)]
    pub fn corner_normals(&self, index: u32) -> [Vec3; 3] {
        let normals = self.triangles[self.stored(index)].map(|vertex| self.normals[vertex as usize]);
        match self.instance_of(index) {
            Some(instance) => normals.map(|normal| instance.back.normal_back(normal)),
            None => normals,
        }
    }

    /// Those of triangles that can be hit.
    fn vertices_that_count(&self, triangles: Range<u32>) -> Vec<u32> {
        let counts = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| self.positions[vertex as usize]);
            let in_range = |corner: Vec3| corner.abs().cmple(Vec3::splat(FARTHEST)).all();
            in_range(a) && in_range(b) && in_range(c) && a != b && b != c && c != a
        };
        self.vertices_of_some(triangles, counts)
    }

    /// The vertices of those triangles of a shape that count, each once.
    pub(crate) fn vertices_of_some(&self, triangles: Range<u32>, counts: impl Fn(&[u32; 3]) -> bool) -> Vec<u32> {
        let triangles = &self.triangles[triangles.start as usize..triangles.end as usize];
        let mut vertices: Vec<u32> = triangles.iter().filter(|&triangle| counts(triangle)).flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Takes instances to other places in the world; `origin` is that of the local frame. Those that somebody has taken out of the mesh are left
    /// alone.
    pub(crate) fn move_instances(&mut self, moved: impl Iterator<Item = (usize, DMat4)>, origin: DVec3) {
        let (to_shapes, to_local) = (DMat4::from_translation(self.instances.center), DMat4::from_translation(-origin));
        let mut are_moved = vec![false; self.instances.list.len()];
        for (number, map) in moved {
            let Some(instance) = self.instances.list.get_mut(number) else { continue };
            (instance.place, instance.back) = Affine::both_ways(&(to_local * map * to_shapes));
            are_moved[number] = true;
        }
        if are_moved.contains(&true) {
            self.find_bounds_of_instances(|number| are_moved[number]);
        }
    }

    /// Finds the box around each instance: to be called when vertices of shapes were moved, and only then.
    pub fn find_instance_bounds(&mut self) {
        self.find_bounds_of_instances(|_| true);
    }

    /// The same for those that are asked for.
    pub(crate) fn find_bounds_of_instances(&mut self, are_asked: impl Fn(usize) -> bool + Sync) {
        let list = self.instances.list.iter().enumerate();
        let shapes = shapes_of(list.filter(|(number, _)| are_asked(*number)).map(|(_, instance)| instance));
        let points = |shape: &Range<u32>| -> Vec<Vec3> {
            self.vertices_that_count(shape.clone()).iter().map(|&vertex| self.positions[vertex as usize]).collect()
        };
        let points: Vec<Vec<Vec3>> = shapes.par_iter().map(points).collect();
        let asked = self.instances.list.par_iter_mut().enumerate().filter(|(number, _)| are_asked(*number));
        asked.for_each(|(_, instance)| {
            let (place, points) = (instance.place, &points[number_of_shape(&shapes, instance)]);
            instance.bounds = Bounds::around(points.iter().map(|&point| place.point(point)));
        });
    }
}

/// The stored triangles of the shapes of instances, each once, in order.
pub(crate) fn shapes_of<'a>(instances: impl Iterator<Item = &'a Instance>) -> Vec<Range<u32>> {
    let mut shapes: Vec<Range<u32>> = instances.map(|instance| instance.triangles.clone()).collect();
    shapes.sort_unstable_by_key(|shape| (shape.start, shape.end));
    shapes.dedup();
    shapes
}

/// Which of [these](shapes_of) is that of an instance.
pub(crate) fn number_of_shape(shapes: &[Range<u32>], Instance { triangles, .. }: &Instance) -> usize {
    shapes.partition_point(|shape| (shape.start, shape.end) < (triangles.start, triangles.end))
}
