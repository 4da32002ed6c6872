//! Shapes that are placed many times.
//!
//! A [`Mesh`] stores the triangles of a shape once, in coordinates of the shape's own, and an [`Instance`] for each place: the triangles that
//! rays meet there are computed when they are needed. Their indices begin at [`FIRST_INSTANCED`], those of one instance after those of another;
//! below are the triangles that the mesh [stores](Mesh::stored), of which those of shapes are nowhere themselves.
//!
//! What is computed is defined bit by bit: a mesh gives the same image as the [flat](Mesh::flattened) one, which has a copy for each instance.

use std::borrow::Cow;
use std::ops::Range;

use glam::{DAffine3, DMat3, DMat4, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use crate::geometry_check::check_room;
use crate::{Bounds, GeometryError, Mesh, UNNAMED, parse_by_name};

/// The index of the first triangle of the first instance: those below are stored.
pub const FIRST_INSTANCED: u32 = 1 << 31;
/// Triangles with larger coordinates are not hit.
const FARTHEST: f32 = (1u64 << 40) as f32;
/// Numbers of triangles of instances, of which the last means none.
pub(crate) const MOST_INSTANCED: usize = (u32::MAX - FIRST_INSTANCED) as usize;

/// Instances of which a shape is at most this much larger or smaller than its coordinates say: beyond, rounding would show.
const SCALES: Range<f64> = 1e-6..1e6;
/// The largest ratio of the lengths of a place's axes.
const LONGEST: f64 = 1e4;

/// Copies of a shape are as fast as they can be; from this number of triangles on, they take too much memory and time to build.
const MANY: usize = 1 << 20;
/// A shape of less triangles takes hardly more memory than the places of it.
const FEW: usize = 64;

/// Whether shapes that are placed many times are stored once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instancing {
    /// If copies would have more than a million triangles.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

impl Instancing {
    /// All of them.
    pub const ALL: &'static [Instancing] = &[Instancing::Auto, Instancing::Always, Instancing::Never];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Instancing::Auto => "auto",
            Instancing::Always => "always",
            Instancing::Never => "never",
        }
    }

    /// A short description.
    pub fn help(self) -> &'static str {
        match self {
            Instancing::Auto => "If copies would have more than a million triangles",
            Instancing::Always => "Wherever a mesh has several places",
            Instancing::Never => "A copy for each place; grids need this",
        }
    }

    pub(crate) fn shares(self, places: usize, triangles: usize) -> bool {
        match self {
            Instancing::Auto => triangles >= FEW && places.saturating_mul(triangles) > MANY,
            Instancing::Always => true,
            Instancing::Never => false,
        }
    }
}

parse_by_name!(Instancing, "instancing");

/// An affine map in single precision: three rows of a matrix, each with its translation.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Affine {
    /// Row by row.
    pub rows: [[f32; 4]; 3],
}

impl Affine {
    fn new(map: &DAffine3) -> Affine {
        let (matrix, shift) = (map.matrix3.transpose(), map.translation);
        let row = |axis: usize| {
            let row = matrix.col(axis).as_vec3();
            [row.x, row.y, row.z, shift[axis] as f32]
        };
        Affine { rows: [row(0), row(1), row(2)] }
    }

    /// A map and its inverse.
    fn both_ways(map: &DMat4) -> (Affine, Affine) {
        let place = Affine::new(&DAffine3::from_mat4(*map));
        let back = Affine::new(&place.to_double().inverse());
        (place, back)
    }

    /// Whether a map that places a shape can be one of these, for little is lost: it neither squeezes nor shears, enlarges or lessens too much.
    pub(crate) fn holds(map: &DMat4) -> bool {
        let matrix = DMat3::from_mat4(*map);
        let lengths = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length);
        let (least, most) = lengths.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &l| (low.min(l), high.max(l)));
        let is_usual = map.is_finite() && SCALES.contains(&least) && SCALES.contains(&most) && most < LONGEST * least;
        // Sheared flat, it has no inverse.
        is_usual && matrix.determinant().abs() > lengths.iter().product::<f64>() / LONGEST
    }

    fn to_double(self) -> DAffine3 {
        let row =
            |axis: usize| DVec3::new(self.rows[axis][0].into(), self.rows[axis][1].into(), self.rows[axis][2].into());
        let shift = self.rows.map(|row| f64::from(row[3]));
        DAffine3::from_mat3_translation(DMat3::from_cols(row(0), row(1), row(2)).transpose(), shift.into())
    }

    /// Where a point goes.
    #[inline(always)]
    pub fn point(&self, Vec3 { x, y, z }: Vec3) -> Vec3 {
        let axis = |row: &[f32; 4]| (row[0] * x + row[1] * y) + (row[2] * z + row[3]);
        Vec3::new(axis(&self.rows[0]), axis(&self.rows[1]), axis(&self.rows[2]))
    }

    /// Where a direction goes.
    #[inline(always)]
    pub fn vector(&self, Vec3 { x, y, z }: Vec3) -> Vec3 {
        let axis = |row: &[f32; 4]| (row[0] * x + row[1] * y) + row[2] * z;
        Vec3::new(axis(&self.rows[0]), axis(&self.rows[1]), axis(&self.rows[2]))
    }

    /// Where the normal of a surface goes, of unit length, if this is the inverse of the surface's place; zero stays zero.
    #[inline(always)]
    pub fn normal_back(&self, Vec3 { x, y, z }: Vec3) -> Vec3 {
        let [a, b, c] = &self.rows;
        let axis = |k: usize| (a[k] * x + b[k] * y) + c[k] * z;
        let normal = Vec3::new(axis(0), axis(1), axis(2));
        let square = normal.length_squared();
        if square > 0.0 { normal / square.sqrt() } else { Vec3::ZERO }
    }

    /// The largest sum of absolute values in a row: no coordinate of a vector becomes larger than this times its largest.
    pub fn norm(&self) -> f32 {
        self.rows.iter().fold(0.0, |most, row| most.max(row[0].abs() + row[1].abs() + row[2].abs()))
    }
}

