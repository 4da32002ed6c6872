//! A bar that shows one stage after the other.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lightmesh::Stage;

use crate::output;

/// A bar on standard error; it is gone when it is dropped.
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new() -> Bar {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        // A template that cannot be read leaves the library's own.
        if let Ok(style) = ProgressStyle::with_template("{msg:12} {bar:40} {percent:>3}%  {elapsed}") {
            bar.set_style(style);
        }
        Bar(bar)
    }

    pub(super) fn begin(&self, stage: Stage, total: u64) {
        self.0.reset();
        self.0.set_length(total);
        self.0.set_message(stage.name().replace('_', " "));
    }

    /// Cheap: counts, and draws at most 20 times a second.
    pub(super) fn advance(&self, pieces: u64) {
        self.0.inc(pieces);
    }

    /// Prints a line above the bar.
    pub(super) fn aside(&self, line: &str) {
        self.0.suspend(|| output::complain(line));
    }

    pub(super) fn close(&self) {
        self.0.finish_and_clear();
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.close();
    }
}
