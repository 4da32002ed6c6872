//! What a render reports: the JSON of `--stats`.

use serde::Serialize;

use crate::job::{Job, Tally};
use crate::light_mesh::{Lattice, LightMesh};
use crate::prepared::PreparedScene;
use crate::{Stage, memory};

/// Counts, seconds and every resolved setting of a picture. Seconds are wall time.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    /// Version of this format.
    pub version: u32,
    /// What was rendered.
    pub scene: SceneStats,
    /// What rendered it.
    pub device: DeviceStats,
    /// Every setting as it was used.
    pub settings: SettingsStats,
    /// How often what happened.
    pub counts: Counts,
    /// How long what took.
    pub seconds: Seconds,
    /// How much memory it took.
    pub memory: MemoryStats,
}

/// The scene in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct SceneStats {
    /// Its name.
    pub name: String,
    /// Its triangles.
    pub triangles: usize,
    /// Its lights.
    pub lights: usize,
}

/// The device.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceStats {
    /// `cpu` or `cuda`.
    pub kind: &'static str,
    /// What the maker calls it.
    pub name: String,
}

/// The lattice in world coordinates: light point (i, j, k) lies at origin + step · (i, j, k).
#[derive(Clone, Debug, Serialize)]
pub struct LatticeStats {
    /// World position of light point (0, 0, 0).
    pub origin: [f64; 3],
    /// h, scene units.
    pub step: f32,
    /// Light points along each axis.
    pub dims: [u32; 3],
}

/// The camera in world coordinates.
#[derive(Clone, Debug, Serialize)]
pub struct CameraStats {
    /// Where it stands.
    pub position: [f64; 3],
    /// Where it looks; unit length.
    pub direction: [f32; 3],
    /// Which way is up; unit length.
    pub up: [f32; 3],
    /// Vertical angle in degrees; none for an orthographic camera.
    pub vfov: Option<f32>,
    /// Height of the picture in scene units; none for a perspective camera.
    pub height: Option<f32>,
}

/// Every setting as it was used.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "named as the flags are")]
pub struct SettingsStats {
    pub mode: &'static str,
    pub bounces: u32,
    pub size: [u32; 2],
    pub device: &'static str,
    pub threads: usize,
    pub step: Option<f32>,
    pub step_auto: bool,
    pub radius: Option<f32>,
    pub weight: Option<&'static str>,
    pub lookup: Option<&'static str>,
    pub short_tests: Option<&'static str>,
    pub samples: u32,
    pub accel: &'static str,
    pub camera: CameraStats,
    pub ambient: [f32; 3],
    pub background: [f32; 3],
    pub seed: u64,
    pub memory_limit: Option<u64>,
    pub rows_per_band: u32,
    pub lattice: Option<LatticeStats>,
}

/// How often what happened. Means are over the object points, those in mirrors included.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs, reason = "the fields are explained in METHOD.md, cost model")]
pub struct Counts {
    pub pixels: u64,
    pub rays: u64,
    pub hits: u64,
    pub template: u64,
    pub half_ball_mean: f64,
    pub used_mean: f64,
    pub fallback_share: f64,
    pub light_points: u64,
    pub short_tests: u64,
    pub short_tests_culled: u64,
    pub long_tests: u64,
    pub shadow_rays: u64,
}

/// How long what took. `load`, `build` and `write` are no part of `render`. On a device the stages from `primary_rays` to `shade`
/// are the device's own time.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs, reason = "named as the stages are")]
pub struct Seconds {
    pub load: f64,
    pub build: f64,
    pub upload: f64,
    pub primary_rays: f64,
    pub short_tests: f64,
    pub collect: f64,
    pub long_tests: f64,
    pub shade: f64,
    pub download: f64,
    pub render: f64,
    pub write: f64,
}

/// Peak memory in bytes; 0 where the system does not tell.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs, reason = "the names say all")]
pub struct MemoryStats {
    pub host_peak_bytes: u64,
    pub device_peak_bytes: u64,
}

impl LatticeStats {
    pub(crate) fn new(scene: &PreparedScene, lattice: &Lattice) -> LatticeStats {
        let origin = scene.scene.to_world(lattice.origin).to_array();
        LatticeStats { origin, step: lattice.step, dims: lattice.dims }
    }
}

impl Counts {
    pub(crate) fn new(job: &Job, pixels: u64, mesh: Option<&LightMesh>) -> Counts {
        let tally = &job.tally;
        let mean = |count| Tally::get(count) as f64 / (Tally::get(&tally.object_points) as f64).max(1.0);
        Counts {
            pixels,
            rays: Tally::get(&tally.rays),
            hits: Tally::get(&tally.hits),
            template: mesh.map_or(0, |mesh| mesh.template.len() as u64),
            half_ball_mean: mean(&tally.half_ball),
            used_mean: mean(&tally.used),
            fallback_share: mean(&tally.fallbacks),
            light_points: Tally::get(&tally.light_points),
            short_tests: Tally::get(&tally.short_tests),
            short_tests_culled: Tally::get(&tally.short_tests_culled),
            long_tests: Tally::get(&tally.long_tests),
            shadow_rays: Tally::get(&tally.shadow_rays),
        }
    }
}

impl Seconds {
    pub(crate) fn new(job: &Job, build: f64, render: f64) -> Seconds {
        Seconds {
            build,
            upload: job.seconds(Stage::Upload),
            download: job.seconds(Stage::Download),
            primary_rays: job.seconds(Stage::PrimaryRays),
            short_tests: job.seconds(Stage::ShortTests),
            collect: job.seconds(Stage::Collect),
            long_tests: job.seconds(Stage::LongTests),
            shade: job.seconds(Stage::Shade),
            render,
            ..Seconds::default()
        }
    }
}

impl MemoryStats {
    pub(crate) fn now(device_peak_bytes: u64) -> MemoryStats {
        MemoryStats { host_peak_bytes: memory::peak().unwrap_or(0), device_peak_bytes }
    }
}
