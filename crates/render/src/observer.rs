//! Watching a render: progress, timing, choices made, and a way to stop it.

use crate::settings::Setting;
use crate::stage::Stage;

/// How far a picture is, over all of its stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// The part of the work that is done, 0 to 1. Mirrors may send it back a little: how many rays they add is known only when they do.
    pub done: f64,
    /// Seconds since the picture was begun.
    pub seconds: f64,
    /// Seconds to go, if the rest takes as long as what was done; unknown at the very beginning.
    pub left: Option<f64>,
}

/// Somebody who watches a render. Called from many threads.
pub trait Observer: Sync {
    /// A stage begins that has `total` pieces of work. Before it ends, [`advance`](Observer::advance) has told of as many.
    fn begin(&self, stage: Stage, total: u64) {
        let _ = (stage, total);
    }

    /// `pieces` more pieces of the current stage are done.
    fn advance(&self, pieces: u64) {
        let _ = pieces;
    }

    /// The whole picture has come so far. Called now and then, after pieces of work.
    fn progress(&self, progress: Progress) {
        let _ = progress;
    }

    /// The stage is over.
    fn end(&self, stage: Stage) {
        let _ = stage;
    }

    /// The renderer chose a setting by itself; a sentence for people. Unless this is overridden it is a note like others.
    fn chose(&self, setting: Setting, text: &str) {
        let _ = setting;
        self.note(text);
    }

    /// There is something to know about the picture; a sentence for people.
    fn note(&self, text: &str) {
        let _ = text;
    }

    /// Asked between pieces of work: `true` ends the render with [`RenderError::Cancelled`](crate::RenderError::Cancelled).
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}
