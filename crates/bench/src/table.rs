//! Results as text for a terminal: rows by experiment, then notes.

use std::fmt;

use crate::{Results, Row, Samples, WHOLE};

/// Values that are shown where a row took no time.
const SHOWN_VALUES: usize = 4;

impl fmt::Display for Results {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut experiment = "";
        for row in &self.rows {
            if row.experiment != experiment {
                experiment = &row.experiment;
                writeln!(f, "{experiment}")?;
            }
            writeln!(f, "  {}", line(row))?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "note: {note}"))
    }
}

/// The row's keys; then minimum, median and number of renders, or else its first values.
fn line(row: &Row) -> String {
    let keys: Vec<String> = row.keys.iter().map(|(name, key)| format!("{name}={key}")).collect();
    let keys = keys.join(" ");
    let figures = match row.seconds.get(WHOLE).and_then(|samples| Some((samples, samples.min()?, samples.median()?))) {
        Some((Samples(samples), min, median)) => format!("{min:.4} s min, {median:.4} s median of {}", samples.len()),
        None => {
            let values = row.values.iter().take(SHOWN_VALUES);
            values.map(|(name, value)| format!("{name} {}", figure(*value))).collect::<Vec<_>>().join(", ")
        }
    };
    format!("{keys}: {figures}")
}

/// Four digits that tell something.
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
    }
}
