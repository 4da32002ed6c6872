//! Cameras, punctual lights and what belongs to the scene as a whole.
//!
//! Cameras and lights look along −Z of their node, with +Y up. A node's scale does not change them.

use glam::{DMat4, DVec3, Vec3};
use gltf::{Node, khr_lights_punctual as punctual};

use super::{
    Loader,
    container::malformed,
    exact::View,
    extras::{self, CameraExtras, LightExtras, SceneExtras, ShapeExtras},
};
use crate::{
    Camera, Falloff, Fov, Light, LightKind, LightMeshDefaults, LoadError, Projection, Weight,
    draft::Draft,
    formats::toml::{unit, upright},
};

impl Loader<'_> {
    /// Adds the node's camera and light; of a mesh file that is part of a scene they are only counted.
    pub(super) fn read_views(&mut self, node: &Node, transform: &DMat4, draft: &mut Draft) -> Result<(), LoadError> {
        if self.placement.part {
            self.left_out.cameras += usize::from(node.camera().is_some());
            self.left_out.lights += usize::from(node.light().is_some());
            return Ok(());
        }
        if let Some(camera) = node.camera() {
            let camera = self.camera(node, &camera, transform)?;
            draft.cameras.push((camera, transform.w_axis.truncate()));
        }
        if let Some(light) = node.light() {
            let light = self.light(node, &light, transform)?;
            draft.lights.push((light, transform.w_axis.truncate()));
        }
        Ok(())
    }

    /// Ambient term, background and the like, from our own extras.
    pub(super) fn read_scene_extras(&self, draft: &mut Draft) -> Result<(), LoadError> {
        let Some(scene) = self.scene() else { return Ok(()) };
        let extras = self.exact.scene_extras(scene.index());
        let Some(own) = extras::read::<SceneExtras>(self.path, "the scene", extras)? else { return Ok(()) };
        if let Some(origin) = own.origin {
            draft.prefer_origin(origin.into());
        }
        draft.ambient = own.ambient.map(Vec3::from);
        draft.background = own.background.map(Vec3::from);
        let weight = match own.weight.as_deref() {
            None => None,
            Some(name) => Some(Weight::from_name(name).ok_or_else(|| {
                malformed(self.path, format!("extras.lightmesh of the scene has the unknown weight `{name}`"))
            })?),
        };
        draft.light_mesh = LightMeshDefaults { step: own.step, radius: own.radius, weight };
        Ok(())
    }

    fn camera(&self, node: &Node, camera: &gltf::Camera, transform: &DMat4) -> Result<Camera, LoadError> {
        let index = camera.index();
        let direction = self.axis(node, -transform.z_axis.truncate())?;
        let up = upright(direction, self.axis(node, transform.y_axis.truncate())?).ok_or_else(|| self.flat(node))?;
        let bad = |what: &str, value: f64| malformed(self.path, format!("camera {index} has {what} = {value}"));
        let projection = match self.exact.camera(index) {
            Some(View::Yfov(yfov)) if yfov > 0.0 && yfov < std::f64::consts::PI => {
                let extras = self.exact.camera_extras(index);
                let own = extras::read::<CameraExtras>(self.path, &format!("camera {index}"), extras)?;
                Projection::Perspective(match own {
                    Some(own) if own.hfov > 0.0 && own.hfov < 180.0 => Fov::Horizontal(own.hfov),
                    Some(own) => return Err(bad("extras.lightmesh.hfov", own.hfov.into())),
                    None => Fov::Vertical(yfov.to_degrees() as f32),
                })
            }
            Some(View::Ymag(ymag)) if ymag != 0.0 && ymag.is_finite() => {
                Projection::Orthographic { height: (2.0 * ymag.abs()) as f32 }
            }
            Some(View::Yfov(yfov)) => return Err(bad("yfov", yfov)),
            Some(View::Ymag(ymag)) => return Err(bad("ymag", ymag)),
            None => return Err(malformed(self.path, format!("camera {index} says neither yfov nor ymag"))),
        };
        Ok(Camera {
            name: camera.name().or(node.name()).unwrap_or_default().to_owned(),
            position: Vec3::ZERO,
            direction: direction.as_vec3(),
            up: up.as_vec3(),
            projection,
        })
    }

    fn light(&self, node: &Node, light: &punctual::Light, transform: &DMat4) -> Result<Light, LoadError> {
        let index = light.index();
        let exact =
            self.exact.light(index).ok_or_else(|| malformed(self.path, format!("there is no light {index}")))?;
        let intensity = exact.strength().as_vec3();
        if !(intensity.is_finite() && intensity.cmpge(Vec3::ZERO).all()) {
            return Err(malformed(self.path, format!("light {index} has the intensity {intensity}")));
        }
        let own: LightExtras = extras::read(self.path, &format!("light {index}"), exact.extras())?.unwrap_or_default();
        let position = Vec3::ZERO;
        let kind = match (exact.kind.as_str(), &own.shape) {
            (_, Some(shape)) => shaped(shape, transform)
                .ok_or_else(|| malformed(self.path, format!("extras.lightmesh of light {index} give it no size")))?,
            ("directional", None) => {
                LightKind::Directional { direction: self.axis(node, -transform.z_axis.truncate())?.as_vec3() }
            }
            ("spot", None) => {
                let (inner, outer) = exact.cone();
                // As `f32`, where a right angle is a little more than in `f64`.
                let (inner, outer) = (inner as f32, outer as f32);
                if !(0.0 <= inner && inner <= outer && outer <= std::f32::consts::FRAC_PI_2) {
                    return Err(malformed(
                        self.path,
                        format!("light {index} has a cone from {inner} to {outer} radians"),
                    ));
                }
                let direction = self.axis(node, -transform.z_axis.truncate())?.as_vec3();
                LightKind::Spot { position, direction, inner, outer }
            }
            _ => LightKind::Point { position, spread: own.spread.unwrap_or(0.0).max(0.0) },
        };
        Ok(Light {
            name: light.name().or(node.name()).unwrap_or_default().to_owned(),
            kind,
            intensity,
            falloff: if own.no_falloff { Falloff::None } else { Falloff::InverseSquare },
        })
    }

    fn axis(&self, node: &Node, axis: DVec3) -> Result<DVec3, LoadError> {
        unit(axis).ok_or_else(|| self.flat(node))
    }

    fn flat(&self, node: &Node) -> LoadError {
        malformed(self.path, format!("node {} has a camera or light but no orientation (a scale of 0)", node.index()))
    }
}

/// A light with a size, whose extras are in the node's coordinates. Its node may turn it and scale it evenly. `None` where
/// nothing is left of it.
fn shaped(shape: &ShapeExtras, transform: &DMat4) -> Option<LightKind> {
    let vector = |v: [f32; 3]| transform.transform_vector3(Vec3::from(v).as_dvec3());
    let scaled = |radius: f32| {
        let radius = radius * transform.x_axis.truncate().length() as f32;
        (radius > 0.0 && radius.is_finite()).then_some(radius)
    };
    let position = Vec3::ZERO;
    Some(match *shape {
        ShapeExtras::Sphere { radius } => LightKind::Sphere { position, radius: scaled(radius)? },
        ShapeExtras::Disk { normal, radius } => {
            LightKind::Disk { position, normal: unit(vector(normal))?.as_vec3(), radius: scaled(radius)? }
        }
        ShapeExtras::Rectangle { half_u, half_v } => {
            let (half_u, half_v) = (vector(half_u).as_vec3(), vector(half_v).as_vec3());
            let area = half_u.cross(half_v).length();
            (area > 0.0 && area.is_finite()).then_some(LightKind::Rectangle { position, half_u, half_v })?
        }
    })
}
