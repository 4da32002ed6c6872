//! What is asked of a suite.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use lightmesh::Device;

use crate::BenchError;

/// A suite of experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suite {
    /// Every table and figure of the thesis.
    Thesis,
    /// Errors against a converged reference, and what they cost.
    Quality,
    /// Rays per second of each acceleration structure.
    Rays,
}

impl Suite {
    /// All of them.
    pub const ALL: [Suite; 3] = [Suite::Thesis, Suite::Quality, Suite::Rays];

    /// The word on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Suite::Thesis => "thesis",
            Suite::Quality => "quality",
            Suite::Rays => "rays",
        }
    }

    /// What it measures, in a line.
    pub fn summary(self) -> &'static str {
        match self {
            Suite::Thesis => "every table and figure of the thesis: seconds, light points, break-even, pictures",
            Suite::Quality => "errors against converged area shadows, and what equal errors cost by shadow rays",
            Suite::Rays => "primary, shadow and short rays per second with BVH and grid, on any scene",
        }
    }
}

impl fmt::Display for Suite {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Suite {
    type Err = BenchError;

    fn from_str(word: &str) -> Result<Suite, BenchError> {
        let suite = Suite::ALL.into_iter().find(|suite| suite.name() == word);
        suite.ok_or_else(|| BenchError::UnknownSuite(word.to_owned()))
    }
}

/// How a suite is run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The short form: fewer and smaller pictures.
    pub quick: bool,
    /// Time for all of it. Repetitions are cut to fit, then rows are left out.
    pub budget: Duration,
    /// Where to compute; [`Device::Auto`] is the processor and, where one works, a GPU.
    pub device: Device,
    /// Threads on the processor; `None`: one for each that it runs at once.
    pub threads: Option<usize>,
    /// Repetitions that count, at the least, where the budget allows.
    pub repetitions: usize,
    /// What sides of pictures are divided by; 1 but in tests of the suites themselves.
    pub shrink: u32,
    /// Scenes to measure in place of the suite's own, where it can.
    pub scenes: Vec<PathBuf>,
    /// The command line, for the results.
    pub command: String,
}

impl Plan {
    /// Repetitions that a median needs to be worth its name.
    pub const REPETITIONS: usize = 5;
    /// Time for a suite.
    pub const BUDGET: Duration = Duration::from_secs(15 * 60);
    /// Time for the short form of a suite.
    pub const QUICK_BUDGET: Duration = Duration::from_secs(150);
    /// The smallest side that a picture is shrunk to, in pixels.
    const SMALLEST_SIDE: u32 = 8;

    /// The usual run of a suite, or its short form, on all that there is.
    pub fn new(quick: bool) -> Plan {
        Plan {
            quick,
            budget: if quick { Plan::QUICK_BUDGET } else { Plan::BUDGET },
            device: Device::Auto,
            threads: None,
            repetitions: Plan::REPETITIONS,
            shrink: 1,
            scenes: Vec::new(),
            command: String::new(),
        }
    }

    /// Pixels of a side that the suite wants to have `side` pixels.
    pub fn side(&self, side: u32) -> u32 {
        (side / self.shrink.max(1)).max(Plan::SMALLEST_SIDE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suites_are_known_by_their_names() {
        for suite in Suite::ALL {
            assert_eq!(suite.to_string().parse::<Suite>().unwrap(), suite);
        }
        assert!(matches!("speed".parse::<Suite>(), Err(BenchError::UnknownSuite(word)) if word == "speed"));
    }
}
