//! The light mesh method. Each line below is one step of it; `stages/` has one folder for each.

use crate::backend::Backend;
use crate::job::Job;
use crate::light_mesh::LightMesh;
use crate::prepared::PreparedScene;
use crate::{RenderError, Stage};

/// Steps 2 to 5 for a list of rays and their hits: from object points to the visibility of every light at each.
///
/// Step 1, primary rays, is common to all modes; so is formula (1), which takes the result.
pub fn light_mesh<B: Backend>(
    backend: &B,
    job: &Job,
    scene: &PreparedScene,
    rays: &B::Rays,
    hits: &B::Hits,
    mesh: &LightMesh,
) -> Result<B::Visibility, RenderError> {
    let n = backend.ray_count(rays) as u64;

    // Which light points does each object point see?                                                     (2)
    let masks = job.stage(backend, Stage::ShortTests, n, || backend.short_tests(job, scene, rays, hits, mesh))?;

    // Each of them once.                                                                                  (7)
    let points = job.stage(backend, Stage::Collect, n, || backend.light_points(job, &masks, mesh))?;

    // Which lights does each of them see?
    let lit = job.stage(backend, Stage::LongTests, n, || backend.long_tests(job, scene, &points, mesh))?;

    // The weighted mean of what an object point's light points see.                                      (3)
    job.stage(backend, Stage::Shade, n, || backend.interpolate(job, scene, rays, hits, &masks, &points, &lit, mesh))
}
