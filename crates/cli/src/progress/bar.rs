//! A progress bar for one stage after another, with the progress of the whole image next to it.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use lightmesh::Stage;
use lightmesh::render::Progress;

use crate::output;

/// A bar on standard error, removed when dropped.
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new() -> Bar {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr());
        // If the template is invalid, the library's default remains.
        if let Ok(style) = ProgressStyle::with_template("{msg:12} {bar:40} {percent:>3}%  {prefix}") {
            bar.set_style(style);
        }
        Bar(bar)
    }

    pub(super) fn begin(&self, stage: Stage, total: u64) {
        self.0.reset();
        self.0.set_length(total);
        self.0.set_message(stage.name().replace('_', " "));
    }

    /// Cheap: counts, and draws at most 20 times per second.
    pub(super) fn advance(&self, pieces: u64) {
        self.0.inc(pieces);
    }

    /// Shows the progress of the whole image, and the estimated remaining time.
    pub(super) fn whole(&self, progress: Progress) {
        let percent = (100.0 * progress.done).floor();
        let left = progress.left.map_or_else(String::new, |left| format!(", {left:.0} s left"));
        self.0.set_prefix(format!("image {percent}%{left}"));
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
