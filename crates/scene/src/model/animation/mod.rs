//! Scenes that move: what a file says of the places of its things over time.
//!
//! 1. [`track`]: values by keys.
//! 2. [`rig`]: nodes that move each other.
//! 3. [`parts`]: meshes that go with them, are bent by skeletons or change their shape.
//! 4. [`views`]: cameras and lights.
//!
//! A scene stays what it is: [`Scene::at`](crate::Scene::at) makes a new one in which only what moves differs.

pub(crate) mod parts;
pub(crate) mod rig;
pub(crate) mod track;
pub(crate) mod views;

use std::ops::Range;

use self::{
    parts::{MovingInstance, MovingPart},
    rig::Rig,
    views::Motion,
};
use super::{camera::Camera, geometry::Geometry, light::Light};

/// How the things of a scene move. Times are in seconds from the beginning.
#[derive(Debug, Default)]
pub struct Animation {
    pub(crate) rig: Rig,
    pub(crate) parts: Vec<MovingPart>,
    pub(crate) instances: Vec<MovingInstance>,
    pub(crate) cameras: Vec<Motion<Camera>>,
    pub(crate) lights: Vec<Motion<Light>>,
    pub(crate) duration: f64,
    /// Names of the animations of files that are played.
    pub(crate) names: Vec<String>,
    /// Names of those that are not.
    pub(crate) others: Vec<String>,
    /// Which materials may be [those of lamps](crate::Material::lamp), if what has one of them moves.
    pub(crate) lamps: Option<Vec<bool>>,
}

impl Animation {
    /// Seconds from the first frame to the last one.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The animations of files that are played, by name.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The animations of files that are not played, since they move what another one moves; see
    /// [`LoadOptions::animation`](crate::LoadOptions::animation).
    pub fn others(&self) -> &[String] {
        &self.others
    }

    /// Whether surfaces move: not only cameras and lights.
    pub fn moves_surfaces(&self) -> bool {
        !self.parts.is_empty() || !self.instances.is_empty()
    }

    /// Records which materials may be those of lamps, if a part that moves has one.
    pub(crate) fn note_lamps(&mut self, geometry: &Geometry) {
        let shines = |&material: &u32| geometry.materials.get(material as usize).is_some_and(|material| material.lamp);
        let moves = |triangles: Range<usize>| geometry.mesh.materials[triangles].iter().any(shines);
        let places = geometry.mesh.instances.list();
        let shape = |moving: &MovingInstance| places.get(moving.instance).map(|place| place.triangles.clone());
        let mut shapes: Vec<Range<u32>> = self.instances.iter().filter_map(shape).collect();
        shapes.sort_by_key(|shape| (shape.start, shape.end));
        shapes.dedup();
        let mut shapes = shapes.into_iter();
        if self.parts.iter().any(|part| moves(part.triangles.clone()))
            || shapes.any(|shape| moves(shape.start as usize..shape.end as usize))
        {
            self.lamps = Some(geometry.materials.iter().map(|material| material.lamp).collect());
        }
    }

    /// Whether nothing moves.
    pub(crate) fn is_still(&self) -> bool {
        !self.moves_surfaces() && self.cameras.is_empty() && self.lights.is_empty()
    }
}
