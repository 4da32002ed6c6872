//! The renderer: from a scene and settings to a frame.
//!
//! [`resolve`] checks the settings and chooses what they leave open, [`crate::passes`] combines the stages, [`report`] describes what was
//! done.

mod report;
mod resolve;

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use glam::Vec3;
use lightmesh_image::{FrameParts, Layers, SaveError};
use lightmesh_kernels::{Driver, Runtime};
use lightmesh_memory::Budget;
use lightmesh_scene::Scene;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::backend::run::Run;
use crate::backend::{Backend, Cpu, Cuda};
use crate::cache::{Kept, MeshCache, MeshFileError};
use crate::data::picture::Picture;
use crate::device::{Choice, Chosen, Device};
use crate::error::RenderError;
use crate::gathered::Sources;
use crate::gpu;
use crate::observer::{Observer, Unobserved};
use crate::passes::{Baking, Passes};
use crate::prepared::{Preparations, PreparedScene};
use crate::probes::{GivenPoints, PointVisibility};
use crate::settings::{Acceleration, Crop, Settings};
use crate::shading::ids::catchers;
use crate::shadow::rows::KnownRows;
use crate::stats::Stats;
use resolve::Resolved;

/// A finished image and its statistics.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Linear colours, and alpha and layers if requested.
    pub image: lightmesh_image::Frame,
    /// Counts, seconds and settings.
    pub stats: Stats,
}

impl Frame {
    /// Writes the image as bmp, png, exr or jpg, by the file extension; 8-bit formats in sRGB.
    ///
    /// # Errors
    /// [`SaveError`] if the extension is unknown or the file cannot be written; no partial file is left behind.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.image.save(path)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.image.width(), self.image.height()]
    }

    /// A part of the image, with what was finished of it; `None` if the frame does not have all of it.
    pub fn cropped(self, crop: Crop) -> Option<Frame> {
        let Crop { first: [x, y], size: [width, height] } = crop;
        let above = y.saturating_sub(self.image.window().first[1]);
        let finished = self.finished_rows().saturating_sub(above).min(height);
        let image = self.image.cropped(crop.first, crop.size)?;
        let mut stats = self.stats;
        stats.settings.crop = Some([x, y, width, height]);
        stats.finished_rows = (finished < height).then_some(finished);
        Some(Frame { image, stats })
    }

    /// Linear colours, row-major, row 0 at the top.
    pub fn color(&self) -> &[[f32; 3]] {
        self.image.color()
    }

    /// What each pixel sees, if [`Settings::layers`] requested it.
    pub fn layers(&self) -> Option<&Layers> {
        self.image.layers()
    }

    /// The number of finished rows, from the top: all, unless the observer cancelled the render and
    /// [`Settings::partial`] asked for what is finished. The rows below have the background's colour, or are
    /// transparent, and their layers are those of pixels that see nothing.
    pub fn finished_rows(&self) -> u32 {
        self.stats.finished_rows.unwrap_or_else(|| self.image.height())
    }

    /// The image's vectors; nothing is copied.
    pub fn into_parts(self) -> FrameParts {
        self.image.into_parts()
    }
}

/// Renders scenes on one device.
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

    /// A renderer on a prepared device with its own pool of `threads` threads; `None`: one per logical CPU.
    ///
    /// # Errors
    /// [`RenderError::Setting`] if the number of threads is invalid, [`RenderError::Threads`] if the threads cannot be
    /// started.
    pub fn on(choice: Choice, threads: Option<usize>) -> Result<Renderer, RenderError> {
        resolve::check_threads(threads)?;
        let threads = threads.unwrap_or(0);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| RenderError::Threads { threads, reason: error.to_string() })?;
        let engine = match choice.chosen {
            Chosen::Cpu => Engine::Cpu,
            Chosen::Cuda(driver) => Engine::Cuda(Arc::clone(&driver), Box::new(Mutex::new(Cuda::new(driver)))),
        };
        Ok(Renderer { pool, engine, preparations: Preparations::default(), rows: Arc::default() })
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
        }
    }

    /// Memory for what is built on the host.
    fn building_budget(&self, settings: &Settings) -> Budget {
        match &self.engine {
            Engine::Cpu => Budget::new(settings.memory_limit),
            // The limit is that of the device's own memory.
            Engine::Cuda(..) => Budget::default(),
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
        let points = GivenPoints::new(scene, points, normals)?;
        self.pool.install(|| match &self.engine {
            Engine::Cpu => points_on(&Cpu, &self.rows, &points, settings, observer),
            Engine::Cuda(_, cuda) => {
                let cuda = cuda.lock().unwrap_or_else(PoisonError::into_inner);
                points_on(&*cuda, &self.rows, &points, settings, observer)
            }
        })
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
                let kept = cache.device(cuda.pool().runtime().id());
                picture_on(&*cuda, Some(kept), &self.rows, scene, settings, observer)
            }
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
    let job = resolved.job(observer).with_rows(rows);
    let run = Run::new(backend, &job, None);
    let on_device = run.or_forget(|backend| backend.scene(&job, scene, resolved.plan.memory_limit))?;
    let Resolved { technique, plan, .. } = &resolved;
    let (visibility, rows) = Baking { run, scene: &on_device, technique, plan }.bake(points)?;
    let stats = report::stats(&job, &resolved, report::DeviceFacts::of(backend), rows, start.elapsed().as_secs_f64());
    Ok(PointVisibility { visibility, lights: scene.scene.lights.len(), stats })
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
    kept: &mut Kept<B::Table>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    picture_on(backend, Some(kept), &Arc::default(), scene, settings, observer)
}

