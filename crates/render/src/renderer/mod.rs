//! The renderer: from a scene and settings to a frame.
//!
//! [`resolve`] checks the settings and chooses what they leave open, [`crate::passes`] combines the stages, [`picture`] is the way of an image
//! through them, and [`report`] describes what was done.

pub mod crew;
mod frame;
mod picture;
mod report;
mod resolve;
mod several;
mod waking;
mod worker;

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use glam::Vec3;
use lightmesh_kernels::{Driver, Runtime};
use lightmesh_memory::Budget;
use lightmesh_scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::backend::stage_runner::StageRunner;
use crate::backend::{Backend, Cpu, Cuda};
use crate::cache::{Cache, MeshCache, MeshFileError};
use crate::data::visibility::Visibility;
use crate::device::{Choice, Chosen, ChosenDevices, Device};
use crate::error::RenderError;
use crate::gpu;
use crate::observer::{Observer, Unobserved};
use crate::passes::Baking;
use crate::prepared::{Preparations, PreparedScene};
use crate::probes::{GivenPoints, PointVisibility};
use crate::render_context::RenderContext;
use crate::settings::{Acceleration, Settings};
use crate::shadow::rows::KnownRows;
pub use frame::Frame;
use picture::{picture_around, picture_on};
use resolve::Resolved;
use several::names;
pub use several::{Speeds, render_together};
pub use waking::{Make, waking};
pub use worker::Worker;

/// Renders scenes on one device, or on several.
pub struct Renderer {
    pool: ThreadPool,
    engine: Engine,
    preparations: Preparations,
    /// Where the samples of lights lie.
    rows: Arc<KnownRows>,
}

/// The backend in use.
enum Engine {
    Cpu,
    /// A device and its backend. Images are rendered one after another: a device has one template in constant memory, and one set of counters.
    Cuda(Arc<Driver>, Box<Mutex<Cuda<Driver>>>),
    /// Several devices.
    Several(Box<Several>),
}

/// Several devices that work together.
struct Several {
    /// What one device does alone, this one does. A CUDA device if any is.
    first: Arc<Renderer>,
    workers: Vec<Box<dyn Worker>>,
    speeds: Speeds,
}

impl Several {
    /// Those that are chosen, which share so many threads. The first one is ready, and others wake.
    fn of(ChosenDevices { first, others, cpu }: ChosenDevices, threads: usize) -> Result<Several, RenderError> {
        let count = 1 + others.len() + usize::from(cpu);
        let share = Some(threads.div_ceil(count).max(2));
        let first = Arc::new(Renderer::on(*first, share)?);
        let mut workers: Vec<Box<dyn Worker>> = vec![Box::new(Arc::clone(&first))];
        if cpu {
            workers.push(Box::new(Renderer::with_threads(Device::Cpu, share)?));
        }
        let make = |number| -> (String, Make) {
            let device = Device::Cuda(Some(number));
            (device.to_string(), Box::new(move || Ok(Box::new(Renderer::with_threads(device, share)?))))
        };
        workers.extend(waking(others.into_iter().map(make).collect())?);
        Ok(Several { first, workers, speeds: Speeds::default() })
    }

    fn workers(&self) -> Vec<&dyn Worker> {
        self.workers.iter().map(|worker| &**worker).collect()
    }
}

impl Renderer {
    /// A renderer on `device` with one thread per logical CPU.
    ///
    /// # Errors
    /// [`RenderError::Device`] if the device cannot be used.
    pub fn new(device: Device) -> Result<Renderer, RenderError> {
        Renderer::with_threads(device, None)
    }

    /// A renderer on `device` with its own pool of `threads` threads.
    ///
    /// # Errors
    /// [`RenderError::Device`] if the device cannot be used, [`RenderError::Setting`] if the number of threads is invalid,
    /// [`RenderError::Threads`] if the threads cannot be started.
    pub fn with_threads(device: Device, threads: Option<usize>) -> Result<Renderer, RenderError> {
        resolve::check_threads(threads)?;
        Renderer::on(Choice::of(device)?, threads)
    }

