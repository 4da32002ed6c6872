//! Shapes in many places: what a structure needs to walk them, and the triangles that rays meet there.
//!
//! A structure over instances has two levels: one over the scene's own triangles and the boxes around instances, and one for each shape, in the
//! shape's coordinates. Rays are taken to these and enter boxes there; but triangles are tested where they are in the scene, so that hits have the
//! same bits as those of a flat scene.
//!
//! # The margin
//!
//! Let ε = 2⁻²⁴, N the norm of the inverse of the instance's place, and W the sum of the largest coordinate of the ray's origin and of the terms
//! that are added where the shape's corners are placed, which exceed all coordinates of the instance. Corners are computed with an error of at most
//! 4 ε W in the scene. Let V be N W and the largest coordinate to which the inverse takes the origin of coordinates. A ray is taken to the shape with
//! an error of 4 ε V where it begins, as far away as W another 4 ε V for its direction, and 2 ε V for the rounding of the inverse. The test itself
//! reports points up to 9 ε W outside their triangle. All boxes of a shape are enlarged by [`INSTANCE_MARGIN`] V, 64 ε V, for these 23 ε V.

use std::sync::Arc;

use glam::Vec3;
use lightmesh_layout::constants::INSTANCE_MARGIN;
use lightmesh_scene::{Affine, FIRST_INSTANCED, Instance};

use super::Triangle;

// Kernels and the scene count alike.
const _: () = assert!(FIRST_INSTANCED == lightmesh_layout::constants::FIRST_INSTANCED);

/// A shape at one of its places.
#[derive(Clone, Copy, Debug)]
pub struct Instanced {
    /// From its shape to the scene.
    pub place: Affine,
    /// From the scene to its shape.
    pub back: Affine,
    /// The index of its first triangle.
    pub first: u32,
    /// Where the triangles of its shape are stored.
    pub stored: u32,
    /// Where the shape's tree is.
    pub tree: ShapeTree,
    /// The norm of `back`.
    pub norm: f32,
    /// The largest sum of absolute values that are added where a corner of its shape is placed.
    pub reach: f32,
    /// The largest coordinate of the local frame's origin in the shape's.
    pub shift: f32,
    /// The number of its object.
    pub object: u32,
}

/// Where the tree of a shape is in a structure.
#[derive(Clone, Copy, Debug)]
pub struct ShapeTree {
    /// Its root among the nodes.
    pub root: u32,
    /// Its first triangle among those in the order of leaves.
    pub leaves: u32,
}

impl Instanced {
    /// `far` are the largest absolute coordinates of its shape.
    pub(crate) fn new(instance: &Instance, tree: ShapeTree, far: Vec3) -> Instanced {
        let placed = instance.place.rows.map(|[x, y, z, w]| Vec3::new(x, y, z).abs().dot(far) + w.abs());
        Instanced {
            place: instance.place,
            back: instance.back,
            first: instance.first,
            stored: instance.triangles.start,
            tree,
            norm: instance.back.norm(),
            reach: Vec3::from(placed).max_element(),
            shift: instance.back.rows.iter().fold(0.0, |most, row| most.max(row[3].abs())),
            object: instance.object,
        }
    }

    /// What tells it from others: its place, and where its triangles are.
    pub fn key(&self) -> Vec<u8> {
        let of_triangles = [self.first.to_le_bytes(), self.stored.to_le_bytes()].concat();
        let place = self.place.rows.as_flattened().iter().flat_map(|value| value.to_le_bytes());
        of_triangles.into_iter().chain(place).collect()
    }

    /// A triangle of the shape where it is in the scene.
    #[inline(always)]
    pub(crate) fn triangle(&self, stored: &Triangle) -> Triangle {
        let corners = stored.corners().map(|corner| self.place.point(corner));
        Triangle::new(corners, self.first + (stored.index() - self.stored)).alpha_tested(stored.cut())
    }

    /// A ray in the shape's coordinates.
    #[inline(always)]
    pub(super) fn ray(&self, (origin, direction): (Vec3, Vec3)) -> (Vec3, Vec3) {
        (self.back.point(origin), self.back.vector(direction))
    }

    /// How far outside of the shape's boxes a ray from `origin` may pass, if that is `slack` in the scene.
    #[inline(always)]
    pub(super) fn slack(&self, origin: Vec3, slack: f32) -> f32 {
        self.norm * slack + INSTANCE_MARGIN * (self.norm * (origin.abs().max_element() + self.reach) + self.shift)
    }
}

/// The triangles of a geometry by index: those that are stored, and those of instances, which are computed.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    stored: Arc<[Triangle]>,
    instances: Arc<[Instanced]>,
}

impl Triangles {
    /// Triangles that are stored, and the instances of some of them.
    pub fn new(stored: Arc<[Triangle]>, instances: Arc<[Instanced]>) -> Triangles {
        Triangles { stored, instances }
    }

    /// The triangle `index`, where it is in the scene.
    #[inline(always)]
    pub fn at(&self, index: u32) -> Triangle {
        match index < FIRST_INSTANCED {
            true => self.stored[index as usize],
            false => self.instanced(index),
        }
    }

    #[inline(never)]
    fn instanced(&self, index: u32) -> Triangle {
        let number = self.instances.partition_point(|instance| instance.first <= index) - 1;
        let instance = &self.instances[number];
        instance.triangle(&self.stored[(instance.stored + (index - instance.first)) as usize])
    }

    /// The instances.
    pub fn instances(&self) -> &[Instanced] {
        &self.instances
    }

    /// Those that are stored; those of shapes are in the shapes' coordinates.
    pub fn stored(&self) -> &[Triangle] {
        &self.stored
    }
}

impl From<Vec<Triangle>> for Triangles {
    fn from(stored: Vec<Triangle>) -> Triangles {
        Triangles { stored: stored.into(), instances: Arc::default() }
    }
}
