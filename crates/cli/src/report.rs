//! The JSON of `--stats`: the renderer's statistics, and settings known only to the command line.

use lightmesh::Stats;
use lightmesh::render::{Counts, DeviceStats, MemoryStats, SceneStats, Seconds, SettingsStats};
use lightmesh::scene::LightInfo;
use serde::Serialize;

/// [`Stats`] with the command line's settings added.
#[derive(Serialize)]
pub(crate) struct Report<'a> {
    version: u32,
    scene: &'a SceneStats,
    device: &'a DeviceStats,
    settings: AllSettings<'a>,
    counts: &'a Counts,
    seconds: &'a Seconds,
    memory: &'a MemoryStats,
}

#[derive(Serialize)]
struct AllSettings<'a> {
    #[serde(flatten)]
    render: &'a SettingsStats,
    transfer: &'static str,
    /// Stops, 0 for an exr.
    exposure: f32,
    /// The camera as described by `lightmesh info`.
    lights: &'a [LightInfo],
}

impl<'a> Report<'a> {
    pub(crate) fn new(stats: &'a Stats, transfer: &'static str, exposure: f32, lights: &'a [LightInfo]) -> Report<'a> {
        Report {
            version: stats.version,
            scene: &stats.scene,
            device: &stats.device,
            settings: AllSettings { render: &stats.settings, transfer, exposure, lights },
            counts: &stats.counts,
            seconds: &stats.seconds,
            memory: &stats.memory,
        }
    }
}
