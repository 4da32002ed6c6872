//! The table of the thesis: whole pictures by both modes, what they cost stage by stage, and what was counted.

use super::{WHOLE, key_column, key_columns};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::runs::{Case, Measured, distinct};

/// The mode, and keys that not every mode has.
const OF_A_MODE: [&str; 7] = ["mode", "step", "radius", "weight", "lookup", "samples", "method"];

/// Seconds of the thesis on its CPU and its GPU.
const THESIS: [&str; 2] = ["thesis_cpu_seconds", "thesis_gpu_seconds"];

const TIMES: &str = "Milliseconds of whole pictures by the method: minimum and median. Hard: the median with hard shadows, one shadow \
                     ray for each pixel and light; the ratio is the method's median to that. × thesis: how many times less than the \
                     thesis' seconds on a CPU (Core i7-950) or a GPU (Tesla C2070).";

/// Counts by name, with their headings.
const COUNTS: [(&str, &str); 7] = [
    ("light_points", "S_total"),
    ("light_points_per_pixel", "S_total a pixel"),
    ("half_ball_mean", "half-ball mean"),
    ("used_mean", "used mean, m"),
    ("fallback_share", "m = 0"),
    ("host_peak_bytes", "host memory"),
    ("device_peak_bytes", "GPU memory"),
];

/// Stages by name, with their headings.
const STAGES: [(&str, &str); 7] = [
    ("upload", "upload"),
    ("primary_rays", "primary rays"),
    ("short_tests", "short tests"),
    ("collect", "collect"),
    ("long_tests", "long tests, shadow rays"),
    ("shade", "shade"),
    ("download", "download"),
];

pub(super) fn frames(rows: &[Measured]) -> Vec<Block> {
    vec![Block::Table(times(rows)), Block::Table(stages(rows).folded()), Block::Table(counts(rows).folded())]
}

/// Whether two rows show the same scene, lights and pixels, measured at the same place, whatever the mode.
pub(crate) fn same_picture(row: &Measured, other: &Measured) -> bool {
    let case = |row: &Measured| row.case(&OF_A_MODE);
    row.place_name() == other.place_name() && case(row) == case(other)
}

/// The row of another mode that shows the same, at the same place.
fn companion<'a>(row: &Measured, mode: &str, rows: &'a [Measured<'a>]) -> Option<&'a Measured<'a>> {
    rows.iter().find(|other| other.is("mode", mode) && same_picture(row, other))
}

/// A line for each picture by the method: minimum and median at every place, hard shadows beside them, and the thesis' seconds.
fn times(rows: &[Measured]) -> Table {
    let mesh: Vec<Measured> = rows.iter().filter(|row| row.is("mode", "light-mesh")).copied().collect();
    let cases = distinct(mesh.iter().map(|row| row.case(&["mode"])));
    let places = distinct(mesh.iter().map(|row| (row.place_name(), row.place())));
    let keys = case_columns(&mesh);

    let mut columns: Vec<Column> = keys.iter().map(|key| key_column(key, &mesh)).collect();
    for (name, title) in &places {
        let figures =
            [("min", "min"), ("median", "median"), ("hard", "hard"), ("ratio", "ratio"), ("faster", "× thesis")];
        columns.extend(
            figures.iter().map(|(figure, heading)| Column::numbers(format!("{name} {figure}"), *heading).below(title)),
        );
    }
    columns.extend(
        [("cpu", "CPU"), ("gpu", "GPU")]
            .map(|(kind, title)| Column::numbers(format!("thesis {kind}"), title).below("thesis, s")),
    );
    let mut table = Table::new("timings", TIMES, columns);
    for case in &cases {
        let of_case = |row: &&Measured| row.case(&["mode"]) == *case;
        let mut cells: Vec<Cell> = keys.iter().map(|key| case.text(key).into()).collect();
        for (place, _) in &places {
            let row = mesh.iter().filter(of_case).find(|row| row.place_name() == *place);
            cells.extend(place_cells(row, rows));
        }
        for name in THESIS {
            let seconds = mesh.iter().filter(of_case).find_map(|row| row.value(name));
            cells.push(Cell::number(seconds, |seconds| numbers::significant(seconds, 3)));
        }
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// Minimum, median, hard shadows, ratio, and how many times faster than the thesis on the same kind of device.
fn place_cells(row: Option<&Measured>, rows: &[Measured]) -> [Cell; 5] {
    let Some(row) = row else { return Default::default() };
    let median = row.median(WHOLE);
    let hard = companion(row, "ray-trace", rows).and_then(|row| row.median(WHOLE));
    let thesis = row.value(THESIS[usize::from(row.is("device", "cuda"))]);
    [
        Cell::number(row.min(WHOLE), numbers::milliseconds),
        Cell::number(median, numbers::milliseconds),
        Cell::number(hard, numbers::milliseconds),
        Cell::number(median.zip(hard).map(|(mesh, hard)| mesh / hard), numbers::ratio),
        Cell::number(thesis.zip(median).map(|(thesis, ours)| thesis / ours), numbers::ratio),
    ]
}

/// Median milliseconds of each stage, in both modes.
fn stages(rows: &[Measured]) -> Table {
    let keys = case_columns(rows);
    let mut columns = vec![Column::words("place", "on"), Column::words("mode", "mode")];
    columns.extend(keys.iter().map(|key| key_column(key, rows)));
    columns.extend(STAGES.iter().map(|(stage, title)| Column::numbers(*stage, *title)));
    columns.push(Column::numbers(WHOLE, "whole"));
    let mut table =
        Table::new("timings, stages", "Milliseconds of each stage, medians; stages that took none are empty.", columns);
    for row in rows {
        let mut cells: Vec<Cell> = vec![row.place().into(), row.text("mode").into()];
        cells.extend(keys.iter().map(|key| Cell::from(row.text(key))));
        let stages = STAGES.iter().map(|(stage, _)| *stage).chain([WHOLE]);
        cells.extend(stages.map(|stage| Cell::number(row.median(stage), numbers::milliseconds)));
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// What was counted; equal counts of several places share a line.
fn counts(rows: &[Measured]) -> Table {
    let mesh: Vec<Measured> = rows.iter().filter(|row| row.is("mode", "light-mesh")).copied().collect();
    let keys = case_columns(&mesh);
    let mut columns = vec![Column::words("place", "on")];
    columns.extend(keys.iter().map(|key| key_column(key, &mesh)));
    columns.extend(COUNTS.iter().map(|(count, title)| Column::numbers(*count, *title)));
    let mut table =
        Table::new("timings, counts", "Counts of the method, and the most memory that a picture took.", columns);
    for row in &mesh {
        let mut cells: Vec<Cell> = vec![row.place().into()];
        cells.extend(keys.iter().map(|key| Cell::from(row.text(key))));
        cells.extend(
            COUNTS.iter().map(|(name, _)| Cell::number(row.value(name), |value| super::generic::figure(name, value))),
        );
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// Keys that tell what was done, not where.
fn case_columns(rows: &[Measured]) -> Vec<String> {
    let cases: Vec<Case> = rows.iter().map(|row| row.case(&["mode"])).collect();
    key_columns(rows).into_iter().filter(|key| cases.iter().any(|case| case.0.contains_key(key))).collect()
}
