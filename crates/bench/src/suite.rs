//! The suites of experiments.

use std::fmt;

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
