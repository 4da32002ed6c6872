//! Flag values that are chosen from a list of the program's own.

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Which frames a task of a job may render.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Chunks {
    /// Any frames
    Noncontiguous,
    /// Frames without gaps between them: every second one is a task of its own
    Contiguous,
}

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
pub(crate) enum Progress {
    /// A bar on a terminal, elsewhere a line every ten seconds; nothing with --quiet
    Auto,
    /// As auto, also with --quiet
    Bar,
    /// One JSON object per line
    Json,
    /// Lines for Open Job Description: the part that is done, frames, failures
    Openjd,
    /// Nothing
    None,
}
