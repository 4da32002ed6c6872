//! What a suite found: the JSON that `lightmesh bench --json` writes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Everything that one run of a suite found, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Of this format: [`Results::VERSION`].
    pub version: u32,
    /// The suite's name.
    pub suite: String,
    /// Whether it was the short form of the suite.
    pub quick: bool,
    /// What ran.
    pub program: Program,
    /// Where it ran.
    pub machine: Machine,
    /// When it began: UTC, as in 2026-01-31T12:00:00Z.
    pub started: String,
    /// How long all of it took, in seconds.
    pub seconds: f64,
    /// One row for each thing that was measured.
    pub rows: Vec<Row>,
    /// Pictures that go with the rows.
    #[serde(default)]
    pub pictures: Vec<Picture>,
    /// What was left out and why; a sentence each.
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
    /// The commit that it was built from, where that is known.
    pub commit: Option<String>,
    /// The command that ran the suite.
    pub command: String,
}

/// The machine that a suite ran on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Threads that it runs at once.
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
    /// What its driver is for, as in "CUDA 13.0".
    pub driver: String,
}

/// One thing that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What tells it from all other rows of the suite, the same in every run: its experiment and keys.
    pub id: String,
    /// The table or figure that it belongs to.
    pub experiment: String,
    /// What was done: scene, size, step, radius, mode, device and so on.
    pub keys: BTreeMap<String, Key>,
    /// Seconds of each stage (named as in `--stats`), of every repetition that counts.
    #[serde(default)]
    pub seconds: BTreeMap<String, Samples>,
    /// Counts, errors and other figures by name.
    #[serde(default)]
    pub values: BTreeMap<String, f64>,
}

/// The stage that is the whole of a picture.
pub(crate) const WHOLE: &str = "render";

/// A setting: a number or a word.
#[derive(Clone, Debug, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Key {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

/// The same thing, measured several times.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Samples(pub Vec<f64>);

/// A picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// What tells it from all other pictures of the suite.
    pub id: String,
    /// The table or figure that it belongs to.
    pub experiment: String,
    /// What it shows.
    pub title: String,
    /// The id of the picture to hold it against.
    #[serde(default)]
    pub reference: Option<String>,
    /// A PNG file in Base64.
    pub png: String,
}

impl Results {
    /// Version of the format that is written.
    pub const VERSION: u32 = 1;
}

impl Row {
    /// A row without results: its id is made from its experiment and keys.
    pub fn new(experiment: &str, keys: impl IntoIterator<Item = (&'static str, Key)>) -> Row {
        let keys: BTreeMap<String, Key> = keys.into_iter().map(|(name, key)| (name.to_owned(), key)).collect();
        let words: Vec<String> = keys.iter().map(|(name, key)| format!("{name}={key}")).collect();
        let id = format!("{experiment}: {}", words.join(" "));
        Row { id, experiment: experiment.to_owned(), keys, seconds: BTreeMap::new(), values: BTreeMap::new() }
    }

    /// Median seconds of a stage; `None` where it was not measured.
    pub fn median(&self, stage: &str) -> Option<f64> {
        self.seconds.get(stage)?.median()
    }
}

impl From<f64> for Key {
    fn from(number: f64) -> Key {
        Key::Number(number)
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

impl Samples {
    /// The least; `None` without any.
    pub fn min(&self) -> Option<f64> {
        self.0.iter().copied().min_by(f64::total_cmp)
    }

    /// The middle one, or the mean of both; `None` without any.
    pub fn median(&self) -> Option<f64> {
        self.quantile(0.5)
    }

    /// The value that a share `q` of the samples does not exceed, linear between samples; `None` without any.
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
    fn a_row_is_named_after_what_was_done() {
        let row = Row::new("table 2", [("step", 0.1.into()), ("scene", "garden".into())]);
        assert_eq!(row.id, "table 2: scene=garden step=0.1");
        let json = serde_json::to_string(&row).unwrap();
        assert_eq!(serde_json::from_str::<Row>(&json).unwrap(), row);
    }
}
