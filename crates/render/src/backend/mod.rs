//! What a device must be able to do: one method per stage of the method.
//!
//! Data between stages has a type of the backend's own, so that it can stay where the device keeps it. A stage that a backend
//! lacks does not compile. [`Cpu`] and [`Cuda`] are the backends there are.

mod cpu;
pub(crate) mod cuda;

pub use crate::stages::light_points::cuda::DevicePoints;
pub use crate::stages::long_tests::cuda::DeviceLit;
pub use crate::stages::short_tests::cuda::DeviceMasks;
pub use cpu::Cpu;
pub use cuda::{Cuda, DeviceFilm, DeviceHits, DeviceRays, DeviceVisibility};

use std::ops::Range;

use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::modes::Plan;
use crate::prepared::PreparedScene;
use crate::view::View;
use crate::{Picture, RenderError, Stage};

/// The stages, in the order in which a picture needs them.
pub trait Backend {
    /// Rays with the pixels they belong to.
    type Rays;
    /// One closest hit per ray.
    type Hits;
    /// Which light points each object point uses, grouped by cell.
    type Masks;
    /// The distinct light points.
    type Points;
    /// What each light point sees of each light.
    type Lit;
    /// What each object point sees of each light.
    type Visibility;
    /// Some rows of a picture in the making.
    type Film;

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

    /// Brings the scene to where the device needs it. A second time for the same scene this costs nothing.
    fn upload(&self, job: &Job, scene: &PreparedScene, plan: &Plan) -> Result<(), RenderError>;

    /// How many rows of the picture can be made at once: an estimate of what each buffer takes, made before any is allocated.
    fn rows_at_once(&self, scene: &PreparedScene, plan: &Plan) -> Result<u32, RenderError>;

    /// Black rows of a picture.
    fn film(&self, plan: &Plan, rows: Range<u32>) -> Result<Self::Film, RenderError>;

    /// The rays of the picture rows `rows`, one per pixel, row by row.
    fn camera_rays(&self, view: &View, rows: Range<u32>) -> Result<Self::Rays, RenderError>;

    /// Number of rays.
    fn ray_count(&self, rays: &Self::Rays) -> usize;

    /// What does each ray see?
    fn primary_rays(&self, job: &Job, scene: &PreparedScene, rays: &Self::Rays) -> Result<Self::Hits, RenderError>;

    /// Which light points does each object point see? Formula (2).
    fn short_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
        mesh: &LightMesh,
    ) -> Result<Self::Masks, RenderError>;

    /// Each light point that is used, once. Formula (7).
    fn light_points(&self, job: &Job, masks: &Self::Masks, mesh: &LightMesh) -> Result<Self::Points, RenderError>;

    /// What does each light point see of each light?
    fn long_tests(
        &self,
        job: &Job,
        scene: &PreparedScene,
        points: &Self::Points,
        mesh: &LightMesh,
    ) -> Result<Self::Lit, RenderError>;

    /// The weighted mean over the light points that an object point uses. Formula (3).
    #[allow(clippy::too_many_arguments, reason = "formula (3) has that many inputs")]
    fn interpolate(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
        masks: &Self::Masks,
        points: &Self::Points,
        lit: &Self::Lit,
        mesh: &LightMesh,
    ) -> Result<Self::Visibility, RenderError>;

    /// Hard-shadow ray tracing: one ray from each object point to the middle of each light.
    fn shadow_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
    ) -> Result<Self::Visibility, RenderError>;

    /// Area shadows: many rays from each object point to each light.
    fn area_shadows(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
    ) -> Result<Self::Visibility, RenderError>;

    /// Formula (1): adds the rays' radiance to the pixels they belong to.
    fn shade(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
        visibility: &Self::Visibility,
        film: &mut Self::Film,
    ) -> Result<(), RenderError>;

    /// Finished rows take their place in the picture, and what was counted on the way in the tally.
    fn develop(
        &self,
        job: &Job,
        scene: &PreparedScene,
        film: Self::Film,
        picture: &mut Picture,
    ) -> Result<(), RenderError>;

    /// The rays of the last term of formula (1): from every mirroring object point along the mirrored view.
    fn mirror_rays(
        &self,
        job: &Job,
        scene: &PreparedScene,
        rays: &Self::Rays,
        hits: &Self::Hits,
    ) -> Result<Self::Rays, RenderError>;
}
