//! Parts of a mesh that move: as a whole, by a skeleton, or between shapes.
//!
//! 1. A vertex is moved by its morph targets, each with a weight (glTF 2.0, 3.7.2.2).
//! 2. It goes with a node, or with a mixture of the joints of a skin (3.7.3.3); normals by the inverse transpose.

use std::ops::Range;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3, Vec3};
use rayon::prelude::*;

use super::track::Track;
use crate::model::transforms::{LARGEST_COORDINATE, mirrors, normal_placement};
use crate::{Mesh, OwnedPositions};

/// Vertices of a part before they are placed.
#[derive(Debug)]
pub struct Shape {
    /// In the part's own coordinates.
    pub positions: OwnedPositions,
    /// One for each vertex, or none.
    pub normals: Vec<Vec3>,
    /// What is blended into it.
    pub morph: Option<Morph>,
}

/// Shapes that are blended into a part.
#[derive(Debug)]
pub struct Morph {
    /// What there is to blend.
    pub targets: Vec<Target>,
    /// One for each target.
    pub rest: Vec<f64>,
    /// The weights that change with time.
    pub weights: Option<Arc<Track>>,
}

/// What a shape adds, for each vertex, or nothing.
#[derive(Debug)]
pub struct Target {
    /// To positions.
    pub positions: Vec<Vec3>,
    /// To normals.
    pub normals: Vec<Vec3>,
}

/// What holds a part.
#[derive(Clone, Debug)]
pub enum Hold {
    /// It goes with a node of the rig, in whose coordinates the transform places it.
    Node(u32, DMat4),
    /// It is bent by a skeleton.
    Skin(Arc<Skin>, Arc<Influences>),
}

/// A skeleton.
#[derive(Debug)]
pub struct Skin {
    /// Nodes of the rig; at least one.
    pub joints: Vec<u32>,
    /// From the mesh's coordinates to each joint's.
    pub inverse_bind: Vec<DMat4>,
}

/// The joints of each vertex, as many for each.
#[derive(Debug)]
pub struct Influences {
    /// How many a vertex has.
    pub per_vertex: usize,
    /// Indices into the joints of the skin.
    pub joints: Vec<u16>,
    /// Not negative.
    pub weights: Vec<f32>,
}

/// A part of a scene's mesh that moves.
#[derive(Debug)]
pub(crate) struct MovingPart {
    /// Its vertices in the scene's mesh.
    pub(crate) vertices: Range<usize>,
    /// Its triangles.
    pub(crate) triangles: Range<usize>,
    pub(crate) shape: Arc<Shape>,
    pub(crate) hold: Hold,
    /// Whether the vertex order of its triangles was reversed, since the transform at rest mirrors.
    pub(crate) reversed: bool,
}

/// An instance that goes with a node of the rig, which is never enlarged or lessened: so there always is an inverse of its place.
#[derive(Debug)]
pub(crate) struct MovingInstance {
    /// Its number.
    pub(crate) instance: usize,
    pub(crate) node: u32,
    /// From the shape's coordinates to the node's.
    pub(crate) place: DMat4,
}

/// The transforms of vertices.
enum Placing<'a> {
    /// All have the same.
    Same(DMat4),
    /// Each has a mixture of those of joints.
    Mixed(&'a Influences, Vec<DMat4>),
}

impl Shape {
    /// World positions and normals at `time`, or at rest; nodes are at `places`.
    pub fn posed(&self, hold: &Hold, places: &[DMat4], time: Option<f64>) -> (Vec<DVec3>, Vec<Vec3>) {
        let weights = self.morph.as_ref().map(|morph| morph.weights(time)).unwrap_or_default();
        let placing = hold.placing(places);
        let (positions, mut normals): (Vec<DVec3>, Vec<Vec3>) = (0..self.positions.len())
            .into_par_iter()
            .map(|vertex| {
                let transform = placing.of(vertex);
                let normal = cofactors(&DMat3::from_mat4(transform)) * self.normal(vertex, &weights);
                let position = transform.transform_point3(self.position(vertex, &weights));
                (position, normal.normalize_or_zero().as_vec3())
            })
            .unzip();
        normals.truncate(self.normals.len());
        (positions, normals)
    }

    fn position(&self, vertex: usize, weights: &[f64]) -> DVec3 {
        let added = self.targets(weights).map(|(weight, target)| weight * added(&target.positions, vertex));
        added.fold(self.positions.get(vertex), |sum, added| sum + added)
    }

    fn normal(&self, vertex: usize, weights: &[f64]) -> DVec3 {
        let added = self.targets(weights).map(|(weight, target)| weight * added(&target.normals, vertex));
        let own = self.normals.get(vertex).map_or(DVec3::ZERO, |normal| normal.as_dvec3());
        added.fold(own, |sum, added| sum + added)
    }