    /// A renderer on a prepared device with its own pool of `threads` threads; `None`: one per logical CPU. Of more than 16, at most four are
    /// started for each logical CPU: others would only cost memory and time. Images do not depend on it.
    ///
    /// # Errors
    /// [`RenderError::Setting`] if the number of threads is invalid, [`RenderError::Threads`] if the threads cannot be
    /// started.
    pub fn on(choice: Choice, threads: Option<usize>) -> Result<Renderer, RenderError> {
        let pool = pool_of(threads)?;
        let engine = match choice.chosen {
            Chosen::Cpu => Engine::Cpu,
            Chosen::Cuda(driver) => Engine::Cuda(Arc::clone(&driver), Box::new(Mutex::new(Cuda::new(driver)))),
            Chosen::Several(devices) => Engine::Several(Several::of(devices, pool.current_num_threads())?.into()),
        };
        Ok(Renderer::with(pool, engine))
    }

    /// A renderer by workers, with its own pool of `threads` threads. What cannot be shared, the `first` does, which is one of them.
    ///
    /// # Errors
    /// As [`Renderer::on`].
    pub fn together(
        first: Arc<Renderer>,
        workers: Vec<Box<dyn Worker>>,
        threads: Option<usize>,
    ) -> Result<Renderer, RenderError> {
        let several = Several { first, workers, speeds: Speeds::default() };
        Ok(Renderer::with(pool_of(threads)?, Engine::Several(several.into())))
    }

    fn with(pool: ThreadPool, engine: Engine) -> Renderer {
        Renderer { pool, engine, preparations: Preparations::default(), rows: Arc::default() }
    }

    /// The devices that it renders on, each of which can render by itself: itself if it is one.
    pub fn devices(&self) -> Vec<&dyn Worker> {
        match &self.engine {
            Engine::Cpu | Engine::Cuda(..) => vec![self],
            Engine::Several(several) => several.workers(),
        }
    }

    /// Renders one image of `scene`.
    ///
    /// # Errors
    /// [`RenderError`] if the settings are invalid for this scene, or memory does not suffice.
    pub fn render(&self, scene: &Scene, settings: &Settings) -> Result<Frame, RenderError> {
        let prepared = self.prepare(scene, settings, &Unobserved)?;
        self.render_prepared(&prepared, settings, &Unobserved)
    }

    /// Builds the acceleration structure, for any number of images. The structure for geometry that this renderer has prepared before is
    /// not rebuilt while it is alive, whatever the lights and cameras.
    ///
    /// # Errors
    /// [`RenderError::Geometry`] if the geometry is inconsistent, [`RenderError::BuildMemory`] if there is not enough memory,
    /// [`RenderError::Grid`] or [`RenderError::GridFile`] if a grid was requested and cannot be built or read, [`RenderError::Structure`] if
    /// the device does not have the structure.
    pub fn prepare(
        &self,
        scene: &Scene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        self.check_structure(&settings.acceleration)?;
        let budget = self.building_budget(settings);
        self.pool.install(|| self.preparations.prepare(scene, &settings.acceleration, budget, observer))
    }

