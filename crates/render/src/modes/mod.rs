//! How the stages are put together: one picture, whatever the mode.
//!
//! A picture is made band by band, as many rows at once as memory allows; every band gives the pixels that the whole picture
//! would. Within a band, mirrors are a loop over lists of rays.

mod bands;

pub(crate) use bands::rows_per_band;

use crate::backend::Backend;
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::method;
use crate::prepared::PreparedScene;
use crate::view::View;
use crate::{Picture, RenderError, Stage};

/// How the visibility of lights is found, with what that needs.
#[derive(Clone, Debug)]
pub(crate) enum Technique {
    /// The light mesh method.
    LightMesh(LightMesh),
    /// One hard shadow ray per light.
    RayTrace,
    /// Many shadow rays per light.
    Area,
}

/// Renders all of `view` into `picture`.
#[allow(clippy::too_many_arguments, reason = "each is a choice of its own")]
pub(crate) fn render<B: Backend>(
    backend: &B,
    job: &Job,
    scene: &PreparedScene,
    view: &View,
    technique: &Technique,
    bounces: u32,
    rows_per_band: u32,
    picture: &mut Picture,
) -> Result<(), RenderError> {
    let height = view.size()[1];
    for first in (0..height).step_by(rows_per_band as usize) {
        let rows = first..height.min(first.saturating_add(rows_per_band));
        let mut rays = backend.camera_rays(view, rows)?;
        for depth in 0..=bounces {
            let n = backend.ray_count(&rays) as u64;
            if n == 0 {
                break;
            }
            let hits = job.stage(Stage::PrimaryRays, n, || backend.primary_rays(job, scene, &rays))?;
            let visibility = match technique {
                Technique::LightMesh(mesh) => method::light_mesh(backend, job, scene, &rays, &hits, mesh)?,
                Technique::RayTrace => {
                    job.stage(Stage::LongTests, n, || backend.shadow_rays(job, scene, &rays, &hits))?
                }
                Technique::Area => job.stage(Stage::LongTests, n, || backend.area_shadows(job, scene, &rays, &hits))?,
            };
            job.stage(Stage::Shade, n, || backend.shade(job, scene, &rays, &hits, &visibility, picture))?;
            if depth < bounces {
                rays = backend.mirror_rays(scene, &rays, &hits)?;
            }
        }
    }
    Ok(())
}