/// A shape at one of its places.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The stored triangles of its shape.
    pub triangles: Range<u32>,
    /// The index of its first triangle; those of the shape follow in their order.
    pub first: u32,
    /// From the shape's coordinates to the local frame.
    pub place: Affine,
    /// The inverse.
    pub back: Affine,
    /// The number of its object.
    pub object: u32,
    /// The box around all of it that can be hit.
    pub bounds: Bounds,
}

/// The instances of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Instances {
    /// Stored triangles of all shapes.
    pub(crate) shapes: Range<u32>,
    /// Their vertices.
    pub(crate) vertices: Range<u32>,
    /// Where the origin of the shapes' coordinates lies in those in which they were placed.
    pub(crate) center: DVec3,
    list: Vec<Instance>,
    /// Number of triangles in all places.
    count: u32,
}

impl Instances {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// All of them, in the order of their triangles.
    pub fn list(&self) -> &[Instance] {
        &self.list
    }

    /// Number of triangles in all places.
    pub fn triangle_count(&self) -> usize {
        self.count as usize
    }

    /// The stored triangles of all shapes, which are nowhere themselves.
    pub fn shapes(&self) -> Range<usize> {
        self.shapes.start as usize..self.shapes.end as usize
    }

    /// The instance that has the triangle `index`, which is at least [`FIRST_INSTANCED`].
    #[inline]
    pub fn of(&self, index: u32) -> &Instance {
        &self.list[self.list.partition_point(|instance| instance.first <= index) - 1]
    }

    /// Checks that shapes are the last of a mesh.
    pub(crate) fn check(&self, mesh: &Mesh) -> Result<(), GeometryError> {
        let ends = (self.shapes.end as usize, self.vertices.end as usize);
        let are_last = self.shapes.is_empty() || ends == (mesh.triangles.len(), mesh.positions.len());
        are_last.then_some(()).ok_or(GeometryError::ShapesNotLast)
    }

    /// Places the stored triangles of a shape by a map that is [held](Affine::holds); there must be numbers for them.
    pub(crate) fn place(&mut self, triangles: Range<u32>, map: &DMat4, object: u32) {
        let (place, back) = Affine::both_ways(map);
        let first = FIRST_INSTANCED + self.count;
        self.count += triangles.len() as u32;
        self.list.push(Instance { triangles, first, place, back, object, bounds: Bounds::EMPTY });
    }
}