    /// [`Renderer::prepare`] for a scene of which another moment was prepared `before`, see [`Scene::at`]: what does not depend on the places
    /// of surfaces, such as textures, is kept, also on devices. While `before` is alive, a [`MeshCache`] keeps the light points between
    /// which and their lights nothing has moved. A scene that differs in more is prepared as any other. The image is the same.
    ///
    /// # Errors
    /// As [`Renderer::prepare`].
    pub fn prepare_moved(
        &self,
        before: &PreparedScene,
        scene: &Scene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<PreparedScene, RenderError> {
        self.check_structure(&settings.acceleration)?;
        let (acceleration, budget) = (&settings.acceleration, self.building_budget(settings));
        self.pool.install(|| self.preparations.prepare_moved(before, scene, acceleration, budget, observer))
    }

    /// [`MeshCache::load`] with the memory that the settings leave to the host.
    ///
    /// # Errors
    /// As [`MeshCache::load`].
    pub fn load_cache(
        &self,
        path: impl AsRef<Path>,
        scene: &PreparedScene,
        settings: &Settings,
    ) -> Result<MeshCache, MeshFileError> {
        MeshCache::load(path, scene, self.building_budget(settings))
    }

    /// Fails if the device does not have the structure; does not wait for an image that is being rendered.
    fn check_structure(&self, acceleration: &Acceleration) -> Result<(), RenderError> {
        match &self.engine {
            Engine::Cpu => Cpu.check_structure(acceleration),
            Engine::Cuda(device, _) => gpu::check_structure(&**device, acceleration),
            Engine::Several(several) => several.first.check_structure(acceleration),
        }
    }

    /// Memory for what is built on the host.
    fn building_budget(&self, settings: &Settings) -> Budget {
        match &self.engine {
            Engine::Cpu => Budget::new(settings.memory_limit),
            // The limit is that of the device's own memory.
            Engine::Cuda(..) => Budget::default(),
            Engine::Several(several) if several.workers.iter().any(|worker| worker.id().is_none()) => {
                Budget::new(settings.memory_limit)
            }
            Engine::Several(_) => Budget::default(),
        }
    }

    /// Renders one image of a prepared scene.
    ///
    /// # Errors
    /// As [`Renderer::render`], and [`RenderError::Cancelled`] if the observer requested cancellation. With
    /// [`Settings::partial`], that is no error once any row is finished: see [`Frame::finished_rows`].
    pub fn render_prepared(
        &self,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.pool.install(|| match &self.engine {
            Engine::Cpu => picture_on(&Cpu, None, &self.rows, scene, settings, observer),
            Engine::Cuda(_, cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                picture_on(&*cuda, None, &self.rows, scene, settings, observer)
            }
            Engine::Several(several) => {
                let work = (&mut MeshCache::new(), scene, settings);
                render_together(&several.workers(), &several.speeds, work, observer)
            }
        })
    }

    /// Computes what given points see of each light, whatever a camera sees: to bake vertex colours, lightmaps or irradiance probes.
    ///
    /// `points` are in the coordinates of the geometry's positions (scene units, local frame), `normals` may have any length but zero.
    /// Mode, lookup, step, radius, weight, samples and seed are those of `settings`; size and camera only matter if the step is
    /// automatic, which is then that of an image. A point with its normal is a surface seen from that side: what lies behind is dark.
    ///
    /// # Errors
    /// As [`Renderer::render_prepared`], and [`RenderError::Points`] or [`RenderError::Point`] if the points cannot be used.
    pub fn visibility(
        &self,
        scene: &PreparedScene,
        points: &[Vec3],
        normals: &[Vec3],
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<PointVisibility, RenderError> {
        let given = GivenPoints::new(scene, points, normals)?;
        self.pool.install(|| match &self.engine {
            Engine::Cpu => points_on(&Cpu, &self.rows, &given, settings, observer),
            Engine::Cuda(_, cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                points_on(&*cuda, &self.rows, &given, settings, observer)
            }
            Engine::Several(several) => {
                let first = &several.first;
                observer.note(&format!("points are computed on one device: {}", first.name()));
                first.visibility(scene, points, normals, settings, observer)
            }
        })
    }

    /// The CPU threads that it has started.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Does other work on this renderer's CPU threads, such as encoding an image.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Renders one image of a prepared scene with the cached visibility of its light points and the light that its surfaces gathered, and adds
    /// what it computes to the cache. The image is bit-identical to one without a cache; long tests and gather rays are saved.
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
            Engine::Cpu => picture_on(&Cpu, Some(cache.host()), &self.rows, scene, settings, observer),
            Engine::Cuda(_, cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                let cache = cache.device(cuda.pool().runtime().id());
                picture_on(&*cuda, Some(cache), &self.rows, scene, settings, observer)
            }
            Engine::Several(several) => {
                render_together(&several.workers(), &several.speeds, (cache, scene, settings), observer)
            }
        })
    }
}

