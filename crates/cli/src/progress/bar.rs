//! A progress bar for all that is rendered, with the stage in progress.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lightmesh::Stage;
use lightmesh::render::Progress;

use crate::output;

/// What the bar counts to.
const LENGTH: u64 = 1000;

/// A bar on standard error, removed when dropped.
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new() -> Bar {
        let bar = ProgressBar::with_draw_target(Some(LENGTH), ProgressDrawTarget::stderr());
        // If the template is invalid, the library's default remains.
        if let Ok(style) = ProgressStyle::with_template("{msg:16} {bar:40} {percent:>3}%{prefix}") {
            bar.set_style(style);
        }
        Bar(bar)
    }

    pub(super) fn begin(&self, stage: Stage) {
        self.0.set_message(stage.name().replace('_', " "));
    }

    /// Shows how much is done, and the estimated remaining time.
    pub(super) fn whole(&self, progress: Progress) {
        let left = progress.left.map_or_else(String::new, |left| format!(", {left:.0} s left"));
        self.0.set_prefix(left);
        self.0.set_position((LENGTH as f64 * progress.done) as u64);
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
