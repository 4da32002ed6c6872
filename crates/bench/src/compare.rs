//! Is a run of a suite significantly slower than an earlier one?
//!
//! Rows are matched by id. For each stage present in both, `ratio` is the median of the later samples over that of the earlier
//! ones. It is compared with the *noise band*
//!
//! ```text
//! band = max(5 %, 2 · √(s_old² + s_new²)),   s = (Q3 − Q1) / median
//! ```
//!
//! from the interquartile ranges of both: half of the samples lie within Q1…Q3, and a few outliers do not move it. Fewer than 3
//! samples give no meaningful spread; s is then taken as 15 %. A stage is slower above 1 + band and faster below 1 / (1 + band).
//!
//! A row is judged by its stage `render`, the whole frame, or by all stages if one of the runs has none or if the suite is
//! `stages`. Stages shorter than 0.1 ms are not judged: clocks and launches vary as much. Differences between two machines cannot
//! be distinguished from changes of the program.

use std::fmt;

use lightmesh_files::visible;

use serde::Serialize;

use crate::{Results, Row, STAGES, Samples, WHOLE};

/// Minimum relative noise.
const MIN_BAND: f64 = 0.05;
/// Half-width of the noise band in spreads of the difference.
const SPREADS: f64 = 2.0;
/// Minimum number of samples for a spread.
const ENOUGH_SAMPLES: usize = 3;
/// Relative spread assumed for fewer samples.
const UNKNOWN_SPREAD: f64 = 0.15;
/// Stages shorter than this, in seconds, are not judged.
const MIN_SECONDS: f64 = 1e-4;

/// A comparison of two runs of a suite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunComparison {
    /// Every stage of every row present in both.
    pub stages: Vec<StageComparison>,
    /// Ids of rows only in the earlier run.
    pub only_old: Vec<String>,
    /// Ids of rows only in the later run.
    pub only_new: Vec<String>,
    /// Whether both machines have the same description.
    pub same_machine: bool,
    /// Number of judged stages that are slower.
    pub regressions: usize,
}

/// A stage of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StageComparison {
    /// The row's id.
    pub id: String,
    /// The stage, named as in `--stats`.
    pub stage: String,
    /// Median seconds of the earlier run.
    pub old: f64,
    /// Median seconds of the later run.
    pub new: f64,
    /// new / old.
    pub ratio: f64,
    /// Relative noise of both.
    pub band: f64,
    /// The verdict on the ratio.
    pub verdict: Verdict,
    /// Whether the row is judged by this stage.
    pub judged: bool,
}

/// The verdict on a ratio.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within the noise.
    Same,
    /// Less time than the noise explains.
    Faster,
    /// More time than the noise explains.
    Slower,
}

impl RunComparison {
    /// Compares `new` with `old`.
    pub fn new(old: &Results, new: &Results) -> RunComparison {
        let find = |rows: &'_ [Row], id: &str| rows.iter().position(|row| row.id == id);
        let pairs = old.rows.iter().filter_map(|row| Some((row, &new.rows[find(&new.rows, &row.id)?])));
        let stages: Vec<StageComparison> = pairs.flat_map(|(old, new)| compare_rows(old, new)).collect();
        let only = |rows: &[Row], others: &[Row]| {
            rows.iter().filter(|row| find(others, &row.id).is_none()).map(|row| row.id.clone()).collect()
        };
        RunComparison {
            regressions: stages.iter().filter(|stage| stage.is_regression()).count(),
            stages,
            only_old: only(&old.rows, &new.rows),
            only_new: only(&new.rows, &old.rows),
            same_machine: old.machine == new.machine,
        }
    }
}

impl StageComparison {
    /// Whether it makes the row slower.
    pub fn is_regression(&self) -> bool {
        self.judged && self.verdict == Verdict::Slower
    }
}

/// All stages present in both rows.
fn compare_rows(old: &Row, new: &Row) -> Vec<StageComparison> {
    let whole = old.experiment != STAGES && old.seconds.contains_key(WHOLE) && new.seconds.contains_key(WHOLE);
    let both = old.seconds.iter().filter_map(|(stage, samples)| Some((stage, samples, new.seconds.get(stage)?)));
    let compared = both.filter_map(|(stage, old_samples, new_samples)| {
        let (before, after) = (old_samples.median()?, new_samples.median()?);
        let (ratio, band) = (after / before, band(old_samples, new_samples));
        let measurable = before.max(after) >= MIN_SECONDS;
        (ratio.is_finite() && before > 0.0).then(|| StageComparison {
            id: old.id.clone(),
            stage: stage.clone(),
            old: before,
            new: after,
            ratio,
            band,
            verdict: Verdict::of(ratio, band),
            judged: measurable && (!whole || stage == WHOLE),
        })
    });
    compared.collect()
}

impl Verdict {
    fn of(ratio: f64, band: f64) -> Verdict {
        match ratio {
            ratio if ratio > 1.0 + band => Verdict::Slower,
            ratio if ratio < 1.0 / (1.0 + band) => Verdict::Faster,
            _ => Verdict::Same,
        }
    }

    /// The word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Faster => "faster",
            Verdict::Slower => "slower",
        }
    }
}

/// The relative noise of the ratio of two medians.
fn band(old: &Samples, new: &Samples) -> f64 {
    MIN_BAND.max(SPREADS * spread(old).hypot(spread(new)))
}

/// The interquartile range over the median.
fn spread(samples: &Samples) -> f64 {
    let quartiles = (samples.quantile(0.25), samples.median(), samples.quantile(0.75));
    match quartiles {
        (Some(low), Some(median), Some(high)) if samples.0.len() >= ENOUGH_SAMPLES && median > 0.0 => {
            (high - low) / median
        }
        _ => UNKNOWN_SPREAD,
    }
}

impl fmt::Display for RunComparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{:>10} {:>10} {:>7} {:>6}  {:7} row", "old s", "new s", "ratio", "band", "verdict")?;
        // All judged stages; other stages of a row if they explain why it is slower.
        let slower: Vec<&str> =
            self.stages.iter().filter(|stage| stage.is_regression()).map(|stage| stage.id.as_str()).collect();
        let shown = |stage: &&StageComparison| {
            stage.judged || (stage.verdict == Verdict::Slower && slower.contains(&stage.id.as_str()))
        };
        for stage in self.stages.iter().filter(shown) {
            let StageComparison { id, stage: name, old, new, ratio, band, verdict, judged } = stage;
            let (band, verdict) = (format!("{:.0}%", 100.0 * band), verdict.name());
            let (id, name) = (visible(id), visible(name));
            let remark = if *judged { "" } else { " (not judged)" };
            writeln!(f, "{old:10.4} {new:10.4} {ratio:7.3} {band:>6}  {verdict:7} {id} [{name}]{remark}")?;
        }
        for (which, ids) in [("old", &self.only_old), ("new", &self.only_new)] {
            if !ids.is_empty() {
                writeln!(f, "{} rows are only in the {which} results", ids.len())?;
            }
        }
        if !self.same_machine {
            writeln!(f, "the machines differ: ratios reflect the machines as much as the program")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
