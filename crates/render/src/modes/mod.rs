//! How the stages are put together: one picture, whatever the mode.
//!
//! A picture is made band by band, as many rows at once as memory allows; every band gives the pixels that the whole picture
//! would. Within a band, mirrors are a loop over lists of rays.

pub(crate) mod bands;

use std::ops::Range;

use crate::backend::Backend;
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::method;
use crate::prepared::PreparedScene;
use crate::view::View;
use crate::{Picture, RenderError, Stage};

/// How the visibility of lights is found, with what that needs.
#[derive(Clone, Debug)]
pub enum Technique {
    /// The light mesh method.
    LightMesh(LightMesh),
    /// One hard shadow ray per light.
    RayTrace,
    /// Many shadow rays per light.
    Area,
}

/// What picture is to be made, and within what memory.
#[derive(Clone, Debug)]
pub struct Plan {
    /// How the visibility of lights is found.
    pub technique: Technique,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Depth of mirror recursion.
    pub bounces: u32,
    /// Number of lights whose layers are kept; `None`: no layers.
    pub layers: Option<usize>,
    /// Bytes to stay under; `None`: what is free, less a reserve.
    pub memory_limit: Option<u64>,
}

/// Renders all of `view` into `picture`. Returns how many rows were made at once.
///
/// Where memory ends in spite of the plan, the band is begun again with half of its rows: what a picture takes is known only
/// when its light points are.
pub(crate) fn render<B: Backend>(
    backend: &B,
    job: &Job,
    scene: &PreparedScene,
    view: &View,
    plan: &Plan,
    picture: &mut Picture,
) -> Result<u32, RenderError> {
    let height = view.size()[1];
    let mut at_once = backend.rows_at_once(scene, plan)?;
    let mut first = 0;
    while first < height {
        let rows = first..height.min(first.saturating_add(at_once));
        let counted = job.tally.snapshot();
        match band(backend, job, scene, view, plan, rows.clone(), picture) {
            Ok(()) => first = rows.end,
            Err(RenderError::DeviceMemory { .. }) if rows.len() > 1 => {
                job.tally.restore(&counted);
                at_once = rows.len() as u32 / 2;
                job.observer.note(&format!("device memory is short: {at_once} rows at once"));
            }
            Err(error) => return Err(error),
        }
    }
    Ok(at_once)
}

/// Renders some rows.
fn band<B: Backend>(
    backend: &B,
    job: &Job,
    scene: &PreparedScene,
    view: &View,
    plan: &Plan,
    rows: Range<u32>,
    picture: &mut Picture,
) -> Result<(), RenderError> {
    let mut film = backend.film(plan, rows.clone())?;
    let mut rays = backend.camera_rays(view, rows)?;
    for depth in 0..=plan.bounces {
        let n = backend.ray_count(&rays) as u64;
        if n == 0 {
            break;
        }
        let hits = job.stage(backend, Stage::PrimaryRays, n, || backend.primary_rays(job, scene, &rays))?;
        let visibility = match &plan.technique {
            Technique::LightMesh(mesh) => method::light_mesh(backend, job, scene, &rays, &hits, mesh)?,
            Technique::RayTrace => {
                job.stage(backend, Stage::LongTests, n, || backend.shadow_rays(job, scene, &rays, &hits))?
            }
            Technique::Area => {
                job.stage(backend, Stage::LongTests, n, || backend.area_shadows(job, scene, &rays, &hits))?
            }
        };
        job.stage(backend, Stage::Shade, n, || backend.shade(job, scene, &rays, &hits, &visibility, &mut film))?;
        if depth < plan.bounces {
            rays = backend.mirror_rays(job, scene, &rays, &hits)?;
        }
    }
    backend.develop(job, scene, film, picture)
}
