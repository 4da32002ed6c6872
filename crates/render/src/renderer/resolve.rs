//! Checks the settings, and chooses what they leave open.

use glam::Vec3;
use lightmesh_layout::constants::AROUND;
use lightmesh_memory::Budget;
use lightmesh_scene::{Bounds, Camera, Material};

use crate::antialiasing::Antialiasing;
use crate::bands;
use crate::data::lights::LightGroups;
use crate::error::RenderError;
use crate::observer::Observer;
use crate::plan::{BytesPerRay, Plan};
use crate::prepared::PreparedScene;
use crate::probes::{GivenPoints, Probes, ROW};
use crate::render_context::{RenderContext, Sampling};
use crate::settings::{AmbientSource, Crop, Setting, Settings, Sharing};
use crate::shading::facets::{directions, mirrored_share};
use crate::stages::irradiance_cache::Gathering;
use crate::techniques::{Technique, VisibilityQuery};
use crate::view::{View, Window};

/// More threads than any machine has logical CPUs would only wait for each other.
const MAX_THREADS: usize = 1024;
/// Threads that are started for each logical CPU at most: more cost memory and time, and divide the work no better.
const THREADS_A_CPU: usize = 4;
/// So many are started on any machine.
const THREADS_ANYWHERE: usize = 16;

/// The largest side of an image: with what lies around it, columns and rows have 31 bits.
const MAX_SIDE: u32 = 2_000_000_000;
/// Samples of a pixel are numbered next to pixels in 64 bits.
const MAX_PIXEL_SAMPLES: u32 = 1 << 16;

/// An image of a scene with all settings resolved.
pub(super) struct Resolved<'a> {
    pub(super) scene: &'a PreparedScene,
    pub(super) settings: &'a Settings,
    pub(super) camera: Camera,
    pub(super) view: View,
    pub(super) technique: Technique,
    pub(super) plan: Plan,
    pub(super) sampling: Sampling,
    /// Pixels, or points given by the caller.
    pub(super) pixels: u64,
    /// Whether it is of an image.
    is_of_image: bool,
}

