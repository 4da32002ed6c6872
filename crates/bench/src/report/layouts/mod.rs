//! What is shown of each experiment. Those of the suites have layouts of their own; whatever else comes is shown by [`generic`].

mod generic;
pub(super) mod lights;
pub(super) mod quality;
mod rays;
mod tables;
pub(super) mod thesis;

use super::document::{Block, Column};
use super::numbers;
use super::runs::{Measured, Runs, distinct};
use crate::Key;
pub(crate) use crate::WHOLE;

/// Time by the number of lights, and what follows from it.
pub(crate) const LIGHTS: &str = "figure 11";
pub(crate) const BREAK_EVEN: &str = "figure 11, break-even";

/// Keys in the order in which people look for them; others follow by name.
const ORDER: [&str; 15] = [
    "scene", "lights", "size", "step", "radius", "weight", "lookup", "mode", "method", "samples", "program", "rays",
    "accel", "device", "threads",
];

/// Heading and blocks of an experiment, without its pictures.
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
        _ if quality::fits(&rows) => quality::errors(experiment, &rows),
        _ => generic::blocks(experiment, &rows),
    };
    (title(experiment), blocks)
}

/// A heading for an experiment.
pub(crate) fn title(experiment: &str) -> String {
    let known = match experiment {
        "timings" => "Whole pictures: the table of the thesis",
        "table 1" => "Table 1: the share of collecting light points",
        "table 2" => "Table 2: light points",
        "figure 1" => "Figure 1: area shadows",
        LIGHTS => "Figure 11: time against the number of lights",
        BREAK_EVEN => "Break-even of figure 11, by the cost model and by the clock",
        "figures 12-15" => "Figures 12 to 15: the picture as R grows",
        "reference" => "References, and how far they are from having converged",
        "errors" => "Errors against time",
        "equal error" => "What equal errors cost",
        "equal time" => "What equal times give",
        "rays" => "Rays per second",
        "soft shadows" => "Soft shadows by other renderers",
        "peers" => "Other renderers",
        _ => "",
    };
    if !known.is_empty() {
        return known.to_owned();
    }
    let mut letters = experiment.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A setting for people.
pub(crate) fn key_text(key: &Key) -> String {
    match key {
        Key::Number(number) => numbers::setting(*number),
        Key::Word(word) => word.clone(),
    }
}

/// Names of the keys that any row has, in order.
pub(crate) fn key_columns(rows: &[Measured]) -> Vec<String> {
    let mut keys = distinct(rows.iter().flat_map(|measured| measured.row.keys.keys().cloned()));
    let place = |key: &str| ORDER.iter().position(|known| *known == key).unwrap_or(ORDER.len());
    keys.sort_by(|a, b| (place(a), a).cmp(&(place(b), b)));
    keys
}

/// A column for a key: of numbers where all rows have numbers there.
pub(crate) fn key_column(key: &str, rows: &[Measured]) -> Column {
    let words = rows.iter().any(|measured| matches!(measured.key(key), Some(Key::Word(_))));
    let title = key.replace('_', " ");
    if words { Column::words(key, title) } else { Column::numbers(key, title) }
}

/// Median seconds of the whole: of `render`, or of the only thing that was timed.
pub(crate) fn whole(measured: &Measured) -> Option<f64> {
    let seconds = &measured.row.seconds;
    let only = || if seconds.len() == 1 { seconds.values().next() } else { None };
    seconds.get(WHOLE).or_else(only)?.median()
}
