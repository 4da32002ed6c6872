//! The layout of each experiment. Those of the suites have custom layouts; any other is shown by [`generic`].

mod generic;
pub(super) mod lights;
pub(super) mod quality;
mod rays;
mod shadows;
mod tables;
pub(super) mod thesis;

use super::document::{Block, Column};
use super::numbers;
use super::runs::{Measured, Runs, distinct};
use crate::Key;
pub(crate) use crate::{ANTIALIASING, FILM, FLICKER, FLIGHT, LIGHT, MANY_LIGHTS, SHADOWS, STAGES, WHOLE, WHOLE_FRAMES};

/// Time against the number of lights, and the break-even.
pub(crate) const LIGHTS: &str = "figure 11";
pub(crate) const BREAK_EVEN: &str = "figure 11, break-even";

/// Keys in their usual order; others follow by name.
const ORDER: [&str; 22] = [
    "scene",
    "lights",
    "size",
    "frames",
    "cost",
    "with",
    "light",
    "step",
    "radius",
    "weight",
    "lookup",
    "short_tests",
    "mode",
    "method",
    "samples",
    "quality",
    "aa",
    "program",
    "rays",
    "accel",
    "device",
    "threads",
];

/// Heading and blocks of an experiment, without its images.
pub(crate) fn of(experiment: &str, runs: &Runs) -> (String, Vec<Block>) {
    let rows = runs.rows(experiment);
    let blocks = match experiment {
        _ if rows.is_empty() => Vec::new(),
        "timings" => thesis::frames(&rows),
        "table 1" => tables::table_1(&rows),
        "table 2" => tables::table_2(&rows),
        "figure 1" | "figures 12-15" => tables::pictures(experiment, &rows),
        LIGHTS => lights::figure(&rows, &runs.rows(BREAK_EVEN)),
        BREAK_EVEN => tables::break_even(&rows),
        "equal error" => quality::equal_errors(&rows),
        "equal time" => quality::equal_time(&rows),
        "rays" => rays::rates(&rows),
        STAGES => thesis::by_stage(&rows),
        // They have errors, but in tables of their own.
        SHADOWS | ANTIALIASING | FLIGHT | FLICKER | FILM | LIGHT => generic::blocks(experiment, &rows),
        WHOLE_FRAMES => shadows::whole_frames(&rows),
        MANY_LIGHTS => shadows::many_lights(&rows),
        _ if quality::fits(&rows) => quality::errors(experiment, &rows),
        _ => generic::blocks(experiment, &rows),
    };
    (title(experiment), blocks)
}

/// A heading for an experiment.
pub(crate) fn title(experiment: &str) -> String {
    let known = match experiment {
        "timings" => "Full frames: the table of the thesis",
        "table 1" => "Table 1: time share of collecting light points",
        "table 2" => "Table 2: light points",
        "figure 1" => "Figure 1: area shadows",
        LIGHTS => "Figure 11: time against the number of lights",
        BREAK_EVEN => "Break-even of figure 11, predicted and measured",
        "figures 12-15" => "Figures 12 to 15: images for growing R",
        "reference" => "References, and their remaining errors",
        "errors" => "Errors against time",
        "equal error" => "Cost at equal error",
        "equal time" => "Error in equal time",
        "rays" => "Rays per second",
        STAGES => "Time by stage",
        WHOLE_FRAMES => "Whole frames: the default, the half-ball, adaptive shadow rays",
        ANTIALIASING => "Antialiasing: time and errors by those of one sample of a pixel",
        MANY_LIGHTS => "Many lights: time and memory of occluder lists",
        FLIGHT => "A flight with gathered light: flicker, rays and time",
        FLICKER => "Flicker of soft shadows on that flight",
        FILM => "Films: what is kept from frame to frame",
        LIGHT => "What light costs: cut-outs, mirrors, gathered light, lamps",
        "soft shadows" => "Soft shadows with other renderers",
        "programs at equal error" => "Other renderers at the error of occluder lists",
        "peers" => "Other renderers",
        _ => "",
    };
    if !known.is_empty() {
        return known.to_owned();
    }
    let mut letters = experiment.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A setting as text.
pub(crate) fn key_text(key: &Key) -> String {
    match key {
        Key::Number(number) => numbers::setting(*number),
        Key::Word(word) => word.clone(),
    }
}

/// Names of all keys present in any row, in order.
pub(crate) fn key_columns(rows: &[Measured]) -> Vec<String> {
    let mut keys = distinct(rows.iter().flat_map(|measured| measured.row.keys.keys().cloned()));
    let place = |key: &str| ORDER.iter().position(|known| *known == key).unwrap_or(ORDER.len());
    keys.sort_by(|a, b| (place(a), a).cmp(&(place(b), b)));
    keys
}

/// A column for a key: numeric if all rows have numbers.
pub(crate) fn key_column(key: &str, rows: &[Measured]) -> Column {
    let words = rows.iter().any(|measured| matches!(measured.key(key), Some(Key::Word(_))));
    let title = key.replace('_', " ");
    if words { Column::words(key, title) } else { Column::numbers(key, title) }
}

/// Median seconds of the whole frame: of `render`, or of the only timed stage.
pub(crate) fn whole(measured: &Measured) -> Option<f64> {
    let seconds = &measured.row.seconds;
    let only = || if seconds.len() == 1 { seconds.values().next() } else { None };
    seconds.get(WHOLE).or_else(only)?.median()
}