impl<'a> Resolved<'a> {
    /// Chooses what the settings leave open.
    pub(super) fn new(
        scene: &'a PreparedScene,
        settings: &'a Settings,
        observer: &dyn Observer,
    ) -> Result<Resolved<'a>, RenderError> {
        Resolved::within(scene.geometry.bounds, scene, settings, observer)
    }

    /// The same for points given by the caller, in place of those that the camera sees.
    pub(super) fn at_points(
        points: &GivenPoints<'a>,
        settings: &'a Settings,
        observer: &dyn Observer,
    ) -> Result<Resolved<'a>, RenderError> {
        let mut resolved = Resolved::within(points.bounds, points.scene, settings, observer)?;
        // What is asked for is the visibility of all lights.
        let lights = LightGroups { at_once: usize::MAX, ..resolved.plan.lights };
        let BytesPerRay { host, device } = bytes_per_ray(points.scene, &resolved.technique, lights);
        let bytes_per_ray = BytesPerRay { host: host + Probes::BYTES, device: device + Probes::BYTES };
        resolved.plan = Plan {
            size: [ROW, points.rows()],
            antialiasing: None,
            bounces: 0,
            layers: None,
            compositing: false,
            gathering: None,
            lights,
            most_rows: None,
            bytes_per_ray,
            ..resolved.plan
        };
        resolved.pixels = points.len() as u64;
        resolved.is_of_image = false;
        Ok(resolved)
    }

    /// Chooses what the settings leave open for surface points within `bounds`.
    fn within(
        bounds: Bounds,
        scene: &'a PreparedScene,
        settings: &'a Settings,
        observer: &dyn Observer,
    ) -> Result<Resolved<'a>, RenderError> {
        check(settings)?;
        scene.check(&settings.acceleration)?;
        let camera = camera(scene, settings);
        // What is chosen does not depend on the part of the image.
        let whole = View::new(&camera, settings.size);
        let technique = Technique::resolve(&VisibilityQuery { scene, settings, view: &whole, observer, bounds })?;
        let lights = LightGroups { lights: scene.scene.lights.len(), at_once: technique.lights_at_once() };
        let samples = Technique::samples(settings);
        let bounces = settings.bounces_in(&scene.scene);
        let antialiasing = match Technique::pixel_samples(settings) {
            1 => None,
            number => {
                let all = Antialiasing::new(number, settings.filter, settings.seed, samples);
                let (mirrors, keeps) = (bounces > 0, technique.needs_neighbours());
                Some(Antialiasing { apart: all.apart || settings.sharing == Sharing::Never, mirrors, keeps, ..all })
            }
        };
        let window = window(settings, &technique, antialiasing.as_ref());
        let left = Budget::new(settings.memory_limit).left();
        let plan = Plan {
            size: window.size,
            // With one sample of a pixel, coverage is found from its depth.
            coverage: settings.transparent && antialiasing.is_some(),
            caught: settings.transparent && (scene.catches() || scene.is_transmissive()),
            compositing: settings.layers,
            gathering: match settings.ambient_light.for_scene(&scene.scene) {
                AmbientSource::Mesh => Some(Gathering::new(&whole, &bounds, settings.quality, left)),
                AmbientSource::Rays => Some(Gathering::brute_force(&whole, &bounds, settings.quality, left)),
                AmbientSource::Auto | AmbientSource::Constant => None,
            },
            layers: (settings.layers || settings.transparent && antialiasing.is_none()).then_some(lights.lights),
            directions: most_directions(scene, bounces, antialiasing.as_ref()),
            antialiasing,
            bounces,
            is_transmissive: scene.is_transmissive(),
            glass: settings.glass,
            lights,
            most_rows: settings.partial.then(|| bands::rows_in_parts(window.size[1])),
            memory_limit: settings.memory_limit,
            left,
            kept: 0,
            reserved: 0,
            bytes_per_ray: bytes_per_ray(scene, &technique, lights),
        };
        let sampling = Sampling { samples, seed: settings.seed, spread: technique.spreads_points() };
        let pixels = plan.pixels();
        let view = whole.with_window(window);
        Ok(Resolved { scene, settings, camera, view, technique, plan, sampling, pixels, is_of_image: true })
    }

    /// An error with the settings by which this work takes less memory, if it is of memory.
    pub(super) fn advise(&self, error: RenderError) -> RenderError {
        let Resolved { settings, plan, .. } = self;
        let helps = [
            (Setting::Size, self.is_of_image),
            (Setting::Layers, self.is_of_image && settings.layers),
            (Setting::Aa, plan.antialiasing.is_some()),
            (Setting::Step, settings.has_light_points()),
            (Setting::Radius, settings.has_light_points()),
            (Setting::AmbientLight, plan.gathering.is_some()),
        ];
        error.helped_by(helps.into_iter().filter_map(|(setting, helps)| helps.then_some(setting)).collect())
    }
}

impl Resolved<'_> {
    /// The context for an image or given points.
    pub(super) fn context<'b>(&self, observer: &'b dyn Observer) -> RenderContext<'b> {
        RenderContext::new(observer, self.sampling)
            .with_short_tests(self.settings.short_tests)
            .with_shadow_tests(self.settings.shadow_tests)
            .with_pixel_samples(self.plan.antialiasing.as_ref().map_or(1, |all| all.samples))
    }
}

/// Rejects an invalid number of threads before any work.
pub(super) fn check_threads(threads: Option<usize>) -> Result<(), RenderError> {
    match threads {
        Some(threads) if !(1..=MAX_THREADS).contains(&threads) => Err(RenderError::Setting {
            setting: Setting::Threads,
            value: threads.to_string(),
            remedy: "choose 1 to 1024; the number of logical CPUs is best",
        }),
        _ => Ok(()),
    }
}

