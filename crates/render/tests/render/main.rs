//! Whole images with known answers.

mod adaptive;
mod alpha_mask;
mod antialiasing;
mod clip;
mod convergence;
mod crop;
mod degenerate;
mod determinism;
mod emitters;
mod environment;
mod fallback;
mod figures;
mod glass;
mod ground;
mod instances;
mod irradiance_cache;
mod kept;
mod lamps;
mod light_groups;
mod lists;
mod lives;
mod mattes;
mod memory_advice;
mod mirrors;
mod near_lights;
mod normal_maps;
mod partial;
mod parts;
mod placement;
mod points;
mod progress;
mod rough_mirrors;
mod roughness_maps;
mod seen_lights;
mod shading;
mod shadow_rays;
mod textures;
mod together;
mod transmissive;
mod waking;
mod walls;

use glam::Vec3;
use lightmesh_render::{Device, Mode, PreparedScene, Renderer, Settings, Step, Unobserved};
use lightmesh_scene::{LightKind, Scene};

/// Lights for piles.
const LAMP: LightKind = LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.6 };
const POINT: LightKind = LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 };

fn renderer() -> Renderer {
    Renderer::with_threads(Device::Cpu, Some(2)).unwrap()
}

fn prepared(scene: &Scene) -> PreparedScene {
    renderer().prepare(scene, &Settings::default(), &Unobserved).unwrap()
}

/// The method with a step of `step` scene units and a radius of `radius` steps.
fn light_mesh(size: [u32; 2], step: f32, radius: f32) -> Settings {
    Settings::default().with_size(size).with_step(Step::Fixed(step)).with_radius(radius)
}

fn mode(mode: Mode, size: [u32; 2]) -> Settings {
    Settings::default().with_aa(1).with_mode(mode).with_size(size)
}
