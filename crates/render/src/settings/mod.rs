//! The settings that a user can choose, and how "auto" is resolved.

mod acceleration;
mod choices;
mod crop;
mod setting;

use lightmesh_scene::{Camera, Scene, Up, Weight};

pub use acceleration::Acceleration;
pub use choices::{
    AmbientSource, Filter, Glass, Lookup, Mode, Quality, ShadowTests, Sharing, ShortTests, Step, UnknownStep,
};
pub use crop::{Crop, UnknownCrop};
pub use setting::{Setting, SettingSet};

/// All settings of an image, apart from the scene. Fields can be set, or methods chained; more may be added.
///
/// ```
/// use lightmesh_render::{Mode, Settings};
///
/// let settings = Settings::default().with_mode(Mode::Area).with_size([640, 480]).with_samples(16);
/// assert_eq!((settings.size, settings.samples), ([640, 480], Some(16)));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// How visibility is computed.
    pub mode: Mode,
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Width and height of the whole image in pixels.
    pub size: [u32; 2],
    /// The part of the image that is rendered, with the same colours as in the whole; `None`: all of it.
    pub crop: Option<Crop>,
    /// The camera; `None`: the scene's first, else one that frames the scene.
    pub camera: Option<Camera>,
    /// The up axis for a camera that frames the scene.
    pub up: Up,
    /// Light-mesh step; `None`: the scene's, else auto.
    pub step: Option<Step>,
    /// Interpolation radius in steps; `None`: the scene's, else 2.1.
    pub radius: Option<f32>,
    /// Weight of formula (3); `None`: the scene's, else smooth.
    pub weight: Option<Weight>,
    /// How light-mesh mode looks up visibility.
    pub lookup: Lookup,
    /// How good soft shadows and edges are: the numbers of samples, unless `samples` or `aa` is set.
    pub quality: Quality,
    /// What stands for indirect light.
    pub ambient_light: AmbientSource,
    /// Samples of a pixel; `None`: by `quality` with lists and adaptive rays, else 1. A single one goes through its centre.
    pub aa: Option<u32>,
    /// How samples of a pixel are distributed.
    pub filter: Filter,
    /// Whether samples of a pixel that lie on one surface are shaded together.
    pub sharing: Sharing,
    /// How short tests are evaluated.
    pub short_tests: ShortTests,
    /// How area mode tests the samples of a light.
    pub shadow_tests: ShadowTests,
    /// What surfaces do to shadows that let light through.
    pub glass: Glass,
    /// Samples of a light with a size; `None`: by `quality`, 225 in area mode, 4 per light point of a half-ball.
    pub samples: Option<u32>,
    /// The acceleration structure.
    pub acceleration: Acceleration,
    /// Random pattern of sampled lights.
    pub seed: u64,
    /// Whether to keep depth, normals, positions and visibility of every pixel in addition to its colour.
    pub layers: bool,
    /// Whether the background is left out: the image has an alpha, 0 where the camera sees nothing. Mirrors still show the background.
    pub transparent: bool,
    /// Whether a render that the observer cancels yields the rows that are finished by then, in place of an error: the
    /// image is rendered in 32 bands, fewer if these had less than 8 rows. The same bits take a few percent longer.
    pub partial: bool,
    /// Memory limit in bytes: of all that the process holds on the CPU, of the device's own memory on a GPU; `None`: what is free, less a
    /// reserve.
    pub memory_limit: Option<u64>,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            mode: Mode::LightMesh,
            bounces: 0,
            size: [1024, 1024],
            crop: None,
            camera: None,
            up: Up::Y,
            step: None,
            radius: None,
            weight: None,
            lookup: Lookup::Auto,
            quality: Quality::Good,
            ambient_light: AmbientSource::Auto,
            aa: None,
            filter: Filter::BlackmanHarris,
            sharing: Sharing::Unseen,
            short_tests: ShortTests::Cells,
            shadow_tests: ShadowTests::Rows,
            glass: Glass::Tinted,
            samples: None,
            acceleration: Acceleration::Auto,
            seed: 0,
            layers: false,
            transparent: false,
            partial: false,
            memory_limit: None,
        }
    }
}

impl Settings {
    /// Default interpolation radius in steps: with a weight that falls to zero at the rim it beats R = 3.1 with w = 1 at a third of
    /// the short tests.
    pub const DEFAULT_RADIUS: f32 = 2.1;
}

/// Settings in one expression: each method sets the field of its name; see the fields for details.
impl Settings {
    /// How visibility is computed.
    pub fn with_mode(self, mode: Mode) -> Settings {
        Settings { mode, ..self }
    }

    /// Depth of mirror recursion.
    pub fn with_bounces(self, bounces: u32) -> Settings {
        Settings { bounces, ..self }
    }

