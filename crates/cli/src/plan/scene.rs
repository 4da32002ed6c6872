//! What the command line changes about a scene, and what is added to one that lacks it.

use glam::DVec3;
use lightmesh::scene::{Camera, Fov, Light, LightKind, Projection, UnknownCamera, Up};
use lightmesh::{Observer, Scene};

use crate::args::RenderArgs;
use crate::value::{CameraView, Color, LightSpec};

/// Camera, lights and ambient term as typed.
pub(crate) struct SceneChoices {
    camera: Option<CameraView>,
    camera_name: Option<String>,
    up: Up,
    lights: Vec<LightSpec>,
    falloff: lightmesh::scene::Falloff,
    ambient: Option<Color>,
}

impl SceneChoices {
    pub(super) fn new(args: &RenderArgs) -> SceneChoices {
        SceneChoices {
            camera: args.camera,
            camera_name: args.camera_name.clone(),
            up: args.up.of(&args.scene.scene),
            lights: args.lights.clone(),
            falloff: args.falloff.into(),
            ambient: args.ambient,
        }
    }

    /// Puts lights and ambient term into the scene and gives the camera to take; says what had to be made up.
    pub(crate) fn apply(&self, scene: &mut Scene, observer: &dyn Observer) -> Result<Camera, UnknownCamera> {
        let camera = self.camera(scene, observer)?;
        if !self.lights.is_empty() {
            scene.lights = self.lights.iter().map(|light| self.light(scene, light)).collect();
        } else if scene.lights.is_empty() {
            observer.note(
                "the scene has no light: taking a key light above the camera and a weaker fill light on its other side (--light \
                 places others)",
            );
            scene.lights.extend(scene.default_lights(&camera));
        }
        if let Some(Color(ambient)) = self.ambient {
            scene.ambient = Some(ambient);
        }
        Ok(camera)
    }

    fn camera(&self, scene: &Scene, observer: &dyn Observer) -> Result<Camera, UnknownCamera> {
        if let Some(name) = &self.camera_name {
            return scene.camera(name).cloned();
        }
        if let Some(view) = &self.camera {
            return Ok(placed(scene, view, self.up));
        }
        Ok(scene.cameras.first().cloned().unwrap_or_else(|| {
            let up = self.up.name();
            observer.note(&format!(
                "the scene has no camera: taking one that frames it from the front, with {up} up (--camera and --up set another)"
            ));
            scene.default_camera(self.up)
        }))
    }

    fn light(&self, scene: &Scene, light: &LightSpec) -> Light {
        let position = scene.to_local(light.position);
        let kind = match light.radius {
            0.0 => LightKind::Point { position, spread: 0.0 },
            radius => LightKind::Sphere { position, radius },
        };
        Light { name: String::new(), kind, intensity: light.intensity, falloff: self.falloff }
    }
}

/// A camera of the command line in the scene's local frame.
fn placed(scene: &Scene, view: &CameraView, up: Up) -> Camera {
    Camera {
        name: String::new(),
        position: scene.to_local(view.position),
        direction: view.direction.as_vec3(),
        up: upper_side(view.direction, up).as_vec3(),
        projection: Projection::Perspective(Fov::Vertical(view.vfov)),
    }
}

/// The direction of the picture's upper edge: `up` at a right angle to the view. A view straight up or down shows the scene
/// as a plan, its back at the top.
fn upper_side(direction: DVec3, up: Up) -> DVec3 {
    let plan = match up {
        Up::Y => DVec3::NEG_Z,
        Up::Z => DVec3::Y,
    };
    let upright = |up: DVec3| {
        let side = direction.cross(up);
        (side.length() > 1e-6).then(|| side.cross(direction).normalize())
    };
    upright(up.axis().as_dvec3()).or_else(|| upright(plan)).unwrap_or(plan)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_side_is_up_or_the_back_of_a_plan() {
        assert_eq!(upper_side(DVec3::NEG_Z, Up::Y), DVec3::Y);
        assert_eq!(upper_side(DVec3::NEG_Y, Up::Y), DVec3::NEG_Z);
        assert_eq!(upper_side(DVec3::NEG_Z, Up::Z), DVec3::Y);
        let slanted = upper_side(DVec3::new(0.0, -1.0, -1.0).normalize(), Up::Y);
        assert!((slanted - DVec3::new(0.0, 1.0, -1.0).normalize()).length() < 1e-12);
    }
}
