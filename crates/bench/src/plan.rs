//! The parameters of a run.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use lightmesh::Device;
use lightmesh::scene::CreaseAngle;

use crate::BenchError;

/// A suite of experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Suite {
    /// All tables and figures of the thesis.
    Thesis,
    /// Errors relative to a converged reference, and their cost.
    Quality,
    /// Rays per second of each acceleration structure.
    Rays,
    /// Shadows of lights with a size: occluder lists and their rivals.
    Shadows,
    /// Seconds of each stage, by acceleration structure and kind of short tests.
    Stages,
    /// Several samples of a pixel: time and errors.
    Antialiasing,
    /// A film: flicker of gathered light and of soft shadows, and what is kept from frame to frame.
    Flight,
    /// What cut-outs, mirrors, gathered light and lamps cost.
    Light,
    /// A film: what is gained by keeping what frames have in common.
    Film,
}

impl Suite {
    /// All of them.
    pub const ALL: [Suite; 9] = [
        Suite::Thesis,
        Suite::Quality,
        Suite::Rays,
        Suite::Shadows,
        Suite::Stages,
        Suite::Antialiasing,
        Suite::Flight,
        Suite::Light,
        Suite::Film,
    ];

    /// The name on the command line and in results.
    pub fn name(self) -> &'static str {
        match self {
            Suite::Thesis => "thesis",
            Suite::Quality => "quality",
            Suite::Rays => "rays",
            Suite::Shadows => "shadows",
            Suite::Stages => "stages",
            Suite::Antialiasing => "antialiasing",
            Suite::Flight => "flight",
            Suite::Light => "light",
            Suite::Film => "film",
        }
    }

    /// What it measures, in one line.
    pub fn summary(self) -> &'static str {
        match self {
            Suite::Thesis => "all tables and figures of the thesis: timings, light points, break-even, images",
            Suite::Quality => "errors relative to converged area shadows, and the cost of shadow rays with equal error",
            Suite::Rays => "primary, shadow and short rays per second with BVH and grid, on any scene",
            Suite::Shadows => {
                "seconds and errors of the shadows of lights with a size, by occluder lists and their rivals, on any scene"
            }
            Suite::Stages => {
                "seconds of each stage by acceleration structure, kind of short tests and radius, on any scene"
            }
            Suite::Antialiasing => {
                "time and errors of several samples of a pixel, against a converged image, on any scene"
            }
            Suite::Flight => {
                "flicker of a film with gathered light and soft shadows, and time that kept light saves, on any scene"
            }
            Suite::Light => "the cost of cut-outs, mirrors, gathered light and a thousand lamps, on any scene",
            Suite::Film => "time that films save by keeping data from frame to frame, on any scene",
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