    /// The depth of mirror reflections in a scene: at least 1 in a [studio](lightmesh_scene::Lighting::Studio) and
    /// [outdoors](lightmesh_scene::Scene::complete_outdoors), where the surroundings are there to be mirrored.
    pub fn bounces_in(&self, scene: &Scene) -> u32 {
        self.bounces.max(u32::from(scene.lights.studio || scene.lights.outdoors))
    }

    /// Width and height in pixels.
    pub fn with_size(self, size: [u32; 2]) -> Settings {
        Settings { size, ..self }
    }

    /// This part of the image alone.
    pub fn with_crop(self, crop: Crop) -> Settings {
        Settings { crop: Some(crop), ..self }
    }

    /// This camera instead of the scene's.
    pub fn with_camera(self, camera: Camera) -> Settings {
        Settings { camera: Some(camera), ..self }
    }

    /// The up axis for a camera that frames the scene.
    pub fn with_up(self, up: Up) -> Settings {
        Settings { up, ..self }
    }

    /// The light-mesh step: a [`Step`], or scene units.
    pub fn with_step(self, step: impl Into<Step>) -> Settings {
        Settings { step: Some(step.into()), ..self }
    }

    /// Interpolation radius in steps.
    pub fn with_radius(self, radius: f32) -> Settings {
        Settings { radius: Some(radius), ..self }
    }

    /// Weight of formula (3).
    pub fn with_weight(self, weight: Weight) -> Settings {
        Settings { weight: Some(weight), ..self }
    }

    /// How light-mesh mode looks up visibility.
    pub fn with_lookup(self, lookup: Lookup) -> Settings {
        Settings { lookup, ..self }
    }

    /// The lookup that light-mesh mode uses: without a chosen one, settings that mean something to one lookup alone select it.
    pub fn resolved_lookup(&self) -> Lookup {
        let of_half_ball = self.step.is_some() || self.radius.is_some() || self.weight.is_some();
        match self.lookup {
            Lookup::Auto if of_half_ball => Lookup::HalfBall,
            Lookup::Auto => Lookup::Lists,
            chosen => chosen,
        }
    }

    /// What stands for indirect light.
    pub fn with_ambient_light(self, ambient_light: AmbientSource) -> Settings {
        Settings { ambient_light, ..self }
    }

    /// How good soft shadows and edges are: the numbers of samples, unless they are set.
    pub fn with_quality(self, quality: Quality) -> Settings {
        Settings { quality, ..self }
    }

    /// Samples of a pixel; a single one goes through its centre.
    pub fn with_aa(self, aa: u32) -> Settings {
        Settings { aa: Some(aa), ..self }
    }

    /// How samples of a pixel are distributed.
    pub fn with_filter(self, filter: Filter) -> Settings {
        Settings { filter, ..self }
    }

    /// Whether samples of a pixel that lie on one surface are shaded together.
    pub fn with_sharing(self, sharing: Sharing) -> Settings {
        Settings { sharing, ..self }
    }

    /// How short tests are evaluated.
    pub fn with_short_tests(self, short_tests: ShortTests) -> Settings {
        Settings { short_tests, ..self }
    }

    /// How area mode tests the samples of a light.
    pub fn with_shadow_tests(self, shadow_tests: ShadowTests) -> Settings {
        Settings { shadow_tests, ..self }
    }

    /// What surfaces do to shadows that let light through.
    pub fn with_glass(self, glass: Glass) -> Settings {
        Settings { glass, ..self }
    }

    /// Shadow rays per area light.
    pub fn with_samples(self, samples: u32) -> Settings {
        Settings { samples: Some(samples), ..self }
    }

    /// The acceleration structure.
    pub fn with_acceleration(self, acceleration: Acceleration) -> Settings {
        Settings { acceleration, ..self }
    }

    /// Random pattern of sampled lights.
    pub fn with_seed(self, seed: u64) -> Settings {
        Settings { seed, ..self }
    }

    /// Whether to keep depth, normals, positions and visibility of every pixel in addition to its colour.
    pub fn with_layers(self, layers: bool) -> Settings {
        Settings { layers, ..self }
    }

    /// Whether the background is left out, and the image has an alpha.
    pub fn with_transparent(self, transparent: bool) -> Settings {
        Settings { transparent, ..self }
    }

    /// Whether a cancelled render yields the rows that are finished.
    pub fn with_partial(self, partial: bool) -> Settings {
        Settings { partial, ..self }
    }

    /// Memory limit in bytes, of the process on the CPU, of the device's own memory on a GPU.
    pub fn with_memory_limit(self, memory_limit: u64) -> Settings {
        Settings { memory_limit: Some(memory_limit), ..self }
    }
}
