//! Flag values that are chosen from a list of the program's own.

use clap::ValueEnum;

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Progress {
    /// A bar on a terminal, elsewhere a line every ten seconds; nothing with --quiet
    Auto,
    /// As auto, also with --quiet
    Bar,
    /// One JSON object per line
    Json,
    /// Nothing
    None,
}
