//! An observer that checks a renderer's guarantees about progress.

use std::sync::{Mutex, MutexGuard, PoisonError};

use lightmesh_render::{Observer, Progress, Stage};

/// A stage as an observer saw it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Watched {
    /// The stage.
    pub stage: Stage,
    /// Pieces of work that were announced.
    pub total: u64,
    /// Pieces that were done when the stage ended.
    pub done: u64,
}

/// Records stages and the progress of the whole image.
#[derive(Debug, Default)]
pub struct Watch {
    log: Mutex<Log>,
}

#[derive(Debug, Default)]
struct Log {
    current: Option<Watched>,
    stages: Vec<Watched>,
    whole: Vec<f64>,
}

impl Observer for Watch {
    fn begin(&self, stage: Stage, total: u64) {
        let mut log = self.log();
        assert_eq!(log.current, None, "a stage begins within another one");
        log.current = Some(Watched { stage, total, done: 0 });
    }

    fn advance(&self, pieces: u64) {
        let mut log = self.log();
        let current = log.current.as_mut().expect("a stage is under way");
        current.done += pieces;
        assert!(current.done <= current.total, "{current:?}");
    }

    fn progress(&self, progress: Progress) {
        self.log().whole.push(progress.done);
    }

    fn end(&self, stage: Stage) {
        let mut log = self.log();
        let ended = log.current.take().expect("a stage is under way");
        assert_eq!(ended.stage, stage);
        log.stages.push(ended);
    }
}

impl Watch {
    /// All stages in order. Panics if one did not end at its total, or the whole image did not reach its end.
    pub fn finished(&self) -> Vec<Watched> {
        let log = self.log();
        assert_eq!(log.current, None, "a stage is still under way");
        for stage in &log.stages {
            assert_eq!(stage.done, stage.total, "{stage:?}");
        }
        assert!(log.whole.iter().all(|done| (0.0..=1.0).contains(done)), "{:?}", log.whole);
        assert_eq!(log.whole.last(), Some(&1.0), "{:?}", log.whole);
        log.stages.clone()
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
