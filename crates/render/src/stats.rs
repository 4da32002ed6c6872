//! The statistics of a render: the JSON of `--stats`.

use serde::Serialize;

use crate::counters::Counts;
use crate::light_mesh::Lattice;
use crate::prepared::PreparedScene;
use crate::stage::Seconds;

/// Counts, seconds and every resolved setting of an image. Seconds are wall time.
#[derive(Clone, Debug, Serialize)]
pub struct Stats {
    /// Version of this format.
    pub version: u32,
    /// If the render was stopped: the number of rows that are finished, from the top; counts are theirs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finished_rows: Option<u32>,
    /// What was rendered.
    pub scene: SceneStats,
    /// The device that rendered it.
    pub device: DeviceStats,
    /// Every setting as used.
    pub settings: SettingsStats,
    /// How often each event happened.
    pub counts: Counts,
    /// Time spent in each stage.
    pub seconds: Seconds,
    /// Memory use.
    pub memory: MemoryStats,
}

/// The scene in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct SceneStats {
    /// The scene's name.
    pub name: String,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of lights.
    pub lights: usize,
}

/// The device.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceStats {
    /// `cpu`, `cuda`, or `cuda,cpu` of several.
    pub kind: &'static str,
    /// The vendor's name for the device.
    pub name: String,
}

/// The lattice in world coordinates: light point (i, j, k) lies at origin + step · (i, j, k).
#[derive(Clone, Debug, Serialize)]
pub struct LatticeStats {
    /// World position of light point (0, 0, 0).
    pub origin: [f64; 3],
    /// h in scene units.
    pub step: f32,
    /// Number of light points along each axis.
    pub dims: [u32; 3],
}

/// The camera in world coordinates.
#[derive(Clone, Debug, Serialize)]
pub struct CameraStats {
    /// Position of the eye.
    pub position: [f64; 3],
    /// Viewing direction; unit length.
    pub direction: [f32; 3],
    /// Up vector; unit length.
    pub up: [f32; 3],
    /// Vertical field of view in degrees; none for an orthographic camera.
    pub vfov: Option<f32>,
    /// Height of the image in scene units; none for a perspective camera.
    pub height: Option<f32>,
    /// By how much the image is to the right of the viewing direction and above it, in heights of the image, if it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f32; 2]>,
    /// The depth from which on surfaces and lights are seen, if not all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub near: Option<f32>,
    /// The depth up to which they are seen, if not all are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub far: Option<f32>,
}

/// Every setting as used.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs, reason = "named as the flags are")]
pub struct SettingsStats {
    pub mode: &'static str,
    pub bounces: u32,
    pub size: [u32; 2],
    /// Column, row, width and height of the part that was rendered; `None`: all. The first two are negative to the left of the image and above.
    pub crop: Option<[i64; 4]>,
    pub device: &'static str,
    pub threads: usize,
    pub step: Option<f32>,
    pub step_auto: bool,
    pub radius: Option<f32>,
    pub weight: Option<&'static str>,
    pub lookup: Option<&'static str>,
    pub quality: Option<&'static str>,
    pub aa: u32,
    pub filter: Option<&'static str>,
    pub short_tests: Option<&'static str>,
    pub samples: u32,
    pub accel: &'static str,
    pub camera: CameraStats,
    pub ambient: [f32; 3],
    pub ambient_light: &'static str,
    pub background: [f32; 3],
    /// The name of the sky or the panorama.
    pub environment: Option<String>,
    pub transparent: bool,
    pub seed: u64,
    pub memory_limit: Option<u64>,
    pub rows_per_band: u32,
    pub lattice: Option<LatticeStats>,
}

/// Peak memory in bytes; 0 if the system does not report it.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs, reason = "the names say all")]
pub struct MemoryStats {
    pub host_peak_bytes: u64,
    pub device_peak_bytes: u64,
}

impl LatticeStats {
    pub(crate) fn new(scene: &PreparedScene, lattice: &Lattice) -> LatticeStats {
        let origin = scene.scene.to_world(lattice.point(lattice.first)).to_array();
        LatticeStats { origin, step: lattice.step, dims: lattice.dims }
    }
}

impl MemoryStats {
    pub(crate) fn now(device_peak_bytes: u64) -> MemoryStats {
        MemoryStats { host_peak_bytes: lightmesh_memory::peak().unwrap_or(0), device_peak_bytes }
    }
}
