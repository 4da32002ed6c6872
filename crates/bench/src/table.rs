//! Results as text for a terminal: rows by experiment, then notes.

use std::fmt;

use crate::{Results, Row, Samples};

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
    let figures = match row.seconds.get("render").and_then(|samples| Some((samples, samples.min()?, samples.median()?)))
    {
        Some((Samples(samples), min, median)) => format!("{min:.4} s min, {median:.4} s median of {}", samples.len()),
        None => {
            let values = row.values.iter().take(SHOWN_VALUES);
            values.map(|(name, value)| format!("{name} {value:.4}")).collect::<Vec<_>>().join(", ")
        }
    };
    format!("{keys}: {figures}")
}
