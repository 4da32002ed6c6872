//! Results as text for a terminal: rows by experiment, then notes.

use std::fmt;

use lightmesh_files::visible;

use crate::measure::stage_names;
use crate::{Results, Row, STAGES, Samples, WHOLE};

/// Number of values shown for rows without timings.
const SHOWN_VALUES: usize = 4;

impl fmt::Display for Results {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut experiment = "";
        for row in &self.rows {
            if row.experiment != experiment {
                experiment = &row.experiment;
                writeln!(f, "{}", visible(experiment))?;
            }
            writeln!(f, "  {}", visible(&line(row)))?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "note: {}", visible(note)))
    }
}

/// The row's keys and values.
fn line(row: &Row) -> String {
    let keys: Vec<String> = row.keys.iter().map(|(name, key)| format!("{name}={key}")).collect();
    let figures = if row.experiment == STAGES { stages(row) } else { whole(row) };
    format!("{}: {figures}", keys.join(" "))
}

/// Median milliseconds of each stage.
fn stages(row: &Row) -> String {
    let medians = stage_names().filter_map(|stage| Some((stage, 1e3 * row.median(stage)?)));
    medians.map(|(stage, median)| format!("{stage} {median:.2}")).collect::<Vec<_>>().join(", ") + " ms"
}

/// Minimum, median and number of renders, or the row's first values.
fn whole(row: &Row) -> String {
    match row.seconds.get(WHOLE).and_then(|samples| Some((samples, samples.min()?, samples.median()?))) {
        Some((Samples(samples), min, median)) => format!("{min:.4} s min, {median:.4} s median of {}", samples.len()),
        None => {
            let values = row.values.iter().take(SHOWN_VALUES);
            values.map(|(name, value)| format!("{name} {}", figure(*value))).collect::<Vec<_>>().join(", ")
        }
    }
}

/// Four significant digits.
fn figure(value: f64) -> String {
    match value.abs() {
        size if size > 0.0 && size < 1e-2 => format!("{value:.3e}"),
        size if size >= 1000.0 => format!("{value:.0}"),
        _ => format!("{value:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_a_line() {
        let mut row = Row::new("table", [("scene", "garden".into())]);
        row.values.extend([("a".to_owned(), 1.5e-7), ("b".to_owned(), 510_000.0), ("c".to_owned(), 0.25)]);
        assert_eq!(line(&row), "scene=garden: a 1.500e-7, b 510000, c 0.2500");
        row.seconds.insert("render".to_owned(), Samples(vec![2.0, 1.0, 4.0]));
        assert_eq!(line(&row), "scene=garden: 1.0000 s min, 2.0000 s median of 3");
        row.experiment = STAGES.to_owned();
        row.seconds.insert("shade".to_owned(), Samples(vec![0.001_234]));
        assert_eq!(line(&row), "scene=garden: shade 1.23, render 2000.00 ms");
    }
}
