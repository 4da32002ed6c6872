//! The blocks of an experiment: plots if it has some, a table of keys, times and values, and a folded one of stages and
//! counts. Only the timings and figure 11 of the thesis have tables of their own.

use super::document::{Block, Cell, Column, Table};
use super::runs::{Measured, PLACES, Runs, distinct};
use super::{curves, numbers, thesis};
use crate::{ANTIALIASING, FILM, FLICKER, FLIGHT, Key, LIGHT, MANY_LIGHTS, SHADOWS, STAGES, WHOLE, WHOLE_FRAMES};

/// Time against the number of lights, and the break-even.
pub(crate) const LIGHTS: &str = "figure 11";
pub(crate) const BREAK_EVEN: &str = "figure 11, break-even";

/// Keys in their usual order; others follow by name.
const ORDER: &str = "scene lights size frames cost with light step radius weight lookup short_tests mode method samples quality aa \
                     program rays accel device threads";

/// Experiments in the order of a report, those that compare the default method first: names, headings and captions.
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

/// Headings of values whose names are no words.
const VALUES: [(&str, &str); 9] = [
    ("visibility_rmse", "RMSE of visibility"),
    ("mean_flip", "mean FLIP"),
    ("rmse", "RMSE"),
    ("reference_rmse", "RMSE of the reference"),
    ("light_points", "S_total"),
    ("light_points_per_pixel", "S_total per pixel"),
    ("used_mean", "used mean, m"),
    ("fallback_share", "m = 0"),
    ("million_per_second", "million rays per second"),
];

/// Counts and memory, which explain times; they are shown with the stages.
const DETAILS: &str = "pixels hits rays surface_points shadow_rays long_tests short_tests short_tests_culled template half_ball_mean used_mean \
                       fallback_share host_peak_bytes device_peak_bytes";

/// The blocks of an experiment, without its images.
pub(crate) fn blocks(experiment: &str, runs: &Runs) -> Vec<Block> {
    let mut rows = runs.rows(experiment);
    if matches!(experiment, "errors" | "equal error" | "soft shadows") {
        // These are long, and each row stands alone.
        rows.sort_by_key(|row| !row.is_default());
    }
    let mut blocks = match experiment {
        "timings" => vec![Block::Table(thesis::timings(&rows))],
        LIGHTS => thesis::lights(&rows, &runs.rows(BREAK_EVEN)),
        "errors" | "soft shadows" => curves::plots(experiment, &rows),
        _ => Vec::new(),
    };
    if !matches!(experiment, "timings" | LIGHTS) {
        blocks.push(Block::Table(values(experiment, &rows)));
    }
    blocks.push(Block::Table(stages(experiment, &rows)));
    blocks.retain(|block| !matches!(block, Block::Table(table) if table.rows.is_empty()));
    blocks
}

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

/// Keys, the median of the whole frame and values. Where the thesis has a value, too, the ratio of both follows.
fn values(experiment: &str, rows: &[Measured]) -> Table {
    let mut table = keyed(experiment, EXPERIMENTS.get(place(experiment)).map_or("", |known| known.2), rows);
    let milliseconds = rows.iter().map(|row| Cell::number(row.whole(), numbers::milliseconds));
    table.add(Column::numbers(format!("{WHOLE} ms"), spaced(WHOLE)).below("median, ms"), milliseconds);
    let names = distinct(rows.iter().flat_map(|row| row.row.values.keys()));
    for name in names.into_iter().filter(|name| DETAILS.split(' ').all(|detail| detail != *name)) {
        let column = if name == "million_per_second" { "rate" } else { name };
        table.add(Column::numbers(column, heading(name)), rows.iter().map(|row| value(row, name)));
        if let Some(ours) = name.strip_prefix("thesis_") {
            let by = |row: &Measured| Some(row.value(ours)? / row.value(name)?);
            let ratios = rows.iter().map(|row| Cell::number(by(row), numbers::ratio));
            table.add(Column::numbers(format!("{ours} by thesis"), "ratio"), ratios);
        }
    }
    if table.columns.iter().any(|column| column.name.ends_with("by thesis")) {
        table.caption = format!("{} {}", table.caption, thesis::SCENES).trim().to_owned();
    }
    table
}

