//! What all built-in scenes have in common.

use glam::{Vec2, Vec3};

use super::parts::Palette;
use crate::{Camera, Fov, Geometry, Light, Lights, Mesh, Projection, Scene};

/// Settings common to all scenes.
pub(super) struct Composition {
    pub(super) name: &'static str,
    pub(super) mesh: Mesh,
    pub(super) palette: Palette,
    pub(super) lights: Vec<Light>,
    pub(super) eye: Vec3,
    pub(super) target: Vec3,
    pub(super) vfov: f32,
    pub(super) ambient: Vec3,
    pub(super) sky: Vec3,
}

impl Composition {
    pub(super) fn finish(self) -> Scene {
        let camera = Camera {
            name: "main".into(),
            position: self.eye,
            direction: (self.target - self.eye).normalize(),
            up: Vec3::Y,
            projection: Projection::Perspective(Fov::Vertical(self.vfov)),
            shift: Vec2::ZERO,
            near: 0.0,
            far: f32::INFINITY,
            motion: None,
        };
        let geometry = Geometry { mesh: self.mesh, materials: self.palette.0, ..Geometry::default() };
        let lights =
            Lights { list: self.lights, ambient: Some(self.ambient), background: Some(self.sky), ..Lights::default() };
        Scene { lights, cameras: vec![camera], ..Scene::new(self.name, geometry) }
    }
}
