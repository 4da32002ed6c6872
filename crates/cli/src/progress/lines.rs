//! Progress where there is no terminal: one plain line every ten seconds, none in shorter runs.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use lightmesh::Stage;
use lightmesh::render::Progress;
use lightmesh::request::RENDERING;

use crate::{memory, output};

/// Time between two lines.
const INTERVAL: Duration = Duration::from_secs(10);

/// Prints lines on a thread of its own, until it is dropped.
pub(super) struct Lines {
    state: Arc<Mutex<State>>,
    /// Its end is that of the thread.
    _running: Sender<()>,
}

/// What is known of the work in progress.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    stage: Option<Stage>,
    progress: Option<Progress>,
}

impl Lines {
    pub(super) fn new() -> Lines {
        let state = Arc::new(Mutex::new(State::default()));
        let (running, ends) = channel();
        let (start, shown) = (Instant::now(), Arc::clone(&state));
        let print = move || {
            while ends.recv_timeout(INTERVAL) == Err(RecvTimeoutError::Timeout) {
                let state = *shown.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(line) = state.line(start.elapsed(), &memory::task()) {
                    output::complain(&line);
                }
            }
        };
        // Without the thread there are no lines.
        let _ = thread::Builder::new().name("progress".to_owned()).spawn(print);
        Lines { state, _running: running }
    }

    pub(super) fn begin(&self, stage: Stage) {
        self.change(|state| state.stage = Some(stage));
    }

    pub(super) fn end(&self) {
        self.change(|state| state.stage = None);
    }

    pub(super) fn whole(&self, progress: Progress) {
        self.change(|state| state.progress = Some(progress));
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl State {
    /// A line after so much time, while the program does `task`; `None` if nothing is known.
    fn line(&self, elapsed: Duration, task: &str) -> Option<String> {
        let what = match self.progress {
            Some(progress) if task == RENDERING => self.rendering(progress),
            _ if task.is_empty() => return None,
            _ => task.to_owned(),
        };
        Some(format!("{} s: {what}", elapsed.as_secs()))
    }

    /// How far it is.
    fn rendering(&self, Progress { done, left, .. }: Progress) -> String {
        let left = left.map_or_else(String::new, |left| format!(", about {left:.0} s left"));
        let stage = self.stage.map_or_else(String::new, |stage| format!(" ({})", stage.name().replace('_', " ")));
        format!("{:.0}%{left}{stage}", (100.0 * done).floor())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AFTER: Duration = Duration::from_millis(20_300);

    #[test]
    fn a_line_says_how_far_it_is_or_what_is_done() {
        let progress = Some(Progress { done: 0.419, seconds: 14.0, left: Some(19.6) });
        let state = State { stage: Some(Stage::ShortTests), progress };
        let line = |state: State, task| state.line(AFTER, task);
        let wanted = "20 s: 41%, about 20 s left (short tests)";
        assert_eq!(line(state, RENDERING).as_deref(), Some(wanted));
        assert_eq!(line(state, "writing the image").as_deref(), Some("20 s: writing the image"));
        assert_eq!(line(State::default(), "reading a.obj").as_deref(), Some("20 s: reading a.obj"));
        assert_eq!(line(State::default(), RENDERING).as_deref(), Some("20 s: rendering"));
        assert_eq!(line(State::default(), ""), None);
    }

    #[test]
    fn the_thread_ends_with_the_run() {
        let lines = Lines::new();
        lines.begin(Stage::Shade);
        let state = Arc::downgrade(&lines.state);
        drop(lines);
        // It holds the state while it runs.
        while state.strong_count() > 0 {
            thread::yield_now();
        }
    }
}
