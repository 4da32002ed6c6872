//! Staging: what a request changes in a scene, and what it adds where the scene lacks it: camera, lights, surroundings, a ground.

use std::path::Path;

use glam::{DVec3, Vec3};
use lightmesh_memory::Budget;
use lightmesh_scene::{
    Added, Camera, CameraError, Environment, Light, LightKind, Lighting, Lights, Scene, SceneFormat, Surroundings,
    UnknownCamera, Up, Viewpoint,
};

use crate::error::StageError;
use crate::host::Host;
use crate::request::Request;
use crate::sun::SunStudy;
use crate::value::{Background, Color, EnvironmentSpec, LightSpec, SkySpec, UpChoice};
use crate::words::Words;

/// What a scene shows that was changed as the flags say.
pub(crate) struct Staged {
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
pub(crate) struct Staging {
    /// At the local frame's origin, together with its world position.
    camera: Option<(Camera, DVec3)>,
    camera_name: Option<String>,
    up: Up,
    /// Whether the scene may know better: by its geometry, if neither a flag nor its format says what is up.
    asks_scene: bool,
    lights: Vec<LightSpec>,
    falloff: lightmesh_scene::Falloff,
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

impl Staging {
    /// For a scene in this format.
    pub(crate) fn new(request: &Request, format: Option<SceneFormat>) -> Result<Staging, CameraError> {
        let up = request.up.of(format);
        let is_open = |format| matches!(format, SceneFormat::Obj | SceneFormat::Ply | SceneFormat::Stl);
        let camera = request.camera.map(|view| {
            let camera = Camera::look_to(Vec3::ZERO, view.direction(), up.axis(), view.vfov);
            camera.map(|camera| (camera, view.position))
        });
        let lighting = lighting(request);
        Ok(Staging {
            camera: camera.transpose()?,
            camera_name: request.camera_name.clone(),
            up,
            asks_scene: request.up == UpChoice::Auto && format.is_some_and(is_open),
            lights: request.light.clone(),
            falloff: request.falloff,
            ambient: request.ambient,
            background: request.background,
            sky: request.sky,
            environment: request.environment.clone(),
            ground: request.ground,
            may_be_outdoors: request.sky.is_some() && lighting == Lighting::Studio && format.is_some_and(is_model),
            outdoors: false,
            lighting,
            aspect: request.size.0[0] as f32 / request.size.0[1] as f32,
            budget: Budget::new(request.memory_limit.map(|limit| limit.0)),
        })
    }

    /// With the sky of a study's first moment.
    pub(crate) fn under_sun(self, sun: Option<&SunStudy>) -> Staging {
        Staging { sky: sun.map(|sun| sun.sky_at(0)).or(self.sky), ..self }
    }

    /// For a picture to look at, not for numbers or a study: a model is shown outdoors under a sky.
    pub(crate) fn of_picture(self, is_picture: bool) -> Staging {
        Staging { outdoors: is_picture && self.may_be_outdoors, ..self }
    }

    /// Applies camera, lights, surroundings, ambient term and background to the scene; reports which defaults had to be added. Returns what
    /// became of a ground.
    pub(crate) fn apply(&self, scene: &mut Scene, host: &dyn Host) -> Result<Staged, StageError> {
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
            return Err(StageError::Studio { what });
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
            host.note(&format!(
                "the scene has no camera: using one that {from}, with {} up{why} ({} and {} override it)",
                up.name(),
                host.words().of("camera"),
                host.words().of("up")
            ));
        }
        if added.lights {
            host.note(&lights_added(&added, host.words()));
        }
        // Cameras and lights that were added look at the scene alone.
        if added.studio {
            // Its background is what is shown, not a radiance.
            return Ok(Staged {
                behind: scene.lights.background.take().map(|background| background.x),
                ground: Some(up),
                outdoors: false,
                indoors: false,
            });
        }
        if added.outdoors {
            let omits = host.words().on("no_studio");
            host.note(&format!(
                "the model stands on a ground that catches its shadows and fades into the sky ({omits} omits it)"
            ));
            return Ok(Staged { behind: None, ground: Some(up), outdoors: true, indoors: false });
        }
        if self.ground {
            scene.add_ground(up);
        }
        let lights = &scene.lights;
        let is_open = self.background.is_none() && lights.background.is_none() && lights.environment.is_none();
        let behind = (self.ground && is_open).then_some(GROUND_BACKGROUND);
        Ok(Staged { behind, ground: self.ground.then_some(up), outdoors: false, indoors: added.indoors })
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
    fn surroundings(&self, up: Up) -> Result<Option<(Surroundings, bool)>, StageError> {
        if let Some(spec) = &self.environment {
            let panorama = Environment::open(&spec.file, up, self.budget)?;
            return Ok(Some((panorama.turned(spec.rotation).scaled(spec.strength).into(), spec.alone)));
        }
        let Some(spec) = &self.sky else { return Ok(None) };
        Ok(Some((spec.sky.surroundings(up)?, spec.alone)))
    }

    /// The scene's lights under another sky than the one that was [applied](Staging::apply). What is behind a ground stays.
    pub(crate) fn under(&self, sky: &SkySpec, lights: &Lights) -> Result<Lights, StageError> {
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

/// Which lights were added, for a note.
fn lights_added(added: &Added, words: Words) -> String {
    let of = |name| words.of(name);
    let surrounded = || {
        let (light, sky, environment, without) = (of("light"), of("sky"), of("environment"), words.on("no_studio"));
        format!("({light}, {sky} or {environment} replace it, {without} leaves a key and a fill light)")
    };
    if added.lamp {
        format!(
            "the scene has no lights: using a lamp below the ceiling, whose light its surfaces reflect {}",
            surrounded()
        )
    } else if added.studio {
        format!(
            "the scene has no lights: using a studio, a large key light at the upper left of the camera, soft surroundings and a \
             ground {}",
            surrounded()
        )
    } else if added.lights_inside {
        format!(
            "the scene has no lights, and lights outside would not reach the visible surfaces: using a key light ahead of the \
             camera, a weaker fill light above it and more ambient light ({} replaces the lights, {} the ambient light)",
            of("light"),
            of("ambient")
        )
    } else {
        format!(
            "the scene has no lights: using a key light above the camera and a weaker fill light on the other side ({} \
             replaces them)",
            of("light")
        )
    }
}

/// Whether files of a format hold models, not scenes of this program.
fn is_model(format: SceneFormat) -> bool {
    format != SceneFormat::Toml
}

/// What lights a scene that brings no light.
fn lighting(request: &Request) -> Lighting {
    match request {
        Request { studio: true, .. } => Lighting::StudioAnywhere,
        // A studio has a background of its own, which would not be seen where nothing is to be, and a ground, of which a saved grid knows
        // nothing.
        Request { no_studio: true, .. } | Request { background: Some(_), .. } | Request { grid_file: Some(_), .. } => {
            Lighting::KeyAndFill
        }
        _ => Lighting::Studio,
    }
}
