//! From a scene and settings to a frame.

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use lightmesh_image::SaveError;
use lightmesh_scene::{Camera, Projection, Scene, Weight};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::backend::{Backend, Cpu, Cuda};
use crate::cuda::Driver;
use crate::device::{Choice, Chosen};
use crate::job::{Job, Sampling};
use crate::light_mesh::{Lattice, LightMesh, Template, auto_step};
use crate::modes::{self, Plan, Technique};
use crate::prepared::PreparedScene;
use crate::settings::{Mode, Settings, ShortTests, Step};
use crate::stages::shade::DEFAULT_AMBIENT;
use crate::stats::{
    CameraStats, Counts, DeviceStats, LatticeStats, MemoryStats, SceneStats, Seconds, SettingsStats, Stats,
};
use crate::view::View;
use crate::{Device, Observer, Picture, RenderError, Unobserved};

/// More threads than any machine has processors only wait for each other.
const MAX_THREADS: usize = 1024;

/// A finished picture and what is to be said about it.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Linear colours, and layers where they were asked for.
    pub image: lightmesh_image::Frame,
    /// Counts, seconds and settings.
    pub stats: Stats,
}

impl Frame {
    /// Writes the picture as bmp, png, exr or jpg, by the extension; 8-bit formats in sRGB.
    ///
    /// # Errors
    /// [`SaveError`] where the extension is unknown or the file cannot be written; no file is left half-written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.image.save(path)
    }
}

/// Renders scenes on one device.
pub struct Renderer {
    pool: ThreadPool,
    engine: Engine,
}

/// What computes.
enum Engine {
    Cpu,
    /// Pictures take turns: a device has one template in constant memory, and one set of counters.
    Cuda(Box<Mutex<Cuda<Driver>>>),
}

impl Renderer {
    /// A renderer on `device` with a thread for each processor.
    ///
    /// # Errors
    /// [`RenderError::Device`] where the device cannot be used.
    pub fn new(device: Device) -> Result<Renderer, RenderError> {
        Renderer::with_threads(device, None)
    }

    /// A renderer on `device` with a number of threads of its own.
    ///
    /// # Errors
    /// [`RenderError::Device`] where the device cannot be used, [`RenderError::Setting`] where the number of threads has no sense,
    /// [`RenderError::Threads`] where the threads cannot be started.
    pub fn with_threads(device: Device, threads: Option<usize>) -> Result<Renderer, RenderError> {
        check_threads(threads)?;
        Renderer::on(Choice::of(device)?, threads)
    }

    /// A renderer on a device that was made ready, with a number of threads of its own; `None`: one for each processor.
    ///
    /// # Errors
    /// [`RenderError::Setting`] where the number of threads has no sense, [`RenderError::Threads`] where the threads cannot be
    /// started.
    pub fn on(choice: Choice, threads: Option<usize>) -> Result<Renderer, RenderError> {
        check_threads(threads)?;
        let threads = threads.unwrap_or(0);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| RenderError::Threads { threads, reason: error.to_string() })?;
        let engine = match choice.chosen {
            Chosen::Cpu => Engine::Cpu,
            Chosen::Cuda(driver) => Engine::Cuda(Box::new(Mutex::new(Cuda::new(driver)))),
        };
        Ok(Renderer { pool, engine })
    }

    /// Renders one picture of `scene`.
    ///
    /// # Errors
    /// [`RenderError`] where the settings have no sense for this scene, or memory does not suffice.
    pub fn render(&self, scene: &Scene, settings: &Settings) -> Result<Frame, RenderError> {
        let prepared = self.prepare(scene, settings, &Unobserved)?;
        self.render_prepared(&prepared, settings, &Unobserved)
    }

    /// Builds the acceleration structure, for any number of pictures.
    ///
    /// # Errors
    /// [`RenderError::Grid`] or [`RenderError::GridFile`] where a grid was asked for and cannot be had.
    pub fn prepare<'s>(
        &self,
        scene: &'s Scene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<PreparedScene<'s>, RenderError> {
        self.pool.install(|| PreparedScene::new(scene, &settings.acceleration, observer))
    }

    /// Renders one picture of a prepared scene.
    ///
    /// # Errors
    /// As [`Renderer::render`], and [`RenderError::Cancelled`] where the observer asked to stop.
    pub fn render_prepared(
        &self,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.pool.install(|| match &self.engine {
            Engine::Cpu => render_on(&Cpu, scene, settings, observer),
            Engine::Cuda(cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                render_on(&*cuda, scene, settings, observer)
            }
        })
    }
}

