//! Shapes of a draft that are stored once for all of their places.

use std::ops::Range;

use glam::DMat4;

use super::Draft;
use crate::model::animation::parts::MovingInstance;
use crate::{LoadError, ObjectKey};

impl Draft {
    /// Whether a shape of so many triangles is stored once for all of its places.
    pub(crate) fn shares(&self, places: usize, triangles: usize) -> bool {
        let budget = &self.access.budget;
        self.beside_shape.is_none() && places > 1 && triangles > 0 && self.instancing.shares(places, triangles, budget)
    }

    /// Adds a shape that is nowhere until it is [placed](Draft::place): `add` adds its parts as they are without a place, in reverse order of
    /// corners for places that mirror. `None` if it cannot be in many places, for it has cameras or lights, or parts of
    /// it move.
    pub(crate) fn shape(
        &mut self,
        mirrored: bool,
        add: impl FnOnce(&mut Draft) -> Result<(), LoadError>,
    ) -> Result<Option<Range<usize>>, LoadError> {
        self.builder.exchange_shapes(&mut self.beside_shape);
        let (own, mover) = (std::mem::take(&mut self.without_uvs), self.mover.take());
        let views = (self.cameras.len(), self.lights.len());
        let empties = self.empties.len();
        self.shape_moves = false;
        let first = self.builder.triangle_count();
        let added = add(self);
        let shape = first..self.builder.triangle_count();
        if mirrored {
            self.builder.reverse(shape.clone());
        }
        let without_uvs = std::mem::replace(&mut self.without_uvs, own);
        self.shapes_without_uvs.extend(without_uvs);
        self.mover = mover;
        let has_views = views != (self.cameras.len(), self.lights.len());
        self.cameras.truncate(views.0);
        self.lights.truncate(views.1);
        // They are nowhere either.
        self.empties.truncate(empties);
        self.builder.exchange_shapes(&mut self.beside_shape);
        let can_be_placed = !has_views && !self.shape_moves && !shape.is_empty();
        added.map(|()| can_be_placed.then_some(shape))
    }

    /// Places a shape; `false` if it cannot be placed so. `held` is the node that moves it, in whose coordinates the transform places it.
    pub(crate) fn place(
        &mut self,
        shape: Range<usize>,
        transform: &DMat4,
        object: Option<&ObjectKey>,
        held: Option<(u32, DMat4)>,
    ) -> bool {
        if !self.builder.place(shape, transform, object) {
            return false;
        }
        let instance = self.builder.place_count() - 1;
        self.animation.instances.extend(held.map(|(node, place)| MovingInstance { instance, node, place }));
        true
    }

    /// Whether what is fastened to this node may be stored once for all of its places.
    pub(crate) fn may_hold_shapes(&self, node: u32) -> bool {
        !self.animation.rig.scales(node)
    }

    /// The objects of a shape, each with a run of its triangles; none if nothing in it was named.
    pub(crate) fn objects_of(&mut self, shape: &Range<usize>) -> Vec<(Range<usize>, ObjectKey)> {
        self.builder.exchange_shapes(&mut self.beside_shape);
        let objects = self.builder.objects_of(shape);
        self.builder.exchange_shapes(&mut self.beside_shape);
        objects
    }
}
