//! The blocks of an experiment: plots if it has some, a table of keys, times and values, and a folded one of stages and
//! counts. Only the timings and figure 11 of the thesis have tables of their own.

use super::document::{Block, Cell, Column, Table};
use super::experiments::{BREAK_EVEN, LIGHTS, caption};
use super::keys::keyed;
use super::runs::{Measured, Runs, distinct};
use super::{curves, numbers, thesis};
use crate::WHOLE;

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

/// Keys, the median of the whole frame and values. Where the thesis has a value, too, the ratio of both follows.
fn values(experiment: &str, rows: &[Measured]) -> Table {
    let mut table = keyed(experiment, caption(experiment), rows);
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