/// Renders one picture of a prepared scene on a backend of the caller's own, on the caller's threads.
///
/// # Errors
/// As [`Renderer::render_prepared`].
pub fn render_on<B: Backend>(
    backend: &B,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    check(settings)?;
    let start = Instant::now();
    let camera = camera(scene.scene, settings);
    let view = View::new(&camera, settings.size);
    let technique = technique(scene, settings, &view, observer)?;
    let lights = scene.scene.lights.len();

    let pixels = u64::from(settings.size[0]) * u64::from(settings.size[1]);
    let plan = Plan {
        technique,
        size: settings.size,
        bounces: settings.bounces,
        layers: settings.layers.then_some(lights),
        memory_limit: settings.memory_limit,
    };
    let sampling = Sampling { samples: settings.samples(), seed: settings.seed, spread: settings.mode == Mode::Area };
    let job = Job::new(observer, sampling).with_short_tests(settings.short_tests);
    let mut picture = Picture::new(settings.size, plan.layers);
    backend.upload(&job, scene, &plan)?;
    let rows = modes::render(backend, &job, scene, &view, &plan, &mut picture)?;

    let mesh = match &plan.technique {
        Technique::LightMesh(mesh) => Some(mesh),
        _ => None,
    };
    let stats = Stats {
        version: 1,
        scene: SceneStats { name: scene.scene.name.clone(), triangles: scene.triangles.len(), lights },
        device: DeviceStats { kind: backend.kind(), name: backend.name() },
        settings: settings_stats(backend.kind(), scene, settings, &camera, mesh, rows),
        counts: Counts::new(&job, pixels, mesh),
        seconds: Seconds::new(&job, scene.build_seconds, start.elapsed().as_secs_f64()),
        memory: MemoryStats::now(backend.peak_memory()),
    };
    Ok(Frame { image: picture.into_frame(), stats })
}

fn settings_stats(
    device: &'static str,
    scene: &PreparedScene,
    settings: &Settings,
    camera: &Camera,
    mesh: Option<&LightMesh>,
    rows_per_band: u32,
) -> SettingsStats {
    let aspect = settings.size[0] as f32 / settings.size[1] as f32;
    let (vfov, height) = match camera.projection {
        Projection::Perspective(fov) => (Some(fov.vertical(aspect)), None),
        Projection::Orthographic { height } => (None, Some(height)),
    };
    SettingsStats {
        mode: settings.mode.name(),
        bounces: settings.bounces,
        size: settings.size,
        device,
        threads: rayon::current_num_threads(),
        step: mesh.map(|mesh| mesh.lattice.step),
        step_auto: mesh.is_some() && chosen_step(scene.scene, settings) == Step::Auto,
        radius: mesh.map(|mesh| mesh.template.radius()),
        weight: mesh.map(|mesh| mesh.weight.name()),
        lookup: mesh.map(|_| "half-ball"),
        short_tests: mesh.map(|_| match settings.short_tests {
            ShortTests::Cells => "cells",
            ShortTests::Plain => "plain",
        }),
        samples: settings.samples(),
        accel: scene.accelerator.name(),
        camera: CameraStats {
            position: scene.scene.to_world(camera.position).to_array(),
            direction: camera.direction.to_array(),
            up: camera.up.to_array(),
            vfov,
            height,
        },
        ambient: scene.scene.ambient.unwrap_or(DEFAULT_AMBIENT).to_array(),
        background: scene.scene.background.unwrap_or_default().to_array(),
        seed: settings.seed,
        memory_limit: settings.memory_limit,
        rows_per_band,
        lattice: mesh.map(|mesh| LatticeStats::new(scene, &mesh.lattice)),
    }
}

/// A number of threads without sense is refused before any work.
fn check_threads(threads: Option<usize>) -> Result<(), RenderError> {
    match threads {
        Some(threads) if !(1..=MAX_THREADS).contains(&threads) => Err(RenderError::Setting {
            what: "number of threads (--threads)",
            value: threads.to_string(),
            remedy: "choose 1 to 1024; the number of processors is best",
        }),
        _ => Ok(()),
    }
}

/// Settings without sense are refused before any work.
fn check(settings: &Settings) -> Result<(), RenderError> {
    let [width, height] = settings.size;
    // Rays are numbered in 32 bits.
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) >= u64::from(u32::MAX) {
        return Err(RenderError::Setting {
            what: "picture size (--size)",
            value: format!("{width}x{height}"),
            remedy: "both sides must be at least 1, and all pixels fewer than 4294967295",
        });
    }
    if !(1..=u32::from(u16::MAX)).contains(&settings.samples()) {
        return Err(RenderError::Setting {
            what: "number of samples (--samples)",
            value: settings.samples().to_string(),
            remedy: "choose 1 to 65535",
        });
    }
    Ok(())
}

fn camera(scene: &Scene, settings: &Settings) -> Camera {
    let chosen = settings.camera.as_ref().or(scene.cameras.first());
    chosen.cloned().unwrap_or_else(|| scene.default_camera(settings.up))
}

fn chosen_step(scene: &Scene, settings: &Settings) -> Step {
    settings.step.or(scene.light_mesh.step.map(Step::Fixed)).unwrap_or(Step::Auto)
}

/// Resolves what the mode needs; says what was chosen where it was left open.
fn technique(
    scene: &PreparedScene,
    settings: &Settings,
    view: &View,
    observer: &dyn Observer,
) -> Result<Technique, RenderError> {
    match settings.mode {
        Mode::RayTrace => return Ok(Technique::RayTrace),
        Mode::Area => return Ok(Technique::Area),
        Mode::LightMesh => {}
    }
    let defaults = scene.scene.light_mesh;
    let radius = settings.radius.or(defaults.radius).unwrap_or(Settings::DEFAULT_RADIUS);
    let template = Template::new(radius)?;
    let step = match chosen_step(scene.scene, settings) {
        Step::Fixed(step) => step,
        Step::Auto => {
            let step = auto_step(scene, view, radius);
            observer.note(&format!("light-mesh step h = {step} chosen for this picture (--step sets another)"));
            step
        }
    };
    let lattice = Lattice::around(&scene.bounds, step, radius)?;
    let weight = settings.weight.or(defaults.weight).unwrap_or(Weight::Smooth);
    Ok(Technique::LightMesh(LightMesh { lattice, template, radius: radius * step, weight }))
}