fn picture_on<B: Backend>(
    backend: &B,
    mut kept: Option<&mut Kept<B::Table>>,
    rows: &Arc<KnownRows>,
    scene: &PreparedScene,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Frame, RenderError> {
    let start = Instant::now();
    backend.check_structure(scene.geometry.acceleration())?;
    // Where the camera sees nothing, a transparent image has nothing; mirrors still reflect the environment.
    let hidden = settings.transparent && scene.scene.lights.environment.is_some();
    let open = hidden.then(|| scene.with_lights(scene.scene.lights.clone().with_background(glam::Vec3::ZERO)));
    let scene = open.as_ref().unwrap_or(scene);
    let mut resolved = Resolved::new(scene, settings, observer)?;
    resolved.plan.kept = kept.as_ref().map_or(0, |kept| kept.memory());
    let Resolved { technique, view, plan, .. } = &resolved;
    let mut plan = plan.clone();
    if let Err(short) = backend.check_host_memory(&plan) {
        // What is kept gives way to what is needed.
        match &mut kept {
            Some(kept) if !kept.is_empty() => kept.clear(),
            _ => return Err(short),
        }
        plan.left = Budget::new(plan.memory_limit).left();
        backend.check_host_memory(&plan)?;
    }
    let job = resolved.job(observer).with_rows(rows);
    let rows = 0..plan.size[1];
    let mut picture = Picture::planned(&plan, [rows.clone(), rows]);
    let run = Run::new(backend, &job, kept);
    let on_device = run.or_forget(|backend| backend.scene(&job, scene, plan.memory_limit))?;
    if settings.has_light_points() {
        plan.reserved = run.begin_kept(backend.left(&plan));
        if backend.rows_at_once(&on_device, &plan).is_err() {
            // All of it is needed for the image.
            run.begin_kept(Some(0));
            plan.reserved = 0;
        }
    }
    let plan = &plan;
    let sources = plan.gathering.as_ref().map(|how| Sources::new(scene, settings.seed, how));
    if let Some(sources) = &sources {
        run.recall_gathered(scene, sources);
    }
    let see_through = backend.see_through(&on_device);
    let passes = Passes { run, scene: &on_device, see_through, technique, view, plan };
    let rendered = passes.render(&mut picture);
    // What a cancelled image gathered is not complete.
    if let (Ok(_), Some(sources)) = (&rendered, sources) {
        passes.run.keep_gathered(scene, sources);
    }
    let rows = match rendered {
        Err(RenderError::Cancelled) if settings.partial && picture.finished > 0 => plan.most_rows.unwrap_or_default(),
        rows => rows?,
    };
    let mut stats =
        report::stats(&job, &resolved, report::DeviceFacts::of(backend), rows, start.elapsed().as_secs_f64());
    stats.finished_rows = (picture.finished < plan.size[1]).then_some(picture.finished);
    stats.counts.pixels = u64::from(plan.size[0]) * u64::from(picture.finished);
    stats.counts.non_finite_pixels = picture.non_finite();
    if plan.compositing {
        let objects = scene.scene.geometry.mesh.objects.names().map(str::to_owned).collect();
        picture.complete_mattes([objects, scene.geometry.materials.names.clone()], plan.antialiasing.is_none());
    }
    picture.fill_unfinished(scene.scene.lights.background.unwrap_or_default());
    if settings.transparent {
        if !plan.coverage {
            picture.find_coverage();
        }
        picture.uncover_caught(if plan.caught { catchers(scene) } else { Default::default() });
        picture.take_out(scene.scene.lights.background.unwrap_or_default());
    }
    if !settings.layers {
        picture.layers = None;
    }
    let window = view.window();
    let frame = Frame { image: picture.into_frame().with_window(window.first, window.whole), stats };
    match settings.crop {
        Some(crop) => {
            let part = frame.cropped(crop).expect("the window has all pixels of the crop");
            if part.finished_rows() == 0 { Err(RenderError::Cancelled) } else { Ok(part) }
        }
        None => Ok(frame),
    }
}
