//! Rows common to several runs, with the ratios of their times.

use super::document::{Block, Cell, Column, Section, Table};
use super::experiments;
use super::keys::{key_column, key_names};
use super::numbers;
use super::pictures::{Fault, Gallery};
use super::runs::{Measured, Runs, distinct};

/// A table for each experiment, then images that differ; nothing without a common row or image.
pub(crate) fn section(runs: &Runs, gallery: &Gallery) -> Result<Option<Section>, Fault> {
    let tables = runs.experiments().into_iter().map(|experiment| table(runs, experiment));
    let mut blocks: Vec<Block> = tables.filter(|table| !table.rows.is_empty()).map(Block::Table).collect();
    blocks.extend(gallery.between_runs()?);
    Ok((!blocks.is_empty()).then(|| Section { title: "Comparison of the runs".to_owned(), blocks }))
}

/// Milliseconds of the rows of an experiment in every run, and their ratios to the first run.
fn table(runs: &Runs, experiment: &str) -> Table {
    let timed: Vec<Measured> = runs.rows(experiment).into_iter().filter(|row| row.whole().is_some()).collect();
    let ids = distinct(timed.iter().map(|row| row.row.id.as_str())).into_iter();
    // A line for each id: seconds in each run, and the first row with it.
    let lines = ids.map(|id| {
        let of_id = || timed.iter().filter(|row| row.row.id == id);
        let seconds = |label: &str| of_id().find(|row| row.run.label == label)?.whole();
        (of_id().count(), of_id().next().copied(), runs.0.iter().map(|run| seconds(&run.label)).collect::<Vec<_>>())
    });
    let lines: Vec<_> = lines.filter(|(count, ..)| *count > 1).collect();
    let rows: Vec<Measured> = lines.iter().filter_map(|(_, row, _)| *row).collect();
    let mut table = Table::new(format!("{experiment}, runs"), experiments::title(experiment), rows.len());
    for key in key_names(&rows) {
        table.add(key_column(key, &rows), rows.iter().map(|row| row.text(key).into()));
    }
    for (index, run) in runs.0.iter().enumerate() {
        let milliseconds = lines.iter().map(|(.., seconds)| Cell::number(seconds[index], numbers::milliseconds));
        table.add(Column::numbers(format!("{} ms", run.label), &run.label).below("median, ms"), milliseconds);
    }
    let Some((first, others)) = runs.0.split_first() else { return table };
    table.caption += ": rows with the same id.";
    for (index, run) in (1..).zip(others) {
        let ratio = |seconds: &[Option<f64>]| Some(seconds[index]? / seconds[0]?);
        let ratios: Vec<Option<f64>> = lines.iter().map(|(.., seconds)| ratio(seconds)).collect();
        if let Some(mean) = geometric_mean(ratios.iter().flatten().copied()) {
            let (mean, of) = (numbers::ratio(mean), &first.label);
            table.caption += &format!(" Geometric mean: {} takes {mean} the time of {of}.", run.label);
        }
        let column =
            Column::numbers(format!("{} ratio", run.label), &run.label).below(format!("ratio to {}", first.label));
        table.add(column, ratios.into_iter().map(|ratio| Cell::number(ratio, numbers::ratio)));
    }
    table
}

/// `None` without a positive ratio.
pub(crate) fn geometric_mean(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    let logs: Vec<f64> = ratios.filter(|ratio| *ratio > 0.0).map(f64::ln).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_and_half_are_even() {
        assert!((geometric_mean([2.0, 0.5].into_iter()).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(geometric_mean(std::iter::empty()), None);
    }
}
