//! What a device must be able to do: one method per stage of the method.
//!
//! Data between stages has a type of the backend's own, so that it can stay where the device keeps it. A stage that a backend
//! lacks does not compile. [`Cpu`] and [`Cuda`] are the backends there are. Clocks, progress and cancelling wrap stages in one place,
//! `run.rs`.

mod cpu;
mod cuda;
pub(crate) mod run;

use std::ops::Range;

pub use crate::data::wave::{Seen, Wave};
pub use crate::gpu::Cuda;
pub use crate::gpu::DeviceScene;
pub use crate::gpu::cells::DeviceCells;
pub use crate::gpu::film::DeviceFilm;
pub use crate::gpu::lit::DeviceLit;
pub use crate::gpu::masks::DeviceMasks;
pub use crate::gpu::points::DevicePoints;
pub use crate::gpu::rays::{DeviceHits, DeviceRays, DeviceVisibility};
pub use cpu::Cpu;
#[cfg(doc)]
use run::Run;

use crate::cache::{Kept, Table};
use crate::data::picture::Picture;
use crate::error::RenderError;
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::plan::Plan;
use crate::prepared::PreparedScene;
pub use crate::shadow::Aim;
use crate::stage::Stage;
use crate::view::View;

/// A wave of a backend's rays.
pub type WaveOf<'a, B> = Wave<'a, <B as Backend>::Scene, <B as Backend>::Rays, <B as Backend>::Hits>;

/// What formula (3) needs, on a backend.
pub type SeenOf<'a, B> =
    Seen<'a, <B as Backend>::Cells, <B as Backend>::Masks, <B as Backend>::Points, <B as Backend>::Lit>;

/// The stages, in the order in which a picture needs them.
pub trait Backend {
    /// A scene where the device needs it.
    type Scene;
    /// Rays with the pixels they belong to.
    type Rays;
    /// One closest hit per ray.
    type Hits;
    /// The surface points of each cell of the light mesh.
    type Cells;
    /// Which light points each surface point sees.
    type Masks;
    /// The distinct light points.
    type Points;
    /// What each light point sees of each light.
    type Lit;
    /// What each surface point sees of each light.
    type Visibility;
    /// Some rows of a picture in the making.
    type Film;
    /// What light points of a geometry see, kept from picture to picture.
    type Table: Table;

    /// The word in settings and statistics: `cpu` or `cuda`.
    fn kind(&self) -> &'static str;

    /// What the maker calls the device.
    fn name(&self) -> String;

    /// Most bytes of its own memory that the device has held at once; 0 for the host.
    fn peak_memory(&self) -> u64;

    /// Does `work` and takes its time for `stage`.
    fn timed<T>(
        &self,
        job: &Job,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError>;

    /// Brings the scene to where the device needs it. Geometry that is there already stays. From now on the device takes at most
    /// `memory_limit` bytes of its memory; `None`: what is free, less a reserve.
    fn scene(&self, job: &Job, scene: &PreparedScene, memory_limit: Option<u64>) -> Result<Self::Scene, RenderError>;

    /// How many rows of the picture can be made at once: an estimate of what each buffer takes, made before any is allocated.
    fn rows_at_once(&self, scene: &Self::Scene, plan: &Plan) -> Result<u32, RenderError>;

    /// Begins some rows of a picture, black ones. What was counted and timed since the last ones ended is forgotten.
    fn film(&self, plan: &Plan, rows: Range<u32>) -> Result<Self::Film, RenderError>;

    /// The rays of the picture rows `rows`, one per pixel, row by row.
    fn camera_rays(&self, view: &View, rows: Range<u32>) -> Result<Self::Rays, RenderError>;

    /// Number of rays.
    fn ray_count(&self, rays: &Self::Rays) -> usize;

    /// What does each ray see?
    fn primary_rays(&self, job: &Job, scene: &Self::Scene, rays: &Self::Rays) -> Result<Self::Hits, RenderError>;

    /// Which surface points share a cell?
    fn cells(&self, wave: &WaveOf<Self>, mesh: &LightMesh) -> Result<Self::Cells, RenderError>;

    /// Pieces of work that the cells are, for progress.
    fn cell_pieces(&self, cells: &Self::Cells) -> usize;

    /// Which light points does each surface point see? Formula (2).
    fn short_tests(
        &self,
        wave: &WaveOf<Self>,
        cells: &Self::Cells,
        mesh: &LightMesh,
    ) -> Result<Self::Masks, RenderError>;

    /// Each light point that is used, once. Formula (7).
    fn light_points(
        &self,
        job: &Job,
        cells: &Self::Cells,
        masks: &Self::Masks,
        mesh: &LightMesh,
    ) -> Result<Self::Points, RenderError>;

    /// Number of long tests from these light points, to all lights.
    fn long_test_count(&self, wave: &WaveOf<Self>, points: &Self::Points) -> usize;

    /// What does each light point see of each light? What is known is not tested again, what is found is kept.
    fn long_tests(
        &self,
        wave: &WaveOf<Self>,
        points: &Self::Points,
        mesh: &LightMesh,
        kept: Option<&mut Kept<Self::Table>>,
    ) -> Result<Self::Lit, RenderError>;

    /// The weighted mean over the light points that a surface point uses. Formula (3).
    fn interpolate(&self, wave: &WaveOf<Self>, seen: &SeenOf<Self>) -> Result<Self::Visibility, RenderError>;

    /// Shadow rays from each surface point: one to the middle of each light, or many spread over it.
    fn shadow_rays(&self, wave: &WaveOf<Self>, aim: &Aim) -> Result<Self::Visibility, RenderError>;

    /// Formula (1): adds the rays' radiance to the pixels they belong to.
    fn shade(
        &self,
        wave: &WaveOf<Self>,
        visibility: &Self::Visibility,
        film: &mut Self::Film,
    ) -> Result<(), RenderError>;

    /// The rays of the last term of formula (1): from every mirroring surface point along the mirrored view.
    fn mirror_rays(&self, wave: &WaveOf<Self>) -> Result<Self::Rays, RenderError>;

    /// Waits for all stages of some rows; what they counted and how long they took goes to the job.
    fn finish(&self, job: &Job) -> Result<(), RenderError>;

    /// Finished rows take their place in the picture.
    fn develop(&self, scene: &Self::Scene, film: Self::Film, picture: &mut Picture) -> Result<(), RenderError>;
}
