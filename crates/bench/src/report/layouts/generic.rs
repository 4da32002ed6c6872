//! Any experiment: a table of all its keys, times and values.

use super::{key_column, key_columns};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::runs::{Measured, PLACES, distinct};

/// Significant digits of an unknown value.
const DIGITS: usize = 3;
pub(super) fn blocks(experiment: &str, rows: &[Measured]) -> Vec<Block> {
    let of = |name: &str| (name.to_owned(), spaced(name));
    let stages = distinct(rows.iter().flat_map(|measured| measured.row.seconds.keys().map(|name| of(name))));
    let values = distinct(rows.iter().flat_map(|measured| measured.row.values.keys().map(|name| of(name))));
    vec![Block::Table(table(experiment, "", rows, &stages, &values))]
}

/// As [`table`], with known names and headings.
pub(super) fn chosen(
    name: &str,
    caption: &str,
    rows: &[Measured],
    stages: &[(&str, &str)],
    values: &[(&str, &str)],
) -> Block {
    let owned = |list: &[(&str, &str)]| -> Vec<(String, String)> {
        list.iter().map(|(name, title)| ((*name).to_owned(), (*title).to_owned())).collect()
    };
    Block::Table(table(name, caption, rows, &owned(stages), &owned(values)))
}

/// Keys, medians of stages in milliseconds and values, each with its heading. Keys that are the same in all rows go to the caption.
fn table(
    name: &str,
    caption: &str,
    rows: &[Measured],
    stages: &[(String, String)],
    values: &[(String, String)],
) -> Table {
    let (keys, common) = split_keys(rows);
    let several = distinct(rows.iter().map(Measured::place)).len() > 1;
    let mut columns: Vec<Column> = Vec::new();
    if several {
        columns.push(Column::words("place", "on"));
    }
    columns.extend(keys.iter().map(|key| key_column(key, rows)));
    columns
        .extend(stages.iter().map(|(stage, title)| Column::numbers(format!("{stage} ms"), title).below("median, ms")));
    columns.extend(values.iter().map(|(value, title)| Column::numbers(value, title)));
    let mut table = Table::new(name, [caption, &common].join(" ").trim(), columns);
    for measured in rows {
        let mut cells: Vec<Cell> = Vec::new();
        if several {
            cells.push(measured.place().into());
        }
        cells.extend(keys.iter().map(|key| Cell::from(measured.text(key))));
        cells.extend(stages.iter().map(|(stage, _)| Cell::number(measured.median(stage), numbers::milliseconds)));
        cells.extend(values.iter().map(|(name, _)| Cell::number(measured.value(name), |value| figure(name, value))));
        table.rows.push(cells);
    }
    table.without_empty_columns()
}

/// Keys that differ between rows, apart from the device, and a sentence with those that do not. A device has its own
/// name.
pub(super) fn split_keys(rows: &[Measured]) -> (Vec<String>, String) {
    let same = |key: &str| rows.windows(2).all(|pair| pair[0].key(key) == pair[1].key(key));
    let keys = key_columns(rows).into_iter().filter(|key| !PLACES.contains(&key.as_str()));
    let (common, keys): (Vec<String>, Vec<String>) = keys.partition(|key| rows.len() > 1 && same(key));
    let mut common: Vec<String> =
        common.iter().map(|key| format!("{} {}", key.replace('_', " "), rows[0].text(key))).collect();
    if let [place] = &distinct(rows.iter().map(Measured::place))[..] {
        common.extend((!place.is_empty()).then(|| format!("on {place}")));
    }
    (keys, if common.is_empty() { String::new() } else { format!("All rows: {}.", common.join(", ")) })
}

fn spaced(name: &str) -> String {
    let name = name.strip_suffix("_seconds").map_or_else(|| name.to_owned(), |name| format!("{name} ms"));
    name.trim_end_matches("_bytes").replace('_', " ")
}

/// A value, formatted according to its name.
pub(super) fn figure(name: &str, value: f64) -> String {
    match name {
        _ if name.ends_with("_bytes") => numbers::bytes(value),
        _ if name.ends_with("share") => numbers::percent(value),
        _ if name.ends_with("_seconds") => numbers::milliseconds(value),
        _ if value.fract() == 0.0 => numbers::count(value),
        _ => numbers::significant(value, DIGITS),
    }
}
