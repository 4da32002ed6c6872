//! Shapes that are placed many times.
//!
//! A [`Mesh`](crate::Mesh) stores the triangles of a shape once, in coordinates of the shape's own, and an [`Instance`] for each place: the triangles that
//! rays meet there are computed when they are needed. Their indices begin at [`FIRST_INSTANCED`], those of one instance after those of another;
//! below are the triangles that the mesh [stores](crate::Mesh::stored), of which those of shapes are nowhere themselves.
//!
//! What is computed is defined bit by bit: a mesh gives the same image as the [flat](crate::Mesh::flattened) one, which has a copy for each instance.

use std::ops::Range;

use glam::{DAffine3, DMat3, DMat4, DVec3, Vec3};
use lightmesh_memory::Budget;
use serde::{Deserialize, Serialize};

use super::bounds::Bounds;
use crate::parse_by_name;

/// The index of the first triangle of the first instance: those below are stored.
pub const FIRST_INSTANCED: u32 = 1 << 31;

/// Numbers of triangles of instances, of which the last means none.
pub(crate) const MAX_INSTANCED: usize = (u32::MAX - FIRST_INSTANCED) as usize;

/// Instances of which a shape is at most this much larger or smaller than its coordinates say: beyond, rounding would show.
const SCALES: Range<f64> = 1e-6..1e6;
/// The largest ratio of the lengths of a place's axes.
const LONGEST: f64 = 1e4;

/// Copies of a shape are as fast as they can be; from this number of triangles on, they take too much memory and time to build.
const MANY: usize = 1 << 20;
/// A shape of less triangles takes hardly more memory than the places of it, and copies are faster.
const FEW: usize = 64;
/// Bytes that a copied triangle takes at most while its structure is built.
const BYTES_OF_COPY: u64 = 512;

/// Whether shapes that are placed many times are stored once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instancing {
    /// If copies would have more than a million triangles; of shapes of a few triangles, if they would not fit into memory.
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
            Instancing::Auto => "If copies would have more than a million triangles, or not fit into memory",
            Instancing::Always => "Wherever a mesh has several places",
            Instancing::Never => "A copy for each place; grids need this",
        }
    }

    pub(crate) fn shares(self, places: usize, triangles: usize, budget: &Budget) -> bool {
        let copied = places.saturating_mul(triangles);
        let fits = || budget.check((copied as u64).saturating_mul(BYTES_OF_COPY)).is_ok();
        match self {
            Instancing::Auto => copied > MANY && (triangles >= FEW || !fits()),
            Instancing::Always => true,
            Instancing::Never => false,
        }
    }
}

parse_by_name!(Instancing, "instancing");

/// An affine map in single precision: three rows of a matrix, each with its translation.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable, Serialize, Deserialize)]
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
    pub(super) fn both_ways(map: &DMat4) -> (Affine, Affine) {
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Instances {
    /// Stored triangles of all shapes.
    pub(crate) shapes: Range<u32>,
    /// Their vertices.
    pub(crate) vertices: Range<u32>,
    /// Where the origin of the shapes' coordinates lies in those in which they were placed.
    pub(crate) center: DVec3,
    pub(super) list: Vec<Instance>,
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

    /// Places the stored triangles of a shape by a map that is [held](Affine::holds); there must be numbers for them.
    pub(crate) fn place(&mut self, triangles: Range<u32>, map: &DMat4, object: u32) {
        let (place, back) = Affine::both_ways(map);
        let first = FIRST_INSTANCED + self.count;
        self.count += triangles.len() as u32;
        self.list.push(Instance { triangles, first, place, back, object, bounds: Bounds::EMPTY });
    }
}
