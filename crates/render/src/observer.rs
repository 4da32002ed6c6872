//! Observing a render: progress, timing, automatic choices, and cancellation.

use crate::settings::Setting;
use crate::stage::Stage;

/// How far a render has progressed, over all of its stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// The part of the work that is done, 0 to 1; it never falls.
    pub done: f64,
    /// Seconds since the render was started.
    pub seconds: f64,
    /// Estimated seconds remaining; unknown at the very beginning.
    pub left: Option<f64>,
}

impl Progress {
    /// The same as progress of a whole that was started `seconds` before, of which this is the part between two shares. The parts before it say that
    /// the whole takes `others` seconds, if there are any.
    pub fn of_whole(self, [before, after]: [f64; 2], others: Option<f64>, seconds: f64) -> Progress {
        let part = (after - before).max(f64::MIN_POSITIVE);
        let left = self.left.map(|left| {
            let own = (self.seconds + left) / part;
            let others = others.unwrap_or(own);
            // By the others, and the more by this part the more of it is done, which counts as much as one of them.
            let (known, done) = (before / part, self.done.max(1e-3));
            let left = done * left + (1.0 - done) * (others * part - self.seconds).max(0.0);
            left + (1.0 - after) * (known * others + done * own) / (known + done)
        });
        Progress { done: before + part * self.done, seconds, left }
    }
}

/// An observer of a render. Called from many threads.
pub trait Observer: Sync {
    /// A stage begins that has `total` pieces of work. Before it ends, [`advance`](Observer::advance) has reported as many.
    fn begin(&self, stage: Stage, total: u64) {
        let _ = (stage, total);
    }

    /// `pieces` more pieces of the current stage are done.
    fn advance(&self, pieces: u64) {
        let _ = pieces;
    }

    /// The progress of the whole render. Called now and then, after pieces of work, and at the end.
    fn progress(&self, progress: Progress) {
        let _ = progress;
    }

    /// The stage has ended.
    fn end(&self, stage: Stage) {
        let _ = stage;
    }

    /// The renderer chose a setting automatically; a sentence for people. Treated as a note unless overridden.
    fn report_default(&self, setting: Setting, text: &str) {
        let _ = setting;
        self.note(text);
    }

    /// Information about the image; a sentence for people.
    fn note(&self, text: &str) {
        let _ = text;
    }

    /// Queried between pieces of work: `true` ends the render with
    /// [`RenderError::Cancelled`](crate::RenderError::Cancelled), or with the rows that are finished if
    /// [`Settings::partial`](crate::Settings::partial) asks for them.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that ignores everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}
