//! Scene overrides from the command line, and defaults for what a scene lacks.

use std::path::Path;

use glam::{DVec3, Vec3};
use lightmesh::scene::{
    Camera, CameraError, Environment, EnvironmentError, Light, LightKind, Lighting, Lights, SceneFormat, SkyError,
    Surroundings, UnknownCamera, Up, Viewpoint,
};
use lightmesh::{Observer, Scene};
use lightmesh_memory::Budget;

use super::SunStudy;
use crate::args::{self, ImageArgs};
use crate::value::{Background, Color, EnvironmentSpec, LightSpec, SkySpec};

/// Invalid scene options.
#[derive(Debug, thiserror::Error)]
pub enum ChoiceError {
    /// There is no camera of this name.
    #[error(transparent)]
    Camera(#[from] UnknownCamera),
    /// Invalid sky.
    #[error("--sky: {0}")]
    Sky(#[from] SkyError),
    /// The panorama cannot be used.
    #[error("--environment: {0}")]
    Environment(#[from] EnvironmentError),
    /// A studio is asked for where there is light.
    #[error("--studio: the scene has {what}, which a studio would replace; leave the flag out to render it as it is")]
    Studio {
        /// What stands against it.
        what: &'static str,
    },
}

/// What a scene shows that was changed as the flags say.
pub(crate) struct Applied {
    /// What the image is to show behind a ground, if no background is set.
    pub(crate) behind: Option<f32>,
    /// The axis across the ground, if one was added.
    pub(crate) ground: Option<Up>,
    /// Whether it shows a model under a sky, with horizon and haze.
    pub(crate) outdoors: bool,
    /// Whether it shows an interior under a sky.
    pub(crate) indoors: bool,
}

/// Camera, lights, surroundings, ambient term and background as typed.
pub(crate) struct SceneChoices {
    /// At the local frame's origin, together with its world position.
    camera: Option<(Camera, DVec3)>,
    camera_name: Option<String>,
    up: Up,
    /// Whether the scene may know better: by its geometry, if neither a flag nor its format says what is up.
    asks_scene: bool,
    lights: Vec<LightSpec>,
    falloff: lightmesh::scene::Falloff,
    ambient: Option<Color>,
    background: Option<Background>,
    sky: Option<SkySpec>,
    environment: Option<EnvironmentSpec>,
    ground: bool,
    /// Whether the sky may bring a ground and haze to a model, and whether it does.
    may_be_outdoors: bool,
    outdoors: bool,
    lighting: Lighting,
    /// Width of the image, relative to its height.
    aspect: f32,
    budget: Budget,
}

/// What an image shows as the background of a scene with a ground if none is set: shadows on black would not be seen.
const GROUND_BACKGROUND: f32 = 0.8;

impl SceneChoices {
    /// For a scene in this format.
    pub(crate) fn new(
        args: &ImageArgs,
        format: Option<SceneFormat>,
        memory_limit: Option<u64>,
    ) -> Result<SceneChoices, CameraError> {
        let up = args.up.of(format);
        let is_open = |format| matches!(format, SceneFormat::Obj | SceneFormat::Ply | SceneFormat::Stl);
        let camera = args.camera.map(|view| {
            let camera = Camera::look_to(Vec3::ZERO, view.direction, up.axis(), view.vfov);
            camera.map(|camera| (camera, view.position))
        });
        Ok(SceneChoices {
            camera: camera.transpose()?,
            camera_name: args.camera_name.clone(),
            up,
            asks_scene: matches!(args.up, args::Up::Auto) && format.is_some_and(is_open),
            lights: args.lights.clone(),
            falloff: args.falloff,
            ambient: args.ambient,
            background: args.background,
            sky: args.sky,
            environment: args.environment.clone(),
            ground: args.ground,
            may_be_outdoors: args.sky.is_some() && lighting(args) == Lighting::Studio && format.is_some_and(is_model),
            outdoors: false,
            lighting: lighting(args),
            aspect: args.size.0[0] as f32 / args.size.0[1] as f32,
            budget: Budget::new(memory_limit),
        })
    }

    /// With the sky of a study's first moment.
    pub(super) fn under_sun(self, sun: Option<&SunStudy>) -> SceneChoices {
        SceneChoices { sky: sun.map(|sun| sun.sky_at(0)).or(self.sky), ..self }
    }

    /// For a picture to look at, not for numbers or a study: a model is shown outdoors under a sky.
    pub(crate) fn of_picture(self, is_picture: bool) -> SceneChoices {
        SceneChoices { outdoors: is_picture && self.may_be_outdoors, ..self }
    }

    /// Applies camera, lights, surroundings, ambient term and background to the scene; reports which defaults had to be added. Returns what
    /// became of a ground.
    pub(crate) fn apply(&self, scene: &mut Scene, observer: &dyn Observer) -> Result<Applied, ChoiceError> {
        if let Some(camera) = self.camera(scene)? {
            scene.cameras = vec![camera];
        }
        if !self.lights.is_empty() {
            scene.lights.list = self.lights.iter().map(|light| self.light(scene, light)).collect();
        }
        let (up, why) = self.up(scene);
        if let Some((surroundings, alone)) = self.surroundings(up)? {
            if alone {
                scene.lights.list.clear();
            }
            scene.lights.surround(surroundings);
        }
        if let Some(Color(ambient)) = self.ambient {
            scene.lights.ambient = Some(ambient);
        }
        if let Some(Background::Color(Color(background))) = self.background {
            scene.lights.background = Some(background);
        }
        if let (Lighting::StudioAnywhere, Some(what)) = (self.lighting, scene.beside_studio()) {
            return Err(ChoiceError::Studio { what });
        }
        let added = match self.outdoors {
            true => scene.complete_outdoors(up, self.aspect),
            false => scene.complete_with(self.lighting, up, self.aspect),
        };
        if added.camera {
            let from = match added.viewpoint {
                Viewpoint::OpenSide => "looks into it through its open side",
                Viewpoint::Inside => "stands inside, since the outside shows little but walls",
                _ => "frames it from the front",
            };
            observer.note(&format!(
                "the scene has no camera: using one that {from}, with {} up{why} (--camera and --up override it)",
                up.name()
            ));
        }
        if added.lights {
            observer.note(if added.lamp {
                "the scene has no lights: using a lamp below the ceiling, whose light its surfaces reflect \
                 (--light, --sky or --environment replace it, --no-studio leaves a key and a fill light)"
            } else if added.studio {
                "the scene has no lights: using a studio, a large key light at the upper left of the camera, soft surroundings and a ground \
                 (--light, --sky or --environment replace it, --no-studio leaves a key and a fill light)"
            } else if added.lights_inside {
                "the scene has no lights, and lights outside would not reach the visible surfaces: using a key light ahead of the \
                 camera, a weaker fill light above it and more ambient light (--light replaces the lights, --ambient the ambient light)"
            } else {
                "the scene has no lights: using a key light above the camera and a weaker fill light on the other side \
                 (--light replaces them)"
            });
        }
        // Cameras and lights that were added look at the scene alone.
        if added.studio {
            // Its background is what is shown, not a radiance.
            return Ok(Applied {
                behind: scene.lights.background.take().map(|background| background.x),
                ground: Some(up),
                outdoors: false,
                indoors: false,
            });
        }
        if added.outdoors {
            observer.note(
                "the model stands on a ground that catches its shadows and fades into the sky (--no-studio omits it)",
            );
            return Ok(Applied { behind: None, ground: Some(up), outdoors: true, indoors: false });
        }
        if self.ground {
            scene.add_ground(up);
        }
        let lights = &scene.lights;
        let is_open = self.background.is_none() && lights.background.is_none() && lights.environment.is_none();
        let behind = (self.ground && is_open).then_some(GROUND_BACKGROUND);
        Ok(Applied { behind, ground: self.ground.then_some(up), outdoors: false, indoors: added.indoors })
    }

    /// What is up, and why it is not what is usual.
    pub(crate) fn up(&self, scene: &Scene) -> (Up, String) {
        let suggested = || {
            let info = scene.suggested_up()?;
            let up: Up = info.axis.parse().ok()?;
            (up != self.up).then(|| (up, format!(", since {}", info.reason)))
        };
        let asks = self.asks_scene && scene.cameras.is_empty();
        asks.then(suggested).flatten().unwrap_or((self.up, String::new()))
    }

    /// The sky or the panorama, and whether it is the only light.
    fn surroundings(&self, up: Up) -> Result<Option<(Surroundings, bool)>, ChoiceError> {
        if let Some(spec) = &self.environment {
            let panorama = Environment::open(&spec.file, up, self.budget)?;
            return Ok(Some((panorama.turned(spec.rotation).scaled(spec.strength).into(), spec.alone)));
        }
        let Some(spec) = &self.sky else { return Ok(None) };
        Ok(Some((spec.sky.surroundings(up)?, spec.alone)))
    }

    /// The scene's lights under another sky than the one that was [applied](SceneChoices::apply). What is behind a ground stays.
    pub(crate) fn under(&self, sky: &SkySpec, lights: &Lights) -> Result<Lights, ChoiceError> {
        let mut lights = lights.clone();
        let background = lights.background;
        lights.surround(sky.sky.surroundings(self.up_of(&lights))?);
        lights.background = background;
        if let Some(Color(ambient)) = self.ambient {
            lights.ambient = Some(ambient);
        }
        Ok(lights)
    }

    /// What is up for the surroundings of lights.
    pub(crate) fn up_of(&self, lights: &Lights) -> Up {
        lights.environment.as_ref().map_or(self.up, |environment| match environment.frame()[1] {
            up if up.y > up.z => Up::Y,
            _ => Up::Z,
        })
    }

    /// A file that is read besides the scene.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.environment.as_ref().map(|spec| &*spec.file)
    }

    /// The requested camera.
    fn camera(&self, scene: &Scene) -> Result<Option<Camera>, UnknownCamera> {
        if let Some(name) = &self.camera_name {
            return scene.camera(name).cloned().map(Some);
        }
        Ok(self.camera.clone().map(|(mut camera, world)| {
            camera.position = scene.to_local(world);
            camera
        }))
    }

    fn light(&self, scene: &Scene, light: &LightSpec) -> Light {
        let position = scene.to_local(light.position);
        let kind = match light.radius {
            0.0 => LightKind::Point { position, spread: 0.0 },
            radius => LightKind::Sphere { position, radius },
        };
        Light::new(kind).with_intensity(light.intensity).with_falloff(self.falloff)
    }
}

/// Whether files of a format hold models, not scenes of this program.
fn is_model(format: SceneFormat) -> bool {
    format != SceneFormat::Toml
}

/// What lights a scene that brings no light.
fn lighting(args: &ImageArgs) -> Lighting {
    match args {
        ImageArgs { studio: true, .. } => Lighting::StudioAnywhere,
        // A studio has a background of its own, which would not be seen where nothing is to be, and a ground, of which a saved grid knows
        // nothing.
        ImageArgs { no_studio: true, .. }
        | ImageArgs { background: Some(_), .. }
        | ImageArgs { grid_file: Some(_), .. } => Lighting::KeyAndFill,
        _ => Lighting::Studio,
    }
}
