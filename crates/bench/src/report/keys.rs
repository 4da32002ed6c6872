//! Columns of keys: what rows are of.

use super::document::{Cell, Column, Table};
use super::runs::{Measured, PLACES, distinct};
use crate::Key;

/// Keys in their usual order; others follow by name.
const ORDER: &str = "scene lights size frames cost with light step radius weight lookup short_tests mode method samples quality aa \
                     program rays accel device threads";

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
