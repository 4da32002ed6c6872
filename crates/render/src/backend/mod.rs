//! The interface of a device: one method per stage.
//!
//! Each backend has its own types for data between stages, so that data can stay on the device. A backend that lacks a stage does not
//! compile. The backends are [`Cpu`] and [`Cuda`]. Clocks, progress and cancellation wrap stages in one place, `run.rs`.

mod cpu;
mod cuda;
pub(crate) mod stage_runner;
mod table;

use std::ops::Range;

pub use crate::data::wave::{Seen, Wave};
pub use crate::gpu::Cuda;
pub use crate::gpu::DeviceScene;
pub use crate::gpu::bundles::DeviceBundles;
pub use crate::gpu::cells::DeviceCells;
pub use crate::gpu::film::DeviceFilm;
pub use crate::gpu::light_point_visibility::DeviceLightPointVisibility;
pub use crate::gpu::masks::DeviceMasks;
pub use crate::gpu::points::DevicePoints;
pub use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceVisibility};
pub use crate::gpu::samples::DeviceSamples;
pub use cpu::Cpu;
#[cfg(doc)]
use stage_runner::StageRunner;

use crate::antialiasing::Antialiasing;
use crate::cache::{Cache, Table};
use crate::data::picture::Picture;
use crate::data::visibility::Visibility;
use crate::error::RenderError;
use crate::light_mesh::LightMesh;
use crate::plan::Plan;
use crate::prepared::{PreparedScene, TransmissionParts};
use crate::probes::Probes;
use crate::render_context::RenderContext;
use crate::settings::Acceleration;
pub use crate::shadow::ShadowTarget;
use crate::stage::Stage;
use crate::stages::irradiance_cache::Gathering;
use crate::stages::pixel_samples::SampleRange;
use crate::view::View;
use table::{stage_methods, stage_table};

/// A wave of a backend's rays.
pub type WaveOf<'a, B> = Wave<'a, <B as Backend>::Scene, <B as Backend>::Rays, <B as Backend>::Hits>;

/// What formula (3) needs, on a backend.
pub type SeenOf<'a, B> = Seen<
    'a,
    <B as Backend>::Cells,
    <B as Backend>::Masks,
    <B as Backend>::Points,
    <B as Backend>::LightPointVisibility,
>;

/// Probes on a backend: the scene, rays and hits of a wave.
pub type Probed<B> = (<B as Backend>::Scene, <B as Backend>::Rays, <B as Backend>::Hits);

/// A device, with its operations in the order in which an image needs them.
pub trait Backend: Sized {
    /// A scene in the memory of the device.
    type Scene;
    /// Rays with the pixels they belong to.
    type Rays;
    /// One closest hit per ray.
    type Hits;
    /// What samples of pixels see.
    type Samples;
    /// The surface points of each cell of the light mesh.
    type Cells;
    /// Surface points in small groups.
    type Bundles;
    /// Which light points each surface point sees.
    type Masks;
    /// The distinct light points.
    type Points;
    /// What each light point sees of each light.
    type LightPointVisibility;
    /// What each surface point sees of each light.
    type Visibility;
    /// What each surface point receives from its surroundings and from other surfaces.
    type Gathered;
    /// What was gathered for a scene.
    type SurfaceLight: Default;
    /// Some rows of an unfinished image.
    type Film;
    /// What light points of a geometry see, kept from image to image.
    type Table: Table<Light = Self::SurfaceLight>;

    /// Its name in settings and statistics: `cpu` or `cuda`.
    fn kind(&self) -> &'static str;

    /// The vendor's name for the device.
    fn name(&self) -> String;

    /// Peak use of the device's own memory in bytes; 0 for the host.
    fn peak_memory(&self) -> u64;

    /// Does `work` and measures its time for `stage`.
    fn timed<T>(
        &self,
        context: &RenderContext,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError>;

    /// Rejects an acceleration structure that the device does not have, before any work.
    fn check_structure(&self, acceleration: &Acceleration) -> Result<(), RenderError>;

    /// Uploads the scene. Geometry that is already on the device stays. From now on the device allocates at most `memory_limit` bytes of its
    /// memory; `None`: what is free, minus a reserve.
    fn scene(
        &self,
        context: &RenderContext,
        scene: &PreparedScene,
        memory_limit: Option<u64>,
    ) -> Result<Self::Scene, RenderError>;

    /// Rejects an image for which the host's memory does not suffice, before any of it is allocated.
    fn check_host_memory(&self, plan: &Plan) -> Result<(), RenderError>;

    /// The scene taken apart for shadow rays, if some of its surfaces are not opaque.
    fn transmission_parts(&self, scene: &Self::Scene) -> Option<TransmissionParts<Self::Scene>>;

    /// Bytes of its memory that an image, and what is kept for later ones, may take; `None`: unknown.
    fn left(&self, plan: &Plan) -> Option<u64>;

    /// How many rows of the image can be rendered at once: an estimate from the sizes of all buffers, before any is allocated.
    fn rows_at_once(&self, scene: &Self::Scene, plan: &Plan) -> Result<u32, RenderError>;

    /// Begins some rows of an image, all black: all that are rendered, and those of them that are kept. Discards counts and times since the
    /// last band ended.
    fn film(&self, plan: &Plan, rows: [Range<u32>; 2]) -> Result<Self::Film, RenderError>;

    /// The camera rays of the rows `rows`, one per pixel, row by row; they are mirrored `bounces` times at most.
    fn camera_rays(&self, view: &View, rows: Range<u32>, bounces: u32) -> Result<Self::Rays, RenderError>;

    /// Number of rays.
    fn ray_count(&self, rays: &Self::Rays) -> usize;

    /// Given points as a wave that hits them, with the scene as that wave needs it. Discards counts and times since the last band ended.
    fn probes(&self, scene: &Self::Scene, probes: &Probes) -> Result<Probed<Self>, RenderError>;

    /// The cells as units of work, for progress.
    fn cell_pieces(&self, cells: &Self::Cells) -> usize;

    /// The bundles as units of work, for progress.
    fn bundle_pieces(&self, bundles: &Self::Bundles) -> usize;

    /// Number of long tests from these light points, to all lights.
    fn long_test_count(&self, wave: &WaveOf<Self>, points: &Self::Points) -> usize;

    /// Whether [`Backend::fragment_counts`] takes no time to speak of.
    const COUNTS_FOR_NOTHING: bool = false;

    /// How many shared fragments, single samples and mirror samples there will be, but for pixels that will be split.
    fn fragment_counts(
        &self,
        wave: &WaveOf<Self>,
        samples: &Self::Samples,
        film: &Self::Film,
        all: &Antialiasing,
    ) -> Result<[usize; 3], RenderError>;

    stage_table!(stage_methods);

    /// Finds what each surface point receives from its surroundings and from other surfaces, by what is `kept` and what is missing there.
    fn gather(
        &self,
        wave: &WaveOf<Self>,
        how: &Gathering,
        kept: &mut Self::SurfaceLight,
    ) -> Result<Self::Gathered, RenderError>;

    /// Waits for all stages of a band, and adds their counts and times to the context.
    fn finish(&self, context: &RenderContext) -> Result<(), RenderError>;

    /// Copies visibility to the host.
    fn visibility(&self, visibility: Self::Visibility) -> Result<Visibility, RenderError>;

    /// Copies finished rows into the image.
    fn develop(&self, scene: &Self::Scene, film: Self::Film, picture: &mut Picture) -> Result<(), RenderError>;
}
