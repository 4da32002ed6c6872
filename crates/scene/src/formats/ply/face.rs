//! The faces and triangle strips of a PLY file.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::{rows::Row, vertex::Color};
use crate::formats::{
    polygon::Cutter,
    vertices::{NONE, Vertices},
};

/// Triangles of faces, and their effect on the vertices.
#[derive(Default)]
pub(super) struct Faces {
    pub(super) triangles: Vec<[u32; 3]>,
    /// If faces have colours: a vertex for each combination of the file's vertices (first index) and colours (second).
    pub(super) split: Option<Vertices>,
    /// Colours of faces, linear.
    pub(super) colors: Vec<Vec3>,
    color_indices: HashMap<[u32; 3], u32>,
    pub(super) cutter: Cutter,
    /// Faces with fewer than three corners.
    pub(super) left_out: usize,
    corners: Vec<u32>,
    corner_positions: Vec<DVec3>,
}

impl Faces {
    /// Adds one face.
    ///
    /// # Errors
    ///
    /// The first index that is not a vertex.
    pub(super) fn push(&mut self, row: &Row, color: Option<&Color>, positions: &[DVec3]) -> Result<(), f64> {
        self.corners.clear();
        for &index in &row.list {
            self.corners.push(vertex(index, positions.len()).ok_or(index)?);
        }
        if self.corners.len() < 3 {
            self.left_out += 1;
            return Ok(());
        }
        self.corner_positions.clear();
        if self.corners.len() > 3 {
            self.corner_positions.extend(self.corners.iter().map(|&corner| positions[corner as usize]));
        }
        if let Some(color) = color {
            let color = self.color_index(color.linear(row));
            let split = self.split.get_or_insert_default();
            self.corners.iter_mut().for_each(|corner| *corner = split.of([*corner, color, NONE]));
        }
        let Faces { corners, corner_positions, triangles, cutter, .. } = self;
        if let &[a, b, c] = &corners[..] {
            triangles.push([a, b, c]);
        } else {
            cutter.cut(corner_positions, |triangle| triangles.push(triangle.map(|corner| corners[corner])));
        }
        Ok(())
    }

    /// The index of a colour.
    fn color_index(&mut self, color: Vec3) -> u32 {
        if self.colors.last() == Some(&color) {
            return self.colors.len() as u32 - 1;
        }
        *self.color_indices.entry(color.to_array().map(f32::to_bits)).or_insert_with(|| {
            self.colors.push(color);
            self.colors.len() as u32 - 1
        })
    }

    /// Adds triangle strips, one after another: each vertex forms a triangle with the two before it, reversed every other time;
    /// −1 starts a new strip. Triangles that use a vertex twice only move the strip to its next position.
    ///
    /// # Errors
    ///
    /// The first index that is not a vertex.
    pub(super) fn push_strips(&mut self, row: &Row, vertices: usize) -> Result<(), f64> {
        const RESTART: f64 = -1.0;
        for strip in row.list.split(|&index| index == RESTART) {
            self.corners.clear();
            for &index in strip {
                self.corners.push(vertex(index, vertices).ok_or(index)?);
            }
            for (number, triangle) in self.corners.windows(3).enumerate() {
                let &[a, b, c] = triangle else { continue };
                if a != b && b != c && c != a {
                    self.triangles.push(if number % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
            }
        }
        Ok(())
    }
}

/// The vertex of an index, if it exists.
fn vertex(index: f64, count: usize) -> Option<u32> {
    (index >= 0.0 && index < count as f64 && index.fract() == 0.0).then_some(index as u32)
}
