//! Timing: the same pictures again and again, in turn.
//!
//! Variants alternate, so that a machine whose speed drifts slows all of them alike. A first round that does not count warms caches,
//! threads and a GPU's copy of the scene. All samples are kept.

use std::collections::BTreeMap;

use lightmesh::render::{PreparedScene, Seconds, Stats};
use lightmesh::{Frame, Observer, RenderError, Renderer, Settings, Stage};

use crate::{Row, Samples, WHOLE};

/// One way to make a picture.
pub struct Variant<'a> {
    /// Where.
    pub renderer: &'a Renderer,
    /// Of what.
    pub scene: &'a PreparedScene<'a>,
    /// How.
    pub settings: Settings,
}

/// How often each variant is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rounds {
    /// Whether a first round does not count.
    pub warm_up: bool,
    /// Rounds that count, at least 1.
    pub repetitions: usize,
}

/// What was measured of a variant.
pub struct Measured {
    /// Seconds of each stage that took any, and of `render`, the whole: one sample a repetition.
    pub seconds: BTreeMap<String, Samples>,
    /// The last picture.
    pub frame: Frame,
}

/// Renders all variants in turn, as often as `rounds` says. The observer is asked whether to stop, and told nothing: stages come too
/// fast to be of interest.
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

    /// Moves seconds and the counts of the last picture into a row.
    pub fn fill(&self, row: &mut Row) {
        row.seconds = self.seconds.clone();
        row.values.extend(counts(&self.frame.stats));
    }
}

/// Counts and memory by their names in `--stats`, those that are not 0; and light points per pixel.
pub fn counts(stats: &Stats) -> BTreeMap<String, f64> {
    let (counts, memory) = (&stats.counts, &stats.memory);
    let pixels = counts.pixels as f64;
    let figures = [
        ("pixels", pixels),
        ("hits", counts.hits as f64),
        ("template", counts.template as f64),
        ("half_ball_mean", counts.half_ball_mean),
        ("used_mean", counts.used_mean),
        ("fallback_share", counts.fallback_share),
        ("light_points", counts.light_points as f64),
        ("light_points_per_pixel", counts.light_points as f64 / pixels),
        ("short_tests", counts.short_tests as f64),
        ("short_tests_culled", counts.short_tests_culled as f64),
        ("long_tests", counts.long_tests as f64),
        ("shadow_rays", counts.shadow_rays as f64),
        ("host_peak_bytes", memory.host_peak_bytes as f64),
        ("device_peak_bytes", memory.device_peak_bytes as f64),
    ];
    figures.into_iter().filter(|(_, figure)| *figure != 0.0).map(|(name, figure)| (name.to_owned(), figure)).collect()
}

/// The stages of a picture that took time, by their names in `--stats`. Building is done once for many pictures, and no part of them.
fn add_samples(samples: &mut BTreeMap<String, Samples>, seconds: &Seconds) {
    let stages = [
        (Stage::Upload.name(), seconds.upload),
        (Stage::PrimaryRays.name(), seconds.primary_rays),
        (Stage::ShortTests.name(), seconds.short_tests),
        (Stage::Collect.name(), seconds.collect),
        (Stage::LongTests.name(), seconds.long_tests),
        (Stage::Shade.name(), seconds.shade),
        (Stage::Download.name(), seconds.download),
        (WHOLE, seconds.render),
    ];
    for (stage, seconds) in stages.into_iter().filter(|(_, seconds)| *seconds > 0.0) {
        samples.entry(stage.to_owned()).or_default().0.push(seconds);
    }
}

/// Lets the peak of this process' memory begin anew, where the system can: Linux does at a 5 in this file. Elsewhere the peak is that
/// of the whole run so far.
fn reset_peak_memory() {
    // Without permission the figure is an upper bound.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Passes on the wish to stop, nothing else.
pub(crate) struct Silent<'a>(pub(crate) &'a dyn Observer);

impl Observer for Silent<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
