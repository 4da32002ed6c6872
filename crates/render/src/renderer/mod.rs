//! The renderer: from a scene and settings to a frame.
//!
//! [`resolve`] checks the settings and chooses what they leave open, [`crate::passes`] puts the stages together, [`report`] says what was
//! done.

mod report;
mod resolve;

use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use lightmesh_image::{FrameParts, Layers, SaveError};
use lightmesh_scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::backend::run::Run;
use crate::backend::{Backend, Cpu, Cuda};
use crate::cache::{Kept, MeshCache};
use crate::cuda::{Driver, Runtime};
use crate::data::picture::Picture;
use crate::device::{Choice, Chosen, Device};
use crate::error::RenderError;
use crate::job::Job;
use crate::observer::{Observer, Unobserved};
use crate::passes::Passes;
use crate::prepared::{Preparations, PreparedScene};
use crate::settings::Settings;
use crate::stats::Stats;
use resolve::Resolved;

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

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.image.width(), self.image.height()]
    }

    /// Linear colours, row-major, row 0 at the top.
    pub fn color(&self) -> &[[f32; 3]] {
        self.image.color()
    }

    /// What each pixel saw, where [`Settings::layers`] asked for it.
    pub fn layers(&self) -> Option<&Layers> {
        self.image.layers()
    }

    /// The picture's vectors; nothing is copied.
    pub fn into_parts(self) -> FrameParts {
        self.image.into_parts()
    }
}

/// Renders scenes on one device.
pub struct Renderer {
    pool: ThreadPool,
    engine: Engine,
    preparations: Preparations,
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
        resolve::check_threads(threads)?;
        Renderer::on(Choice::of(device)?, threads)
    }

    /// A renderer on a device that was made ready, with a number of threads of its own; `None`: one for each processor.
    ///
    /// # Errors
    /// [`RenderError::Setting`] where the number of threads has no sense, [`RenderError::Threads`] where the threads cannot be
    /// started.
    pub fn on(choice: Choice, threads: Option<usize>) -> Result<Renderer, RenderError> {
        resolve::check_threads(threads)?;
        let threads = threads.unwrap_or(0);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| RenderError::Threads { threads, reason: error.to_string() })?;
        let engine = match choice.chosen {
            Chosen::Cpu => Engine::Cpu,
            Chosen::Cuda(driver) => Engine::Cuda(Box::new(Mutex::new(Cuda::new(driver)))),
        };
        Ok(Renderer { pool, engine, preparations: Preparations::default() })
    }

    /// Renders one picture of `scene`.
    ///
    /// # Errors
    /// [`RenderError`] where the settings have no sense for this scene, or memory does not suffice.
    pub fn render(&self, scene: &Scene, settings: &Settings) -> Result<Frame, RenderError> {
        let prepared = self.prepare(scene, settings, &Unobserved)?;
        self.render_prepared(&prepared, settings, &Unobserved)
    }

    /// Builds the acceleration structure, for any number of pictures. Geometry that this renderer has prepared before is not built again
    /// while it lives, whatever lights and cameras are around it.
    ///
    /// # Errors
    /// [`RenderError::Geometry`] where the geometry does not hold together, [`RenderError::Grid`] or [`RenderError::GridFile`] where a
    /// grid was asked for and cannot be had.
    pub fn prepare(
        &self,
        scene: &Scene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        self.pool.install(|| self.preparations.prepare(scene, &settings.acceleration, observer))
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

    /// Renders one picture of a prepared scene with what earlier pictures have found out about its light points, and keeps what it finds
    /// out itself. The picture is the same in every bit; only long tests are saved (light-mesh mode).
    ///
    /// # Errors
    /// As [`Renderer::render_prepared`].
    pub fn render_with(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.pool.install(|| match &self.engine {
            Engine::Cpu => render_on_with(&Cpu, cache.host(), scene, settings, observer),
            Engine::Cuda(cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                let kept = cache.device(cuda.pool().runtime().id());
                render_on_with(&*cuda, kept, scene, settings, observer)
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
    picture_on(backend, None, scene, settings, observer)
}

/// The same with what is kept from picture to picture on this backend, and on no other.
///
/// # Errors
/// As [`Renderer::render_prepared`].
pub fn render_on_with<B: Backend>(
    backend: &B,
    kept: &mut Kept<B::Table>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    picture_on(backend, Some(kept), scene, settings, observer)
}

fn picture_on<B: Backend>(
    backend: &B,
    kept: Option<&mut Kept<B::Table>>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    let start = Instant::now();
    let mut resolved = Resolved::new(scene, settings, observer)?;
    resolved.plan.kept = kept.as_ref().map_or(0, |kept| kept.memory());
    let Resolved { technique, view, plan, sampling, .. } = &resolved;
    let job = Job::new(observer, *sampling).with_short_tests(settings.short_tests);
    let mut picture = Picture::new(settings.size, plan.layers);
    let run = Run::new(backend, &job, kept);
    let on_device = run.or_forget(|backend| backend.scene(&job, scene, plan.memory_limit))?;
    let rows = Passes { run, scene: &on_device, technique, view, plan }.render(&mut picture)?;
    let device = report::DeviceFacts { kind: backend.kind(), name: backend.name(), peak_memory: backend.peak_memory() };
    let stats = report::stats(&job, &resolved, device, rows, start.elapsed().as_secs_f64());
    Ok(Frame { image: picture.into_frame(), stats })
}
