//! The statistics of a render.

use glam::Vec2;
use lightmesh_scene::Projection;

use super::resolve::Resolved;
use crate::backend::Backend;
use crate::counters::Counts;
use crate::render_context::RenderContext;
use crate::shading::ambient::AmbientLight;
use crate::stage::Seconds;
use crate::stats::{CameraStats, DeviceStats, MemoryStats, SceneStats, SettingsStats, Stats};

/// What a backend reports about itself.
pub(super) struct DeviceFacts {
    pub(super) kind: &'static str,
    pub(super) name: String,
    pub(super) peak_memory: u64,
}

impl DeviceFacts {
    pub(super) fn of<B: Backend>(backend: &B) -> DeviceFacts {
        DeviceFacts { kind: backend.kind(), name: backend.name(), peak_memory: backend.peak_memory() }
    }
}

/// The statistics of an image that was rendered in `seconds`, `rows` rows at once.
pub(super) fn stats(
    context: &RenderContext,
    resolved: &Resolved,
    device: DeviceFacts,
    rows: u32,
    seconds: f64,
) -> Stats {
    let Resolved { scene, technique, .. } = resolved;
    let counts = Counts::new(resolved.pixels, technique.template(), &context.tally.snapshot());
    if counts.overruns > 0 {
        let rays = counts.overruns;
        context
            .observer
            .note(&format!("{rays} rays were abandoned in the grid: the image may be wrong there; please report this"));
    }
    Stats {
        version: 1,
        finished_rows: None,
        scene: SceneStats {
            name: scene.scene.name.clone(),
            triangles: scene.scene.geometry.mesh.triangle_count(),
            lights: scene.scene.lights.len(),
        },
        settings: settings(resolved, device.kind, rows),
        device: DeviceStats { kind: device.kind, name: device.name },
        counts,
        seconds: Seconds { build: scene.geometry.take_build_seconds(), render: seconds, ..context.seconds() },
        memory: MemoryStats::now(device.peak_memory),
    }
}

/// Every setting as used.
fn settings(resolved: &Resolved, device: &'static str, rows_per_band: u32) -> SettingsStats {
    let Resolved { scene, settings, technique, sampling, .. } = resolved;
    let lights = &scene.scene.lights;
    let mut stats = SettingsStats {
        mode: settings.mode.name(),
        bounces: settings.bounces_in(&scene.scene),
        size: settings.size,
        // Set where the part is cut out.
        crop: None,
        device,
        threads: rayon::current_num_threads(),
        step: None,
        step_auto: false,
        radius: None,
        weight: None,
        lookup: None,
        quality: None,
        aa: resolved.plan.antialiasing.as_ref().map_or(1, |all| all.samples),
        filter: resolved.plan.antialiasing.as_ref().map(|_| settings.filter.name()),
        short_tests: None,
        samples: sampling.samples,
        accel: scene.geometry.accelerator.name(),
        camera: camera(resolved),
        ambient: AmbientLight::of(scene).mean.to_array(),
        ambient_light: settings.ambient_light.for_scene(&scene.scene).name(),
        background: lights.background.unwrap_or_default().to_array(),
        environment: lights.environment.as_ref().map(|environment| environment.name.clone()),
        transparent: settings.transparent,
        seed: settings.seed,
        memory_limit: settings.memory_limit,
        rows_per_band,
        lattice: None,
    };
    technique.describe(scene, settings, &mut stats);
    stats
}

fn camera(resolved: &Resolved) -> CameraStats {
    let Resolved { scene, settings, camera, .. } = resolved;
    let aspect = settings.size[0] as f32 / settings.size[1] as f32;
    let (vfov, height) = match camera.projection {
        Projection::Perspective(fov) => (Some(fov.vertical(aspect)), None),
        Projection::Orthographic { height } => (None, Some(height)),
    };
    CameraStats {
        position: scene.scene.to_world(camera.position).to_array(),
        direction: camera.direction.to_array(),
        up: camera.up.to_array(),
        vfov,
        height,
        shift: (camera.shift != Vec2::ZERO).then_some(camera.shift.to_array()),
        near: (camera.near > 0.0).then_some(camera.near),
        far: camera.far.is_finite().then_some(camera.far),
    }
}
