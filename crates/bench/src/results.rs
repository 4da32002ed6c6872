//! Results of a suite: the JSON written by `lightmesh bench --json`. Images are separate files.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// All results of a run of a suite, and where it ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Format version: [`Results::VERSION`].
    pub version: u32,
    /// The suite's name.
    pub suite: String,
    /// Whether it was the short version of the suite.
    pub quick: bool,
    /// The program.
    pub program: Program,
    /// The machine.
    pub machine: Machine,
    /// Start time: UTC, as in 2026-01-31T12:00:00Z.
    pub started: String,
    /// Total time in seconds.
    pub seconds: f64,
    /// One row per measurement.
    pub rows: Vec<Row>,
    /// Images that belong to the rows, if they were saved.
    #[serde(default)]
    pub pictures: Vec<Picture>,
    /// What was omitted and why; a sentence each.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// The program that ran a suite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// Its name: lightmesh, or that of a peer.
    pub name: String,
    /// Its version.
    pub version: String,
    /// The commit from which it was built, if known.
    pub commit: Option<String>,
    /// The command line.
    pub command: String,
}

/// The machine that a suite ran on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Name of the CPU.
    pub cpu: String,
    /// Hardware threads.
    pub threads: usize,
    /// Main memory, in bytes.
    pub memory_bytes: u64,
    /// The operating system.
    pub os: String,
    /// GPUs that were used.
    pub gpus: Vec<Gpu>,
}

/// A GPU.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gpu {
    /// Its name.
    pub name: String,
    /// Its memory, in bytes.
    pub memory_bytes: u64,
    /// CUDA version of its driver, as in "CUDA 13.0".
    pub driver: String,
}

/// A measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Unique id within the suite, the same in every run: experiment and keys.
    pub id: String,
    /// The table or figure to which it belongs.
    pub experiment: String,
    /// The parameters: scene, size, step, radius, mode, device and so on.
    pub keys: BTreeMap<String, Key>,
    /// Seconds of each stage (named as in `--stats`) for every counted repetition.
    #[serde(default)]
    pub seconds: BTreeMap<String, Samples>,
    /// Counts, errors and other values by name.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
}

/// Digits of a sample: runs differ in the second or third, and a file with thousands of samples stays small.
const SAMPLE_DIGITS: usize = 5;
/// Digits of a value in a file: of numbers with more than 15, or far below 1, the JSON reader may change the last one.
const VALUE_DIGITS: usize = 12;

/// The stage that stands for the whole frame.
pub(crate) const WHOLE: &str = "render";

/// The experiment that measures stages.
pub(crate) const STAGES: &str = "stages";

/// The experiment that compares ways to compute shadows.
pub(crate) const SHADOWS: &str = "shadows";

/// The experiment that compares defaults.
pub(crate) const WHOLE_FRAMES: &str = "whole frames";

/// The experiment on a flight with gathered light.
pub(crate) const FLIGHT: &str = "flight";

/// The experiment on flicker of shadows.
pub(crate) const FLICKER: &str = "flicker";

/// The experiment on what films keep.
pub(crate) const FILM: &str = "film";

/// The experiment on what light costs.
pub(crate) const LIGHT: &str = "light";

/// The experiment on samples of pixels.
pub(crate) const ANTIALIASING: &str = "antialiasing";

/// The experiment that adds lights.
pub(crate) const MANY_LIGHTS: &str = "many lights";

/// A setting: a number or a word.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Key {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

/// Repeated measurements of the same quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Samples(pub Vec<f64>);

/// An image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Unique id within the suite.
    pub id: String,
    /// The table or figure to which it belongs.
    pub experiment: String,
    /// What it shows.
    pub title: String,
    /// The id of its reference image.
    #[serde(default)]
    pub reference: Option<String>,
    /// Its PNG file, relative to the result file; empty if it has none yet.
    pub file: String,
    /// The content of that file.
    #[serde(skip)]
    pub png: Vec<u8>,
}