/// Keys, medians of stages, counts and memory; without rows if there is nothing but the whole frame.
fn stages(experiment: &str, rows: &[Measured]) -> Table {
    let caption = "Medians of stages in milliseconds, counts, and the peak memory of a frame.";
    let mut table = keyed(&format!("{experiment}, stages"), caption, rows);
    let keys = table.columns.len();
    let stages = distinct(rows.iter().flat_map(|row| row.row.seconds.keys()));
    for stage in stages.into_iter().filter(|stage| *stage != WHOLE) {
        let medians = rows.iter().map(|row| Cell::number(row.median(stage), numbers::milliseconds));
        table.add(Column::numbers(stage, spaced(stage)), medians);
    }
    for name in DETAILS.split(' ') {
        let column = Column::numbers(format!("{name} count"), heading(name)).below("counts");
        table.add(column, rows.iter().map(|row| value(row, name)));
    }
    if table.columns.len() == keys {
        table.rows.clear();
    }
    table.folded = true;
    table
}

/// A table with the keys in which rows differ; the others go to the caption. A device has its own name.
pub(crate) fn keyed(name: &str, caption: &str, rows: &[Measured]) -> Table {
    let same = |key: &str| rows.windows(2).all(|pair| pair[0].key(key) == pair[1].key(key));
    let keys = key_names(rows).into_iter().filter(|key| !PLACES.contains(key));
    let (common, keys): (Vec<&str>, Vec<&str>) = keys.partition(|key| rows.len() > 1 && same(key));
    let places = distinct(rows.iter().map(Measured::place));
    let mut common: Vec<String> =
        common.iter().map(|key| format!("{} {}", key.replace('_', " "), rows[0].text(key))).collect();
    if let [place] = &places[..] {
        common.extend((!place.is_empty()).then(|| format!("on {place}")));
    }
    let common = if common.is_empty() { String::new() } else { format!("All rows: {}.", common.join(", ")) };
    let mut table = Table::new(name, [caption, &common].join(" ").trim(), rows.len());
    for key in keys {
        table.add(key_column(key, rows), rows.iter().map(|row| Cell { text: row.text(key), value: row.number(key) }));
    }
    if places.len() > 1 {
        table.add(Column::words("place", "on"), rows.iter().map(|row| row.place().into()));
    }
    table
}

/// Names of all keys present in any row, in order.
pub(crate) fn key_names<'a>(rows: &[Measured<'a>]) -> Vec<&'a str> {
    let mut keys = distinct(rows.iter().flat_map(|measured| measured.row.keys.keys().map(String::as_str)));
    let place = |key: &str| ORDER.split(' ').position(|known| known == key).unwrap_or(usize::MAX);
    keys.sort_by(|a, b| (place(a), a).cmp(&(place(b), b)));
    keys
}

/// A column for a key: numeric if all rows have numbers.
pub(crate) fn key_column(key: &str, rows: &[Measured]) -> Column {
    let words = rows.iter().any(|measured| matches!(measured.key(key), Some(Key::Word(_))));
    let title = key.replace('_', " ");
    if words { Column::words(key, title) } else { Column::numbers(key, title) }
}

/// A heading for a value.
fn heading(name: &str) -> String {
    let known = VALUES.iter().find(|(known, _)| *known == name);
    known.map_or_else(|| spaced(name), |(_, heading)| (*heading).to_owned())
}

fn spaced(name: &str) -> String {
    name.replace("_seconds", " ms").trim_end_matches("_bytes").replace('_', " ")
}

/// A value, formatted according to its name.
fn value(row: &Measured, name: &str) -> Cell {
    Cell::number(row.value(name), |value| match name {
        _ if name.ends_with("_bytes") => numbers::bytes(value),
        _ if name.ends_with("share") => numbers::percent(value),
        _ if name.contains("_seconds") => numbers::milliseconds(value),
        _ if value.fract() == 0.0 => numbers::count(value),
        _ => numbers::significant(value, 3),
    })
}
