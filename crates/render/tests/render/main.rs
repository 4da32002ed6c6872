//! Whole pictures with known answers.

mod convergence;
mod degenerate;
mod determinism;
mod fallback;
mod figures;
mod mirrors;
mod placement;
mod shading;
mod shadow_rays;
mod walls;

use lightmesh_render::{Mode, Settings, Step};

/// The method with a step of `step` scene units and a radius of `radius` steps.
fn light_mesh(size: [u32; 2], step: f32, radius: f32) -> Settings {
    Settings { size, step: Some(Step::Fixed(step)), radius: Some(radius), ..Settings::default() }
}

fn mode(mode: Mode, size: [u32; 2]) -> Settings {
    Settings { mode, size, ..Settings::default() }
}