/// How many of `threads` threads are worth starting on this machine.
pub(super) fn worthwhile_threads(threads: usize) -> usize {
    let cpus = std::thread::available_parallelism().map_or(1, usize::from);
    threads.min((THREADS_A_CPU * cpus).max(THREADS_ANYWHERE))
}

/// Rejects invalid settings before any work.
fn check(settings: &Settings) -> Result<(), RenderError> {
    let [width, height] = settings.size;
    // Rays are numbered in 32 bits, columns and rows in 31.
    let is_possible = |[width, height]: [u32; 2]| {
        let pixels = u64::from(width) * u64::from(height);
        pixels > 0 && pixels < u64::from(u32::MAX) && width.max(height) <= MAX_SIDE
    };
    if !is_possible([width, height]) {
        return Err(RenderError::Setting {
            setting: Setting::Size,
            value: format!("{width}x{height}"),
            remedy: "both sides must be 1 to 2000000000, and the number of pixels below 4294967295",
        });
    }
    if let Some(crop) = settings.crop.filter(|crop| !(crop.is_near(settings.size) && is_possible(crop.size))) {
        return Err(RenderError::Setting {
            setting: Setting::Crop,
            value: crop.to_string(),
            remedy: "choose 1 to 4294967294 pixels of the image and around it, up to 65536 beyond its edges",
        });
    }
    let samples = Technique::samples(settings);
    if !(1..=u32::from(u16::MAX)).contains(&samples) {
        return Err(RenderError::Setting {
            setting: Setting::Samples,
            value: samples.to_string(),
            remedy: "choose 1 to 65535",
        });
    }
    let pixel_samples = Technique::pixel_samples(settings);
    if !(1..=MAX_PIXEL_SAMPLES).contains(&pixel_samples) {
        return Err(RenderError::Setting {
            setting: Setting::Aa,
            value: pixel_samples.to_string(),
            remedy: "choose 1 to 65536 samples of a pixel",
        });
    }
    Ok(())
}

/// The bytes of a ray for the technique, and for what surfaces that are not opaque leave of the lights.
fn bytes_per_ray(scene: &PreparedScene, technique: &Technique, lights: LightGroups) -> BytesPerRay {
    let held = lights.held() as u64;
    let BytesPerRay { host, device } = technique.bytes_per_ray(held);
    let colors = if scene.is_transmissive() { size_of::<Vec3>() as u64 * held } else { 0 };
    BytesPerRay { host: host + colors, device: device + colors }
}

/// In how many directions mirrors reflect a ray, at most.
fn most_directions(scene: &PreparedScene, bounces: u32, antialiasing: Option<&Antialiasing>) -> u32 {
    let is_rough = |material: &Material| {
        // An image may make it less rough.
        let varies = material.metallic_roughness_texture.is_some();
        material.faceted().is_some_and(|facets| varies || mirrored_share(facets.roughness) > 0.0)
    };
    let any = bounces > 0 && scene.scene.geometry.materials.iter().any(is_rough);
    let weight = 1.0 / antialiasing.map_or(1.0, |all| all.samples as f32);
    if any { directions(weight, 1.0) } else { 1 }
}

/// The pixels that are rendered: those that are asked for, and those around them on which they depend.
fn window(settings: &Settings, technique: &Technique, antialiasing: Option<&Antialiasing>) -> Window {
    let Some(Crop { first, size }) = settings.crop else { return Window::all(settings.size) };
    let neighbours = if technique.needs_neighbours() { AROUND } else { 0 };
    let margin = neighbours + antialiasing.map_or(0, Antialiasing::margin);
    Window { size, first, whole: settings.size }.grown(margin)
}

fn camera(scene: &PreparedScene, settings: &Settings) -> Camera {
    let chosen = settings.camera.as_ref().or(scene.scene.cameras.first());
    chosen.cloned().unwrap_or_else(|| scene.scene.default_camera(settings.up))
}
