//! Timing: repeated renders that alternate between variants.
//!
//! Because variants alternate, drifts in the machine's speed affect all of them equally. A first, uncounted round warms up
//! caches, threads and a GPU's copy of the scene. All samples are kept.

use std::collections::BTreeMap;

use lightmesh::render::{PreparedScene, Seconds, Stats};
use lightmesh::{Frame, Observer, RenderError, Renderer, Settings, Stage};

use crate::{Row, Samples, WHOLE};

/// One way to render an image.
pub struct Variant<'a> {
    /// The device.
    pub renderer: &'a Renderer,
    /// The scene.
    pub scene: &'a PreparedScene,
    /// The settings.
    pub settings: Settings,
}

/// How often each variant is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds {
    /// Whether there is a first, uncounted round.
    pub warm_up: bool,
    /// Counted rounds, at least 1.
    pub repetitions: usize,
}

/// The measurements of a variant.
pub struct Measured {
    /// Seconds of each stage that took any time, and of `render`, the whole frame: one sample per repetition.
    pub seconds: BTreeMap<String, Samples>,
    /// The last frame.
    pub frame: Frame,
}

/// Renders all variants alternately, `rounds` times. The observer is polled for a request to stop, but gets no events: stages are
/// too short to be of interest.
///
/// # Errors
/// As [`Renderer::render_prepared`].
pub fn measure(variants: &[Variant], rounds: Rounds, observer: &dyn Observer) -> Result<Vec<Measured>, RenderError> {
    let silent = Silent(observer);
    let render = |variant: &Variant| {
        reset_peak_memory();
        variant.renderer.render_prepared(variant.scene, &variant.settings, &silent)
    };
    if rounds.warm_up {
        for variant in variants {
            render(variant)?;
        }
    }
    let mut measured = Vec::with_capacity(variants.len());
    for variant in variants {
        let frame = render(variant)?;
        let mut seconds = BTreeMap::new();
        add_samples(&mut seconds, &frame.stats.seconds);
        measured.push(Measured { seconds, frame });
    }
    for _ in 1..rounds.repetitions {
        for (variant, measured) in variants.iter().zip(&mut measured) {
            measured.frame = render(variant)?;
            add_samples(&mut measured.seconds, &measured.frame.stats.seconds);
        }
    }
    Ok(measured)
}

impl Measured {
    /// Median seconds of the whole render.
    pub fn median(&self) -> f64 {
        self.seconds.get(WHOLE).and_then(Samples::median).unwrap_or(0.0)
    }

    /// Moves seconds and the counts of the last frame into a row.
    pub fn fill(&self, row: &mut Row) {
        row.seconds = self.seconds.clone();
        row.values.extend(counts(&self.frame.stats));
    }
}

/// Counts and memory by their names in `--stats`, except those that are 0; and light points per pixel.
pub fn counts(stats: &Stats) -> BTreeMap<String, f64> {
    let (counts, memory) = (&stats.counts, &stats.memory);
    let more = [
        ("light_points_per_pixel", counts.light_points as f64 / counts.pixels as f64),
        ("host_peak_bytes", memory.host_peak_bytes as f64),
        ("device_peak_bytes", memory.device_peak_bytes as f64),
    ];
    let figures = counts.values().into_iter().chain(more);
    figures.filter(|(_, figure)| *figure != 0.0).map(|(name, figure)| (name.to_owned(), figure)).collect()
}

/// The stages of a frame in order. Building happens once for many frames and is not included.
fn stages() -> impl Iterator<Item = Stage> {
    Stage::ALL.into_iter().filter(|stage| *stage != Stage::Build)
}

/// The names of the stages of a frame in order, and of the whole frame.
pub(crate) fn stage_names() -> impl Iterator<Item = &'static str> {
    stages().map(Stage::name).chain([WHOLE])
}

/// Adds the stages of a frame that took time, by their names in `--stats`.
fn add_samples(samples: &mut BTreeMap<String, Samples>, seconds: &Seconds) {
    let times = stages().map(|stage| seconds.of(stage)).chain([seconds.render]);
    for (stage, seconds) in stage_names().zip(times).filter(|(_, seconds)| *seconds > 0.0) {
        samples.entry(stage.to_owned()).or_default().push(seconds);
    }
}

/// Resets this process's peak memory, if the system supports it: Linux does when 5 is written to this file. Elsewhere the peak is
/// that of the whole run so far.
fn reset_peak_memory() {
    // Without permission the value is an upper bound.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Forwards requests to stop, nothing else.
pub(crate) struct Silent<'a>(pub(crate) &'a dyn Observer);

impl Observer for Silent<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