impl Results {
    /// The current format version.
    pub const VERSION: u32 = 1;

    /// The same with values of so few digits that they are read back as they are written.
    pub(crate) fn with_rounded_values(mut self) -> Results {
        let values = self.rows.iter_mut().flat_map(|row| row.values.values_mut());
        values.for_each(|value| *value = rounded(*value, VALUE_DIGITS));
        self
    }
}

impl Row {
    /// A row without results; its id is derived from its experiment and keys.
    pub fn new(experiment: &str, keys: impl IntoIterator<Item = (&'static str, Key)>) -> Row {
        let keys: BTreeMap<String, Key> = keys.into_iter().map(|(name, key)| (name.to_owned(), key)).collect();
        let words: Vec<String> = keys.iter().map(|(name, key)| format!("{name}={key}")).collect();
        let id = format!("{experiment}: {}", words.join(" "));
        Row { id, experiment: experiment.to_owned(), keys, seconds: BTreeMap::new(), values: BTreeMap::new() }
    }

    /// Median seconds of a stage; `None` if it was not measured.
    pub fn median(&self, stage: &str) -> Option<f64> {
        self.seconds.get(stage)?.median()
    }
}

impl From<f64> for Key {
    fn from(number: f64) -> Key {
        Key::Number(number)
    }
}

impl From<f32> for Key {
    /// With the fewest digits that identify the `f32`: 2.1, not 2.0999999.
    fn from(number: f32) -> Key {
        Key::Number(number.to_string().parse().unwrap_or(f64::from(number)))
    }
}

impl From<&str> for Key {
    fn from(word: &str) -> Key {
        Key::Word(word.to_owned())
    }
}

impl std::fmt::Display for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Key::Number(number) => write!(f, "{number}"),
            Key::Word(word) => f.write_str(word),
        }
    }
}

/// A number with `digits` significant digits.
fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits - 1).parse().unwrap_or(number)
}

impl Samples {
    /// Adds a sample in seconds, rounded to the precision of clocks.
    pub fn push(&mut self, seconds: f64) {
        self.0.push(rounded(seconds, SAMPLE_DIGITS));
    }

    /// The minimum; `None` if there are no samples.
    pub fn min(&self) -> Option<f64> {
        self.0.iter().copied().min_by(f64::total_cmp)
    }

    /// The median; `None` if there are no samples.
    pub fn median(&self) -> Option<f64> {
        self.quantile(0.5)
    }

    /// The quantile `q`, interpolated linearly between samples; `None` if there are no samples.
    pub fn quantile(&self, q: f64) -> Option<f64> {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let place = q.clamp(0.0, 1.0) * sorted.len().checked_sub(1)? as f64;
        let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
        Some(low + (high - low) * place.fract())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_samples() {
        let samples = Samples(vec![4.0, 1.0, 2.0, 3.0]);
        assert_eq!((samples.min(), samples.median()), (Some(1.0), Some(2.5)));
        assert_eq!((samples.quantile(0.0), samples.quantile(1.0)), (Some(1.0), Some(4.0)));
        assert_eq!((Samples::default().min(), Samples::default().median()), (None, None));
    }

    #[test]
    fn samples_have_the_digits_that_mean_something() {
        let mut samples = Samples::default();
        [0.000_133_983_999_490_737_93, 12.345_678, 0.0].into_iter().for_each(|seconds| samples.push(seconds));
        assert_eq!(samples, Samples(vec![0.000_133_98, 12.346, 0.0]));
    }

    #[test]
    fn a_row_is_named_after_what_was_done() {
        let row = Row::new("table 2", [("step", 0.1.into()), ("scene", "garden".into())]);
        assert_eq!(row.id, "table 2: scene=garden step=0.1");
        let json = serde_json::to_string(&row).unwrap();
        assert_eq!(serde_json::from_str::<Row>(&json).unwrap(), row);
    }
}
