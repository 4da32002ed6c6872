//! Experiments in the order of a report, with their headings and captions.

use crate::{ANTIALIASING, FILM, FLICKER, FLIGHT, LIGHT, MANY_LIGHTS, SHADOWS, STAGES, WHOLE_FRAMES};

/// Time against the number of lights, and the break-even.
pub(crate) const LIGHTS: &str = "figure 11";
pub(crate) const BREAK_EVEN: &str = "figure 11, break-even";

/// Experiments in their order, those that compare the default method first: names, headings and captions.
const EXPERIMENTS: [(&str, &str, &str); 23] = [
    (WHOLE_FRAMES, "Whole frames by occluder lists, the default, and others", "Faster, nearer: half-ball over row."),
    ("errors", "Errors against time", ""),
    (
        "equal error",
        "Cost at equal error",
        "Area: shadow rays with the same error. Upper bound: a single ray already has a smaller error. Not reached: no measured \
         number of rays has an error this small.",
    ),
    (
        "programs at equal error",
        "Other renderers as exact as occluder lists",
        "Times: their time over the lists' time.",
    ),
    ("soft shadows", "Soft shadows with other renderers", ""),
    ("equal time", "Error in equal time", "Area: as many shadow rays as fit into the time of the light mesh."),
    ("reference", "References, and their remaining errors", ""),
    (MANY_LIGHTS, "Many lights by occluder lists", "By one: each light's time over a single light's."),
    (SHADOWS, "Occluder lists against their reference, ordinary and adaptive rays", ""),
    ("figure 1", "Figure 1: area shadows", "Errors are relative to the first row."),
    ("timings", "Full frames: the table of the thesis", ""),
    ("table 1", "Table 1: time share of collecting light points", "The thesis always did this on the CPU."),
    ("table 2", "Table 2: light points", ""),
    (LIGHTS, "Figure 11: time against the number of lights", ""),
    (
        BREAK_EVEN,
        "Break-even of figure 11, predicted and measured",
        "The number of lights from which on the light mesh takes less time than hard shadows: predicted by formulas (4) and (5) with \
         the measured cost of tests, and measured; then linear fits to both times, fixed and per light. Empty: never.",
    ),
    ("figures 12-15", "Figures 12 to 15: images for growing R", "Errors are relative to the first row of figure 1."),
    (FLIGHT, "A flight with gathered light: flicker, rays and time", ""),
    (FLICKER, "Flicker of soft shadows on that flight", ""),
    (FILM, "Films that keep parts of earlier frames", "Ratios: over a frame for which nothing is kept."),
    (LIGHT, "The cost of light: cut-outs, mirrors, gathered light, lamps", ""),
    (ANTIALIASING, "Antialiasing: time and errors over one sample of a pixel", ""),
    (STAGES, "Time by stage", ""),
    ("rays", "Rays per second", ""),
];

/// A heading for an experiment.
pub(crate) fn title(experiment: &str) -> String {
    match EXPERIMENTS.get(place(experiment)) {
        Some((_, title, _)) => (*title).to_owned(),
        None => {
            let mut letters = experiment.chars();
            letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
        }
    }
}

/// The place of an experiment in a report.
pub(crate) fn place(experiment: &str) -> usize {
    EXPERIMENTS.iter().position(|known| known.0 == experiment).unwrap_or(EXPERIMENTS.len())
}

/// What is said above its table.
pub(crate) fn caption(experiment: &str) -> &'static str {
    EXPERIMENTS.get(place(experiment)).map_or("", |known| known.2)
}
