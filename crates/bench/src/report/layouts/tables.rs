//! The smaller tables of the thesis.

use super::generic::{chosen, split_keys};
use super::thesis::SCENES;
use super::{WHOLE, key_column};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::runs::Measured;

pub(super) fn table_1(rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("collect_seconds", "collect, ms"),
        ("total_seconds", "whole, ms"),
        ("share", "share"),
        ("thesis_share", "share in the thesis"),
    ];
    let caption =
        "Time spent listing the used light points. The thesis did this on the CPU, even when rendering on the GPU.";
    vec![chosen("table 1", &format!("{caption} {SCENES}"), rows, &[], &values)]
}

/// S_total compared with the thesis, and per pixel.
pub(super) fn table_2(rows: &[Measured]) -> Vec<Block> {
    let (keys, common) = split_keys(rows);
    let mut columns: Vec<Column> = keys.iter().map(|key| key_column(key, rows)).collect();
    columns.push(Column::numbers("light_points", "S_total"));
    columns.push(Column::numbers("per_pixel", "per pixel"));
    columns.push(Column::numbers("thesis_light_points", "S_total in the thesis"));
    columns.push(Column::numbers("ratio", "ratio"));
    let caption = "Light points used: S_total. Ratio: by that of the thesis.";
    let mut table = Table::new("table 2", [caption, SCENES, &common].join(" ").trim(), columns);
    for row in rows {
        let (ours, thesis) = (row.value("light_points"), row.value("thesis_light_points"));
        let mut cells: Vec<Cell> = keys.iter().map(|key| row.text(key).into()).collect();
        cells.push(Cell::number(ours, numbers::count));
        let pixels = row.number("size").map(|side| side * side);
        cells.push(Cell::number(ours.zip(pixels).map(|(ours, pixels)| ours / pixels), |share| {
            numbers::significant(share, 2)
        }));
        cells.push(Cell::number(thesis, numbers::count));
        cells.push(Cell::number(ours.zip(thesis).map(|(ours, thesis)| ours / thesis), numbers::ratio));
        table.rows.push(cells);
    }
    vec![Block::Table(table)]
}

/// The rows of the images of figures 1 and 12 to 15.
pub(super) fn pictures(experiment: &str, rows: &[Measured]) -> Vec<Block> {
    let values = [
        ("rmse", "RMSE"),
        ("mean_flip", "mean FLIP"),
        ("light_points", "S_total"),
        ("half_ball_mean", "half-ball mean"),
        ("shadow_rays", "shadow rays"),
    ];
    vec![chosen(
        experiment,
        "Errors are relative to area shadows with the most samples.",
        rows,
        &[(WHOLE, "whole")],
        &values,
    )]
}

pub(super) fn break_even(rows: &[Measured]) -> Vec<Block> {
    let values = [("predicted_lights", "predicted, lights"), ("measured_lights", "measured, lights")];
    let caption = "Number of lights from which on the method takes less time than hard shadows: predicted by formulas (4) and (5) with the \
                   measured cost of tests, and measured. An empty cell: never, or not with the measured numbers of lights.";
    let mut table = vec![chosen(super::BREAK_EVEN, caption, rows, &[], &values)];
    let costs = rows.iter().filter_map(|row| {
        let nanoseconds = |name| Some(numbers::significant(1e9 * row.value(name)?, 3));
        let (short, long) = (nanoseconds("short_test_seconds")?, nanoseconds("long_test_seconds")?);
        Some(Block::Text(format!(
            "{}: a short test takes {short} ns, a long one {long} ns, over all threads.",
            row.place()
        )))
    });
    table.extend(costs);
    table
}
