//! Scenes that move: what a file says of the places of its things over time.
//!
//! 1. [`track`]: values by keys.
//! 2. [`rig`]: nodes that move each other.
//! 3. [`parts`]: meshes that go with them, are bent by skeletons or change their shape.
//! 4. [`views`]: cameras and lights.
//!
//! A scene stays what it is: [`Scene::at`] makes a new one in which only what moves differs.

pub(crate) mod parts;
pub(crate) mod rig;
pub(crate) mod track;
pub(crate) mod views;

use std::ops::Range;
use std::sync::Arc;

use self::{
    parts::{MovingInstance, MovingPart},
    rig::Rig,
    views::{Carried, Motion},
};
use crate::{Camera, Geometry, Light, Scene};

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

impl Scene {
    /// How the scene moves, if it does.
    pub fn animation(&self) -> Option<&Animation> {
        self.animation.as_deref()
    }

    /// The scene at `time`, in seconds from the beginning of its animation: before it and after its end everything stays where it is then.
    /// Cameras and lights that were added to it stay. The local frame is the same at all times; the geometry is shared with this scene if
    /// only cameras and lights move.
    pub fn at(&self, time: f64) -> Scene {
        let mut scene = self.clone();
        let Some(animation) = &self.animation else { return scene };
        let places = animation.rig.places(Some(time));
        for camera in &mut scene.cameras {
            if let Some((found, world)) = at(&animation.cameras, camera.motion, time, &places) {
                let position = self.to_local(world);
                *camera = Camera { name: std::mem::take(&mut camera.name), motion: camera.motion, position, ..found };
            }
        }
        for light in scene.lights.iter_mut() {
            if let Some((found, world)) = at(&animation.lights, light.motion, time, &places) {
                let named = Light { name: std::mem::take(&mut light.name), motion: light.motion, ..found };
                *light = named.at(self.to_local(world));
            }
        }
        if animation.moves_surfaces() {
            let geometry = Arc::make_mut(&mut scene.geometry);
            for part in &animation.parts {
                part.pose(&places, time, geometry.origin, &mut geometry.mesh);
            }
            let instances = animation.instances.iter();
            let moved = instances.map(|moving| (moving.instance, places[moving.node as usize] * moving.place));
            geometry.mesh.move_instances(moved, geometry.origin);
            if let Some(marks) = &animation.lamps {
                scene.move_lamps(marks);
            }
        }
        scene
    }

    /// Makes the lights of lamps anew, in their place among the others; none if they were replaced by other lights.
    fn move_lamps(&mut self, marks: &[bool]) {
        let Some(place) = self.lights.iter().position(|light| light.lamp) else { return };
        self.lights.retain(|light| !light.lamp);
        let geometry = Arc::make_mut(&mut self.geometry);
        for (material, &mark) in geometry.materials.iter_mut().zip(marks) {
            material.lamp = mark;
        }
        let lamps = crate::lamps::lamps(geometry);
        self.lights.splice(place..place, lamps);
    }
}

/// What has the motion `number` at `time`.
fn at<T: Carried>(
    motions: &[Motion<T>],
    number: Option<u32>,
    time: f64,
    places: &[glam::DMat4],
) -> Option<(T, glam::DVec3)> {
    motions.get(number? as usize)?.at(time, places)
}
