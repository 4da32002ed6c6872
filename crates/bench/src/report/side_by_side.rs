//! Rows common to several runs, with the ratios of their times.

use std::collections::BTreeMap;

use super::assets::Assets;
use super::document::{Block, Cell, Column, Section, Table};
use super::layouts::{self, key_columns};
use super::likeness::ALIKE;
use super::numbers;
use super::pictures::{Common, Fault, Gallery};
use super::runs::{Measured, Runs, distinct};

/// A table for each experiment, then images that differ; nothing without a common row or image.
pub(crate) fn section(runs: &Runs, gallery: &Gallery, assets: &mut Assets) -> Result<Option<Section>, Fault> {
    let mut blocks = Vec::new();
    for experiment in runs.experiments() {
        blocks.extend(table(runs, experiment).map(Block::Table));
    }
    let common = gallery.between_runs(&runs.0, assets)?;
    blocks.extend(sentence(&common).map(Block::Text));
    blocks.extend(common.different);
    Ok((!blocks.is_empty()).then(|| Section::new("Comparison of the runs", blocks)))
}

/// How common images compare; `None` if there are none.
fn sentence(common: &Common) -> Option<String> {
    let verb = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let mut parts = Vec::new();
    if common.same > 0 {
        parts.push(verb(common.same, "is identical", "are identical"));
    }
    if let Some((title, trace)) = common.alike.iter().max_by(|a, b| a.1.mean_flip.total_cmp(&b.1.mean_flip)) {
        let count = common.alike.len();
        parts.push(format!(
            "{} by a mean FLIP below {} ({}{title}, {} of {} pixels, mean FLIP {})",
            verb(count, "differs", "differ"),
            numbers::setting(ALIKE),
            if count == 1 { "" } else { "at most: " },
            numbers::count(trace.differing as f64),
            numbers::count(trace.pixels as f64),
            numbers::small(trace.mean_flip)
        ));
    }
    match common.different.len() {
        0 => {}
        count => parts.push(verb(count, "differs and is shown below", "differ and are shown below")),
    }
    if common.other_sizes > 0 {
        parts
            .push(verb(common.other_sizes, "has a different size", "have different sizes") + " and cannot be compared");
    }
    (!parts.is_empty()).then(|| format!("Of the common images, {}.", parts.join("; ")))
}

/// Milliseconds of the rows of an experiment in every run, and their ratios to the first run.
fn table(runs: &Runs, experiment: &str) -> Option<Table> {
    let mut by_id: BTreeMap<&str, Vec<Option<Measured>>> = BTreeMap::new();
    for (index, run) in runs.0.iter().enumerate() {
        for measured in runs.rows(experiment).into_iter().filter(|measured| measured.run.label == run.label) {
            let cells = by_id.entry(&measured.row.id).or_insert_with(|| vec![None; runs.0.len()]);
            cells[index] = Some(measured);
        }
    }
    let order = distinct(runs.rows(experiment).into_iter().map(|measured| measured.row.id.as_str()));
    let common: Vec<&Vec<Option<Measured>>> = order
        .iter()
        .filter_map(|id| by_id.get(id))
        .filter(|cells| cells.iter().filter(|cell| timed(cell)).count() > 1)
        .collect();
    let rows: Vec<Measured> = common.iter().filter_map(|cells| cells.iter().flatten().next().copied()).collect();
    let keys = key_columns(&rows);
    let mut columns: Vec<Column> = keys.iter().map(|key| layouts::key_column(key, &rows)).collect();
    columns
        .extend(runs.0.iter().map(|run| Column::numbers(format!("{} ms", run.label), &run.label).below("median, ms")));
    let first = &runs.0.first()?.label;
    columns.extend(
        runs.0[1..]
            .iter()
            .map(|run| Column::numbers(format!("{} ratio", run.label), &run.label).below(format!("ratio to {first}"))),
    );
    let mut ratios: Vec<Vec<f64>> = vec![Vec::new(); runs.0.len()];
    let mut table = Table::new(format!("{experiment}, runs"), "", columns);
    for (cells, row) in common.iter().zip(&rows) {
        let medians: Vec<Option<f64>> = cells.iter().map(|cell| cell.and_then(|cell| layouts::whole(&cell))).collect();
        let mut line: Vec<Cell> = keys.iter().map(|key| row.text(key).into()).collect();
        line.extend(medians.iter().map(|median| Cell::number(*median, numbers::milliseconds)));
        for (median, ratios) in medians.iter().zip(&mut ratios).skip(1) {
            let ratio = median.zip(medians[0]).map(|(other, first)| other / first);
            ratios.extend(ratio);
            line.push(Cell::number(ratio, numbers::ratio));
        }
        table.rows.push(line);
    }
    table.caption = caption(experiment, runs, &ratios);
    (!table.rows.is_empty()).then_some(table)
}

fn timed(cell: &Option<Measured>) -> bool {
    cell.as_ref().and_then(layouts::whole).is_some()
}

fn caption(experiment: &str, runs: &Runs, ratios: &[Vec<f64>]) -> String {
    let means = runs.0.iter().zip(ratios).skip(1).filter_map(|(run, ratios)| {
        Some(format!("{} takes {} the time of {}", run.label, numbers::ratio(geometric_mean(ratios)?), runs.0[0].label))
    });
    let means: Vec<String> = means.collect();
    let means = if means.is_empty() { String::new() } else { format!(" Geometric mean: {}.", means.join(", ")) };
    format!("{}: rows with the same id.{means}", layouts::title(experiment))
}

pub(crate) fn geometric_mean(ratios: &[f64]) -> Option<f64> {
    let logs: Vec<f64> = ratios.iter().filter(|ratio| **ratio > 0.0).map(|ratio| ratio.ln()).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_and_half_are_even() {
        assert!((geometric_mean(&[2.0, 0.5]).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(geometric_mean(&[]), None);
    }
}