/// A pool of so many threads; `None`: one per logical CPU.
fn pool_of(threads: Option<usize>) -> Result<ThreadPool, RenderError> {
    resolve::check_threads(threads)?;
    let threads = threads.map_or(0, resolve::worthwhile_threads);
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| RenderError::Threads { threads, reason: error.to_string() })
}

impl Worker for Renderer {
    fn name(&self) -> String {
        match &self.engine {
            Engine::Cpu => Cpu.name(),
            Engine::Cuda(driver, _) => format!("{} (cuda:{})", driver.gpu().name, driver.number()),
            Engine::Several(several) => names(several.workers()),
        }
    }

    fn id(&self) -> Option<u64> {
        match &self.engine {
            Engine::Cuda(driver, _) => Some(driver.id()),
            Engine::Cpu | Engine::Several(_) => None,
        }
    }

    fn render(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.render_with(cache, scene, settings, observer)
    }

    fn render_around(
        &self,
        cache: &mut MeshCache,
        scene: &PreparedScene,
        settings: &Settings,
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        self.pool.install(|| match &self.engine {
            Engine::Cpu => picture_around(&Cpu, Some(cache.host()), &self.rows, scene, settings, observer),
            Engine::Cuda(_, cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                let cache = cache.device(cuda.pool().runtime().id());
                picture_around(&*cuda, Some(cache), &self.rows, scene, settings, observer)
            }
            Engine::Several(_) => self.render_with(cache, scene, settings, observer),
        })
    }
}

/// Computes the visibility of each light at given points on the caller's own backend, on the caller's threads.
///
/// # Errors
/// As [`Renderer::visibility`].
pub fn visibility_on<B: Backend>(
    backend: &B,
    points: &GivenPoints,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<PointVisibility, RenderError> {
    points_on(backend, &Arc::default(), points, settings, observer)
}

fn points_on<B: Backend>(
    backend: &B,
    rows: &Arc<KnownRows>,
    points: &GivenPoints,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<PointVisibility, RenderError> {
    let start = Instant::now();
    let scene = points.scene;
    backend.check_structure(scene.geometry.acceleration())?;
    let resolved = Resolved::at_points(points, settings, observer)?;
    let context = resolved.context(observer).with_rows(rows);
    let baked = bake(backend, &context, &resolved, points);
    let (visibility, rows) = baked.map_err(|error| resolved.advise(error))?;
    context.work.finish(observer);
    let stats =
        report::stats(&context, &resolved, report::DeviceFacts::of(backend), rows, start.elapsed().as_secs_f64());
    Ok(PointVisibility { visibility, lights: scene.scene.lights.len(), stats })
}

/// What points see of each light, and how many rows of points were looked at at once.
fn bake<B: Backend>(
    backend: &B,
    context: &RenderContext,
    resolved: &Resolved,
    points: &GivenPoints,
) -> Result<(Visibility, u32), RenderError> {
    let Resolved { scene, technique, plan, .. } = resolved;
    let runner = StageRunner::new(backend, context, None);
    let on_device = runner.or_evict(|backend| backend.scene(context, scene, plan.memory_limit))?;
    Baking { runner, scene: &on_device, technique, plan }.bake(points)
}

/// Renders one image of a prepared scene on the caller's own backend, on the caller's threads.
///
/// # Errors
/// As [`Renderer::render_prepared`].
pub fn render_on<B: Backend>(
    backend: &B,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    picture_on(backend, None, &Arc::default(), scene, settings, observer)
}

/// The same with what is kept from image to image on this backend only.
///
/// # Errors
/// As [`Renderer::render_prepared`].
pub fn render_on_with<B: Backend>(
    backend: &B,
    cache: &mut Cache<B::Table>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    picture_on(backend, Some(cache), &Arc::default(), scene, settings, observer)
}
