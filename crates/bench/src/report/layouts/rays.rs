//! Rays per second of each structure and kind, with bars.

use super::{generic, key_column, key_columns};
use crate::report::document::{Block, Cell, Column, Table};
use crate::report::numbers;
use crate::report::runs::Measured;

/// The value shown as bars: millions of rays per second.
const RATE: &str = "million_per_second";

/// Bars are relative to the fastest on the same device.
pub(super) fn rates(rows: &[Measured]) -> Vec<Block> {
    let rate = |row: &Measured| row.value(RATE);
    if !rows.iter().any(|row| rate(row).is_some()) {
        return generic::blocks("rays", rows);
    }
    let most = |place: &str| rows.iter().filter(|row| row.place() == place).filter_map(rate).max_by(f64::total_cmp);
    let keys: Vec<String> =
        key_columns(rows).into_iter().filter(|key| !matches!(key.as_str(), "device" | "threads")).collect();
    let mut columns = vec![Column::words("place", "on")];
    columns.extend(keys.iter().map(|key| key_column(key, rows)));
    columns.push(Column::numbers("rate", "million rays per second"));
    let mut table = Table::new("rays", "Bars are relative to the highest rate on the same device.", columns);
    for row in rows {
        let mut cells: Vec<Cell> = vec![row.place().into()];
        cells.extend(keys.iter().map(|key| Cell::from(row.text(key))));
        let bar = rate(row).zip(most(&row.place())).map(|(rate, most)| rate / most);
        cells.push(Cell { bar, ..Cell::number(rate(row), |rate| numbers::significant(rate, 3)) });
        table.rows.push(cells);
    }
    vec![Block::Table(table)]
}