impl Mesh {
    /// Adds a shape that is stored once for several places, each of them an object with this name. `places` take the shape's coordinates to the
    /// local frame. All shapes have to be added after all other triangles. The instances of `shape` itself are copied.
    ///
    /// # Errors
    ///
    /// [`GeometryError::Place`] if a map cannot be inverted, or distorts too much; [`GeometryError::ShapesNotLast`];
    /// [`GeometryError::TooLarge`].
    pub fn add_instances(&mut self, shape: &Mesh, places: &[DMat4], object: &str) -> Result<(), GeometryError> {
        if let Some(place) = places.iter().position(|place| !Affine::holds(place)) {
            return Err(GeometryError::Place { place });
        }
        self.instances.check(self)?;
        let flat = shape.flattened()?;
        if flat.triangles.is_empty() || places.is_empty() {
            return Ok(());
        }
        let mirrors = |place: &DMat4| place.determinant() < 0.0;
        let (count, shapes) = (flat.triangles.len(), if places.iter().any(mirrors) { 2 } else { 1 });
        let (vertices, all) = (self.positions.len() + flat.positions.len(), self.triangles.len() + shapes * count);
        check_room(vertices, all.max(self.instances.triangle_count() + count.saturating_mul(places.len())))?;
        if all > FIRST_INSTANCED as usize || self.instances.triangle_count() + count * places.len() >= MOST_INSTANCED {
            return Err(GeometryError::TooLarge { vertices, triangles: self.triangle_count() + count * places.len() });
        }
        // 1. The shape, and behind it the same with its corners in reverse order, if it is mirrored anywhere.
        let (first_vertex, first) = (self.positions.len() as u32, self.triangles.len() as u32);
        if self.instances.shapes.is_empty() {
            (self.instances.shapes, self.instances.vertices) = (first..first, first_vertex..first_vertex);
        }
        self.append_vertices(&flat);
        let own = flat.triangles.iter().map(|triangle| triangle.map(|vertex| first_vertex + vertex));
        let mut own: Vec<[u32; 3]> = own.collect();
        for number in 0..shapes {
            self.triangles.extend_from_slice(&own);
            self.materials.extend_from_slice(&flat.materials);
            if number == 0 {
                own.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
        }
        self.instances.shapes.end = self.triangles.len() as u32;
        self.instances.vertices.end = self.positions.len() as u32;
        // 2. Its places.
        let before = self.instances.list.len();
        for place in places {
            let start = first + if mirrors(place) { count as u32 } else { 0 };
            self.place(start..start + count as u32, place, object);
        }
        self.find_bounds_of_instances(|number| number >= before);
        Ok(())
    }

    /// Places the stored triangles of a shape as the object `object`, see [`Instances::place`].
    pub(crate) fn place(&mut self, triangles: Range<u32>, map: &DMat4, object: &str) {
        if self.objects.runs().0.is_empty() {
            // What nobody named has the first number.
            self.objects.begin(0, if self.instances.shapes.start == 0 { object } else { UNNAMED });
        }
        let object = self.objects.number(object);
        self.instances.place(triangles, map, object);
    }

    /// Vertices of another mesh behind those that are there; what attributes either does not have becomes neutral.
    pub(crate) fn append_vertices(&mut self, other: &Mesh) {
        fn append<T: Copy>(to: &mut Vec<T>, from: &[T], (before, after): (usize, usize), none: T) {
            if to.is_empty() && from.is_empty() {
                return;
            }
            to.resize(before, none);
            to.extend_from_slice(from);
            to.resize(after, none);
        }
        let before = self.positions.len();
        self.positions.extend_from_slice(&other.positions);
        let counts = (before, self.positions.len());
        append(&mut self.normals, &other.normals, counts, Vec3::ZERO);
        append(&mut self.uvs, &other.uvs, counts, Vec2::ZERO);
        append(&mut self.colors, &other.colors, counts, Vec3::ONE);
        append(&mut self.opacities, &other.opacities, counts, 1.0);
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

    /// The vertices of a shape, each once.
    fn vertices_of(&self, triangles: Range<u32>) -> Vec<u32> {
        self.vertices_of_some(triangles, |_| true)
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

    fn vertices_of_some(&self, triangles: Range<u32>, counts: impl Fn(&[u32; 3]) -> bool) -> Vec<u32> {
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

    fn find_bounds_of_instances(&mut self, are_asked: impl Fn(usize) -> bool + Sync) {
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

    /// The same with a copy of the shape for each instance: the triangles that are where they are stored, then those of the instances in their
    /// order. What is computed of these is the same bit by bit.
    ///
    /// # Errors
    ///
    /// [`GeometryError::TooLarge`]
    pub fn flattened(&self) -> Result<Mesh, GeometryError> {
        let mut flat = self.without_shapes();
        let shapes = shapes_of(self.instances.list.iter());
        let vertices: Vec<Vec<u32>> = shapes.par_iter().map(|shape| self.vertices_of(shape.clone())).collect();
        let vertices_of = |instance: &Instance| &vertices[number_of_shape(&shapes, instance)];
        let count: usize = self.instances.list.iter().map(|instance| vertices_of(instance).len()).sum();
        check_room(flat.positions.len() + count, self.triangle_count())?;
        for instance in &self.instances.list {
            flat.append_instance(self, instance, vertices_of(instance));
        }
        Ok(flat)
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
        self.objects.begin(self.triangles.len(), from.objects.name(instance.object));
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
        for Instance { bounds, triangles: shape, .. } in &self.instances.list {
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

/// The stored triangles of the shapes of instances, each once, in order.
fn shapes_of<'a>(instances: impl Iterator<Item = &'a Instance>) -> Vec<Range<u32>> {
    let mut shapes: Vec<Range<u32>> = instances.map(|instance| instance.triangles.clone()).collect();
    shapes.sort_unstable_by_key(|shape| (shape.start, shape.end));
    shapes.dedup();
    shapes
}

/// Which of [these](shapes_of) is that of an instance.
fn number_of_shape(shapes: &[Range<u32>], Instance { triangles, .. }: &Instance) -> usize {
    shapes.partition_point(|shape| (shape.start, shape.end) < (triangles.start, triangles.end))
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
