//! Whole images with known answers.

mod convergence;
mod degenerate;
mod determinism;
mod fallback;
mod figures;
mod kept;
mod lives;
mod mirrors;
mod placement;
mod points;
mod progress;
mod shading;
mod shadow_rays;
mod walls;

use lightmesh_render::{Mode, Settings, Step};

/// The method with a step of `step` scene units and a radius of `radius` steps.
fn light_mesh(size: [u32; 2], step: f32, radius: f32) -> Settings {
    Settings::default().with_size(size).with_step(Step::Fixed(step)).with_radius(radius)
}

fn mode(mode: Mode, size: [u32; 2]) -> Settings {
    Settings::default().with_mode(mode).with_size(size)
}