    /// The targets that count.
    fn targets<'a>(&'a self, weights: &'a [f64]) -> impl Iterator<Item = (f64, &'a Target)> {
        let targets = self.morph.iter().flat_map(|morph| &morph.targets);
        weights.iter().copied().zip(targets).filter(|(weight, _)| *weight != 0.0)
    }
}

fn added(values: &[Vec3], vertex: usize) -> DVec3 {
    values.get(vertex).map_or(DVec3::ZERO, |value| value.as_dvec3())
}

impl Morph {
    fn weights(&self, time: Option<f64>) -> Vec<f64> {
        let mut weights = self.rest.clone();
        if let (Some(track), Some(time)) = (&self.weights, time) {
            track.sample(time, &mut weights);
        }
        weights
    }
}

impl Hold {
    fn placing(&self, places: &[DMat4]) -> Placing<'_> {
        match self {
            Hold::Node(node, local) => Placing::Same(places[*node as usize] * *local),
            Hold::Skin(skin, influences) => {
                let joints = skin.joints.iter().zip(&skin.inverse_bind);
                let joints = joints.map(|(&joint, inverse_bind)| places[joint as usize] * *inverse_bind);
                Placing::Mixed(influences, joints.collect())
            }
        }
    }
}

impl Placing<'_> {
    fn of(&self, vertex: usize) -> DMat4 {
        match self {
            Placing::Same(transform) => *transform,
            Placing::Mixed(influences, joints) => influences.mixed(vertex, joints),
        }
    }
}

impl Influences {
    /// Whether no joint holds some vertex.
    pub(crate) fn leave_any(&self) -> bool {
        self.weights.chunks_exact(self.per_vertex).any(|own| own.iter().all(|&weight| weight == 0.0))
    }

    /// The mean of the transforms of a vertex's joints by their weights, or that of the first joint if it has none.
    fn mixed(&self, vertex: usize, joints: &[DMat4]) -> DMat4 {
        let own = vertex * self.per_vertex..(vertex + 1) * self.per_vertex;
        let (numbers, weights) = (&self.joints[own.clone()], &self.weights[own]);
        let sum: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
        let pairs = numbers.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
        if sum > 0.0 {
            pairs.fold(DMat4::ZERO, |mixed, (&joint, &weight)| {
                mixed + joints[usize::from(joint)] * (f64::from(weight) / sum)
            })
        } else {
            joints[0]
        }
    }
}

/// A multiple of the inverse transpose: the transform of normals, which exists even where a surface is flattened.
pub fn cofactors(matrix: &DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = *matrix;
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if matrix.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}

impl MovingPart {
    /// Moves the part of a mesh, whose coordinates are relative to `origin`, to where it is at `time`; nodes are at `places`. What somebody has
    /// taken out of the mesh is left alone.
    pub(crate) fn pose(&self, places: &[DMat4], time: f64, origin: DVec3, mesh: &mut Mesh) {
        let Mesh { positions, normals, triangles, .. } = mesh;
        let Some(positions) = positions.get_mut(self.vertices.clone()) else { return };
        let normals = normals.get_mut(self.vertices.clone()).unwrap_or_default();
        let to_local = |world: DVec3| {
            let is_usable = world.abs().cmple(DVec3::splat(LARGEST_COORDINATE)).all();
            // Triangles with such a corner are not hit.
            if is_usable { (world - origin).as_vec3() } else { Vec3::NAN }
        };
        match (&self.hold, &self.shape.morph) {
            (Hold::Node(node, local), None) => {
                let transform = places[*node as usize] * *local;
                positions.par_iter_mut().enumerate().for_each(|(vertex, position)| {
                    *position = to_local(transform.transform_point3(self.shape.positions.get(vertex)));
                });
                if !self.shape.normals.is_empty() {
                    let place = normal_placement(&transform);
                    normals.iter_mut().zip(&self.shape.normals).for_each(|(normal, &own)| *normal = place(own));
                }
                self.face(mirrors(&transform), triangles);
            }
            _ => {
                let (places_now, normals_now) = self.shape.posed(&self.hold, places, Some(time));
                positions.iter_mut().zip(places_now).for_each(|(position, world)| *position = to_local(world));
                normals.iter_mut().zip(normals_now).for_each(|(normal, now)| *normal = now);
                if let Hold::Node(node, local) = &self.hold {
                    self.face(mirrors(&(places[*node as usize] * *local)), triangles);
                }
            }
        }
    }

    /// Reverses the triangles if they are mirrored and were not at rest, or the other way round.
    fn face(&self, mirrored: bool, triangles: &mut [[u32; 3]]) {
        if mirrored != self.reversed {
            let own = triangles.get_mut(self.triangles.clone()).unwrap_or_default();
            own.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
    }
}
