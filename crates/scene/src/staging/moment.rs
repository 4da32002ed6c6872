//! A scene that moves, at one moment.

use std::sync::Arc;

use glam::{DMat4, DVec3};

use crate::model::animation::views::{Carried, Motion};
use crate::optics::lamps::lamps;
use crate::{Camera, Light, Scene};

impl Scene {
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
        let lamps = lamps(geometry);
        self.lights.splice(place..place, lamps);
    }
}

/// What has the motion `number` at `time`.
fn at<T: Carried>(motions: &[Motion<T>], number: Option<u32>, time: f64, places: &[DMat4]) -> Option<(T, DVec3)> {
    motions.get(number? as usize)?.at(time, places)
}
