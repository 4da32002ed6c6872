//! Progress for runners of [Open Job Description](https://github.com/OpenJobDescription/openjd-specifications/wiki/How-Jobs-Are-Run), which read these
//! lines from what a task prints:
//!
//! ```text
//! openjd_progress: 41.3
//! openjd_status: frame 7 of 100
//! ```
//!
//! The first is the part of the task that is done, in percent. It never falls.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use lightmesh::render::Progress;
use lightmesh::request::FrameDone;

use crate::output;

/// Time between two lines of progress.
const INTERVAL: Duration = Duration::from_secs(1);

/// Prints lines for runners.
pub(super) struct Openjd {
    /// What was said last, and when.
    last: Mutex<Option<(String, Instant)>>,
}

impl Openjd {
    pub(super) fn new() -> Openjd {
        Openjd { last: Mutex::new(None) }
    }

    pub(super) fn whole(&self, Progress { done, .. }: Progress) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let line = format!("openjd_progress: {:.1}", 100.0 * done);
        let is_due = |(said, at): &(String, Instant)| *said != line && (done >= 1.0 || at.elapsed() >= INTERVAL);
        if last.as_ref().is_none_or(is_due) {
            output::complain(&line);
            *last = Some((line, Instant::now()));
        }
    }

    pub(super) fn frame(&self, FrameDone { number, last, .. }: &FrameDone) {
        output::complain(&format!("openjd_status: frame {number} of {last}"));
    }

    /// The task has failed.
    pub(super) fn fail(&self, why: &str) {
        output::complain(&format!("openjd_fail: {why}"));
    }
}
