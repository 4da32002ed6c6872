//! Cameras and lights that move.

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DMat4, DVec3, Vec3};

use crate::model::light::usable_radius;
use crate::model::transforms::{is_place, unit, upright};
use crate::{Camera, Light, LightKind};

/// A camera or light whose own values depend on time.
pub(crate) trait Keyed<T>: Debug + Send + Sync {
    /// It at `time`, in seconds, at the local frame's origin, and its world position; `None` where its values make none.
    fn at(&self, time: f64) -> Option<(T, DVec3)>;
}

/// How a camera or light moves.
#[derive(Clone, Debug)]
pub(crate) enum Motion<T> {
    /// With a node of the rig, in whose coordinates this is.
    Node(u32, Box<T>),
    /// By keys of its own.
    Keys(Arc<dyn Keyed<T>>),
}

/// Adds a motion to a list; returns its number.
pub(crate) fn numbered<T>(motions: &mut Vec<Motion<T>>, motion: Motion<T>) -> u32 {
    motions.push(motion);
    motions.len() as u32 - 1
}

/// What a node can carry.
pub(crate) trait Carried: Sized {
    /// It under a transform, at the local frame's origin; `None` if the transform leaves it no direction or size.
    fn carried(&self, transform: &DMat4) -> Option<Self>;
}

impl<T: Carried> Motion<T> {
    /// It at `time`, while nodes are at `places`, and its world position.
    pub(crate) fn at(&self, time: f64, places: &[DMat4]) -> Option<(T, DVec3)> {
        match self {
            Motion::Node(node, carried) => {
                let place = &places[*node as usize];
                Some((carried.carried(place)?, place.w_axis.truncate()))
            }
            Motion::Keys(keyed) => keyed.at(time),
        }
        .filter(|(_, world)| is_place(*world))
    }
}

impl Carried for Camera {
    fn carried(&self, transform: &DMat4) -> Option<Camera> {
        let direction = turned(transform, self.direction)?;
        let up = upright(direction, turned(transform, self.up)?)?;
        Some(Camera { direction: direction.as_vec3(), up: up.as_vec3(), ..self.clone() })
    }
}

impl Carried for Light {
    fn carried(&self, transform: &DMat4) -> Option<Light> {
        let direction = |direction: Vec3| Some(turned(transform, direction)?.as_vec3());
        let edge = |edge: Vec3| transform.transform_vector3(edge.as_dvec3()).as_vec3();
        let scale = transform.x_axis.truncate().length() as f32;
        let length = |length: f32| {
            let length = length * scale;
            (length > 0.0 && length.is_finite()).then_some(length)
        };
        let mut light = self.clone();
        match &mut light.kind {
            LightKind::Point { .. } => {}
            LightKind::Directional { direction: way, .. } => *way = direction(*way)?,
            LightKind::Spot { direction: way, radius, .. } => {
                *way = direction(*way)?;
                *radius = usable_radius(*radius * scale);
            }
            LightKind::Sphere { radius, .. } => *radius = length(*radius)?,
            LightKind::Disk { normal, radius, .. } => {
                (*normal, *radius) = (direction(*normal)?, length(*radius)?);
            }
            LightKind::Rectangle { half_u, half_v, .. } => {
                (*half_u, *half_v) = (edge(*half_u), edge(*half_v));
                let area = half_u.cross(*half_v).length();
                (area > 0.0 && area.is_finite()).then_some(())?;
            }
        }
        if let Some(normal) = self.surface {
            // That of the shape exactly, on the side where it was.
            let (side, light_side) = (direction(normal)?, light.clone().with_one_sided(true).surface);
            light.surface = light_side.map(|own| if own.dot(side) < 0.0 { -own } else { own });
        }
        Some(light)
    }
}

/// A direction under a transform; unit length.
fn turned(transform: &DMat4, direction: Vec3) -> Option<DVec3> {
    unit(transform.transform_vector3(direction.as_dvec3()))
}
