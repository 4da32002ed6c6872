//! Results side by side: several result files, each a run of a suite.

use super::{experiments, numbers};
use crate::{Key, Results, Row, WHOLE};

/// Keys that say where a row was measured rather than what.
pub(crate) const PLACES: [&str; 2] = ["device", "threads"];

/// A result file.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    /// Its name in the report.
    pub(crate) label: String,
    pub(crate) results: Results,
}

/// All result files of a report.
#[derive(Clone, Debug)]
pub(crate) struct Runs(pub(crate) Vec<Run>);

/// A row and its run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured<'a> {
    pub(crate) run: &'a Run,
    pub(crate) row: &'a Row,
    /// Whether the run's name is needed to distinguish it.
    several: bool,
}

/// Access to a row by the names of [`Row::keys`], [`Row::seconds`] and [`Row::values`].
impl<'a> Measured<'a> {
    pub(crate) fn key(&self, name: &str) -> Option<&'a Key> {
        self.row.keys.get(name)
    }

    /// A key as text; empty if missing.
    pub(crate) fn text(&self, name: &str) -> String {
        match self.key(name) {
            Some(Key::Number(number)) => numbers::setting(*number),
            Some(Key::Word(word)) => word.clone(),
            None => String::new(),
        }
    }

    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        match self.key(name)? {
            Key::Number(number) => Some(*number),
            Key::Word(_) => None,
        }
    }

    pub(crate) fn is(&self, name: &str, word: &str) -> bool {
        matches!(self.key(name), Some(Key::Word(key)) if key == word)
    }

    /// Whether it was measured with occluder lists, the default method, by whichever key an experiment names it.
    pub(crate) fn is_default(&self) -> bool {
        self.row.keys.values().any(|key| matches!(key, Key::Word(word) if word == "lists" || word == "lightmesh lists"))
    }

    pub(crate) fn value(&self, name: &str) -> Option<f64> {
        self.row.values.get(name).copied()
    }

    /// Median seconds of a stage.
    pub(crate) fn median(&self, stage: &str) -> Option<f64> {
        self.row.median(stage)
    }

    /// Median seconds of the whole frame: of `render`, or of the only timed stage.
    pub(crate) fn whole(&self) -> Option<f64> {
        let seconds = &self.row.seconds;
        let only = || if seconds.len() == 1 { seconds.values().next() } else { None };
        seconds.get(WHOLE).or_else(only)?.median()
    }

    /// The device as text: the CPU with its threads, or the GPU.
    pub(crate) fn place(&self) -> String {
        let machine = &self.run.results.machine;
        let threads = match self.key("threads") {
            Some(Key::Number(1.0)) => ", 1 thread".to_owned(),
            Some(Key::Number(number)) => format!(", {number} threads"),
            Some(Key::Word(word)) if word == "all" => format!(", {} threads", machine.threads),
            _ => String::new(),
        };
        let device = match self.key("device") {
            Some(Key::Word(word)) if word == "cpu" => "CPU".to_owned(),
            Some(Key::Word(word)) if word == "cuda" => {
                machine.gpus.first().map_or_else(|| "GPU".to_owned(), |gpu| gpu.name.clone())
            }
            Some(key) => key.to_string(),
            None => String::new(),
        };
        let place = (device + &threads).trim_start_matches(", ").to_owned();
        let label = self.several.then(|| self.run.label.clone());
        label.into_iter().chain((!place.is_empty()).then_some(place)).collect::<Vec<_>>().join(": ")
    }

    /// The device, in words that are the same on every machine: `cpu all`, `cpu 1`, `cuda`.
    pub(crate) fn place_name(&self) -> String {
        let words = PLACES.iter().filter_map(|key| self.key(key)).map(ToString::to_string);
        let label = self.several.then(|| self.run.label.clone());
        label.into_iter().chain(words).collect::<Vec<_>>().join(" ")
    }

    /// All keys except those of the device and those named.
    pub(crate) fn case(&self, without: &[&str]) -> Vec<(&'a str, &'a Key)> {
        let left_out = |name: &str| PLACES.contains(&name) || without.contains(&name);
        self.row.keys.iter().map(|(name, key)| (name.as_str(), key)).filter(|(name, _)| !left_out(name)).collect()
    }
}

impl Runs {
    /// Rows of an experiment, run by run; those of the same case on several devices are neighbours.
    pub(crate) fn rows(&self, experiment: &str) -> Vec<Measured<'_>> {
        let rows: Vec<Measured> = self.all().filter(|measured| measured.row.experiment == experiment).collect();
        let cases = distinct(rows.iter().map(|measured| measured.case(&[])));
        let of =
            |case: &Vec<_>| rows.iter().filter(|measured| measured.case(&[]) == *case).copied().collect::<Vec<_>>();
        cases.iter().flat_map(of).collect()
    }

    /// All rows, run by run.
    pub(crate) fn all(&self) -> impl Iterator<Item = Measured<'_>> {
        let several = self.0.len() > 1;
        self.0.iter().flat_map(move |run| run.results.rows.iter().map(move |row| Measured { run, row, several }))
    }

    /// Names of experiments with rows or images, in the order of a report.
    pub(crate) fn experiments(&self) -> Vec<&str> {
        let rows = self.all().map(|measured| measured.row.experiment.as_str());
        let pictures = self.0.iter().flat_map(|run| &run.results.pictures).map(|picture| picture.experiment.as_str());
        let mut experiments = distinct(rows.chain(pictures));
        experiments.sort_by_key(|experiment| experiments::place(experiment));
        experiments
    }
}

/// Each value once, in order of appearance.
pub(crate) fn distinct<T: PartialEq>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}
