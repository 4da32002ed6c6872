//! Statistics as JSON: those of the renderer, and settings that only the request knows.

use lightmesh_image::{BitDepth, Format, SaveOptions};
use lightmesh_render::{Counts, DeviceStats, MemoryStats, SceneStats, Seconds, SettingsStats, Stats};
use lightmesh_scene::{CreaseAngle, LightInfo};
use serde::Serialize;

use crate::files::PictureFiles;
use crate::plan::Plan;

/// [`Stats`] with the settings of the request added.
#[derive(Serialize)]
pub(crate) struct Report<'a> {
    version: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    finished_rows: Option<u32>,
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
    /// The crease angle of files without normals, degrees; none if off.
    smooth: Option<f64>,
    /// Whether meshes in many places are stored once.
    instances: &'static str,
    /// Stops, 0 for an exr.
    exposure: f32,
    /// None for an exr, as the next two.
    view: Option<&'static str>,
    bit_depth: Option<u8>,
    dither: Option<bool>,
    /// None if neither the image nor the layers are an exr, as the next.
    exr_type: Option<&'static str>,
    exr_compression: Option<&'static str>,
    /// None without layers.
    exr_parts: Option<&'static str>,
    /// The camera as described by `lightmesh info`.
    lights: &'a [LightInfo],
}

impl<'a> Report<'a> {
    pub(crate) fn new(
        stats: &'a Stats,
        (plan, files): (&Plan, &PictureFiles),
        options: &SaveOptions,
        lights: &'a [LightInfo],
    ) -> Report<'a> {
        let (display, exr) = (&options.display, &options.exr);
        let is_exr = files.format() == Some(Format::Exr);
        let has_exr = is_exr || files.layers.is_some();
        // Only 8-bit codes are dithered.
        let dither = display.dither && display.bit_depth == BitDepth::Eight;
        let settings = AllSettings {
            render: &stats.settings,
            instances: plan.instancing.name(),
            smooth: plan.smooth.map(CreaseAngle::degrees),
            transfer: display.transfer.name(),
            exposure: display.exposure,
            view: (!is_exr).then(|| display.view.name()),
            bit_depth: (!is_exr).then(|| display.bit_depth.bits()),
            dither: (!is_exr).then_some(dither),
            exr_type: has_exr.then(|| exr.samples.name()),
            exr_compression: has_exr.then(|| exr.compression.name()),
            exr_parts: files.layers.is_some().then(|| exr.parts.name()),
            lights,
        };
        Report {
            version: stats.version,
            finished_rows: stats.finished_rows,
            scene: &stats.scene,
            device: &stats.device,
            settings,
            counts: &stats.counts,
            seconds: &stats.seconds,
            memory: &stats.memory,
        }
    }
}
