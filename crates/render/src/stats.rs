//! The statistics of a render: the JSON of `--stats`.

use std::collections::BTreeSet;
use std::sync::Mutex;

use serde::{Deserialize, Deserializer, Serialize};

use crate::counters::Counts;
use crate::light_mesh::Lattice;
use crate::prepared::PreparedScene;
use crate::stage::Seconds;
use crate::sync::locked;

/// One of a few words, such as the name of a mode.
type Word = &'static str;

/// Counts, seconds and every resolved setting of an image. Seconds are wall time.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stats {
    /// Version of this format.
    pub version: u32,
    /// If the render was stopped: the number of rows that are finished, from the top; counts are theirs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
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
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SceneStats {
    /// The scene's name.
    pub name: String,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of lights.
    pub lights: usize,
}

/// The device.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct DeviceStats {
    /// `cpu`, `cuda`, or `cuda,cpu` of several.
    #[serde(deserialize_with = "word")]
    pub kind: Word,
    /// The vendor's name for the device.
    pub name: String,
}

/// The lattice in world coordinates: light point (i, j, k) lies at origin + step · (i, j, k).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LatticeStats {
    /// World position of light point (0, 0, 0).
    pub origin: [f64; 3],
    /// h in scene units.
    pub step: f32,
    /// Number of light points along each axis.
    pub dims: [u32; 3],
}

/// The camera in world coordinates.
#[derive(Clone, Debug, Serialize, Deserialize)]
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f32; 2]>,
    /// The depth from which on surfaces and lights are seen, if not all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<f32>,
    /// The depth up to which they are seen, if not all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<f32>,
}

/// Every setting as used.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(missing_docs, reason = "named as the flags are")]
pub struct SettingsStats {
    #[serde(deserialize_with = "word")]
    pub mode: Word,
    pub bounces: u32,
    pub size: [u32; 2],
    /// Column, row, width and height of the part that was rendered; `None`: all. The first two are negative to the left of the image and above.
    pub crop: Option<[i64; 4]>,
    #[serde(deserialize_with = "word")]
    pub device: Word,
    pub threads: usize,
    pub step: Option<f32>,
    pub step_auto: bool,
    pub radius: Option<f32>,
    #[serde(deserialize_with = "word_or_none")]
    pub weight: Option<Word>,
    #[serde(deserialize_with = "word_or_none")]
    pub lookup: Option<Word>,
    #[serde(deserialize_with = "word_or_none")]
    pub quality: Option<Word>,
    pub aa: u32,
    #[serde(deserialize_with = "word_or_none")]
    pub filter: Option<Word>,
    #[serde(deserialize_with = "word_or_none")]
    pub short_tests: Option<Word>,
    pub samples: u32,
    #[serde(deserialize_with = "word")]
    pub accel: Word,
    pub camera: CameraStats,
    pub ambient: [f32; 3],
    #[serde(deserialize_with = "word")]
    pub ambient_light: Word,
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
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[allow(missing_docs, reason = "the names say all")]
pub struct MemoryStats {
    pub host_peak_bytes: u64,
    pub device_peak_bytes: u64,
}

impl Stats {
    /// Adds those of another part of the same image, which another renderer has made.
    pub fn add(&mut self, other: &Stats) {
        self.counts.add(&other.counts);
        self.seconds.add(&other.seconds);
        let memory = &mut self.memory;
        memory.host_peak_bytes = memory.host_peak_bytes.max(other.memory.host_peak_bytes);
        memory.device_peak_bytes = memory.device_peak_bytes.max(other.memory.device_peak_bytes);
    }
}

/// A word of statistics that another process has written. Each is kept once, for as long as the program runs: there are few.
fn known(word: String) -> Word {
    static WORDS: Mutex<BTreeSet<Word>> = Mutex::new(BTreeSet::new());
    let mut words = locked(&WORDS);
    match words.get(word.as_str()) {
        Some(known) => known,
        None => {
            let word: Word = Box::leak(word.into_boxed_str());
            words.insert(word);
            word
        }
    }
}

fn word<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Word, D::Error> {
    String::deserialize(deserializer).map(known)
}

fn word_or_none<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Word>, D::Error> {
    Ok(Option::<String>::deserialize(deserializer)?.map(known))
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
