//! The parameters of a run.

use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use lightmesh::Device;
use lightmesh::scene::CreaseAngle;

use crate::{BenchError, Suite};

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
    /// The short version: fewer and smaller images.
    pub quick: bool,
    /// Time budget. To fit, repetitions are reduced, then rows are dropped.
    pub budget: Duration,
    /// The device; [`Device::Auto`] is the CPU and, if one works, a GPU.
    pub device: Device,
    /// CPU threads; `None`: all hardware threads.
    pub threads: Option<usize>,
    /// Minimum number of counted repetitions, if the budget allows.
    pub repetitions: usize,
    /// Pixels along a side instead of the suite's own, if it accepts any.
    pub size: Option<u32>,
    /// Frames of a film instead of the suite's own, if it has any.
    pub frames: Option<u32>,
    /// Divisor of image sizes; 1 except in tests of the suites themselves.
    pub shrink: u32,
    /// Scenes to measure instead of the suite's own, if it accepts any.
    pub scenes: Vec<PathBuf>,
    /// The crease angle of scenes without normals; `None`: they are flat.
    pub smooth: Option<CreaseAngle>,
    /// The command line, to be recorded in the results.
    pub command: String,
}

impl Plan {
    /// Repetitions for a meaningful median.
    pub const REPETITIONS: usize = 5;
    /// Time budget of a suite.
    pub const BUDGET: Duration = Duration::from_secs(15 * 60);
    /// Time budget of the short version of a suite.
    pub const QUICK_BUDGET: Duration = Duration::from_secs(150);
    /// Minimum side of a reduced image, in pixels.
    const SMALLEST_SIDE: u32 = 8;

    /// The usual run of a suite, or its short version, on all devices.
    pub fn new(quick: bool) -> Plan {
        Plan {
            quick,
            budget: if quick { Plan::QUICK_BUDGET } else { Plan::BUDGET },
            device: Device::Auto,
            threads: None,
            repetitions: Plan::REPETITIONS,
            size: None,
            frames: None,
            shrink: 1,
            scenes: Vec::new(),
            smooth: None,
            command: String::new(),
        }
    }

    /// Pixels along a side: as requested, or else those of the suite, in its long and its short version.
    pub(crate) fn side_or(&self, sides: [u32; 2]) -> u32 {
        self.side(self.size.unwrap_or(sides[usize::from(self.quick)]))
    }

    /// Pixels along a side for which the suite specifies `side` pixels.
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
