//! Work that takes time: it runs on a thread of its own, so that the thread which asked for it can report progress and obey Ctrl-C.
//!
//! That thread lets go of the interpreter and looks in on the work now and then. Whatever is raised there, by a signal's handler or by a callback,
//! stops the work and is raised to the caller. Callbacks are called by the caller's thread alone.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use lightmesh::request::Host;
use lightmesh::{Observer, Stage};
use pyo3::prelude::*;

/// How often the caller's thread looks in.
const TICK: Duration = Duration::from_millis(40);

/// How far a render has come.
#[pyclass(frozen, module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct Progress {
    /// From 0 to 1.
    #[pyo3(get)]
    done: f64,
    /// Since the beginning.
    #[pyo3(get)]
    seconds: f64,
    /// Seconds that remain, if that can be told.
    #[pyo3(get)]
    left: Option<f64>,
    /// What is being done, by the names of `Frame.stats`.
    #[pyo3(get)]
    stage: String,
}

#[pymethods]
impl Progress {
    fn __repr__(&self) -> String {
        format!("<lightmesh.Progress {:.0} % after {:.1} s, {}>", 100.0 * self.done, self.seconds, self.stage)
    }
}

/// Stops renders from another thread: those it was given to raise `Cancelled`, or with `partial` return what is finished.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Default)]
pub(crate) struct Cancel {
    is_cancelled: Arc<AtomicBool>,
}

#[pymethods]
impl Cancel {
    #[new]
    fn new() -> Cancel {
        Cancel::default()
    }

    /// From now on.
    fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether `cancel` was called.
    #[getter]
    fn cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }

    fn __repr__(&self) -> &'static str {
        if self.cancelled() { "<lightmesh.Cancel, cancelled>" } else { "<lightmesh.Cancel>" }
    }
}

/// What a caller wants to know, and how it stops the work.
#[derive(Default)]
pub(crate) struct Wishes {
    pub(crate) progress: Option<Py<PyAny>>,
    pub(crate) cancel: Option<Cancel>,
}

impl Wishes {
    /// The same again.
    pub(crate) fn clone_ref(&self, py: Python<'_>) -> Wishes {
        Wishes { progress: self.progress.as_ref().map(|callback| callback.clone_ref(py)), cancel: self.cancel.clone() }
    }
}

/// What the work tells.
pub(crate) struct Watch {
    state: Mutex<State>,
    changed: Condvar,
    stop: AtomicBool,
    cancel: Option<Cancel>,
}

#[derive(Default)]
struct State {
    stage: Option<Stage>,
    progress: lightmesh::render::Progress,
    is_new: bool,
    is_over: bool,
    notes: Vec<String>,
}

impl Watch {
    fn new(cancel: Option<Cancel>) -> Watch {
        Watch { state: Mutex::default(), changed: Condvar::new(), stop: AtomicBool::new(false), cancel }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What was said to people.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.state().notes.clone()
    }

    /// Waits a little; returns whether the work is over, and its progress if that has changed.
    fn look(&self) -> (bool, Option<Progress>) {
        let state = self.state();
        let (mut state, _) = self
            .changed
            .wait_timeout_while(state, TICK, |state| !state.is_over)
            .unwrap_or_else(PoisonError::into_inner);
        let is_new = std::mem::take(&mut state.is_new);
        let lightmesh::render::Progress { done, seconds, left } = state.progress;
        let stage = state.stage.map_or(String::new(), |stage| stage.name().to_owned());
        (state.is_over, is_new.then_some(Progress { done, seconds, left, stage }))
    }

    fn finish(&self) {
        self.state().is_over = true;
        self.changed.notify_all();
    }
}

impl Observer for Watch {
    fn begin(&self, stage: Stage, _total: u64) {
        self.state().stage = Some(stage);
    }

    fn progress(&self, progress: lightmesh::render::Progress) {
        let mut state = self.state();
        (state.progress, state.is_new) = (progress, true);
    }

    fn note(&self, text: &str) {
        let mut state = self.state();
        if state.notes.iter().all(|note| note != text) {
            state.notes.push(text.to_owned());
        }
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.cancel.as_ref().is_some_and(Cancel::cancelled)
    }
}

impl Host for Watch {}

/// Tells the caller's thread that the work is over, however it ends.
struct Ending<'a>(&'a Watch);

impl Drop for Ending<'_> {
    fn drop(&mut self) {
        self.0.finish();
    }
}

/// Does `work` on another thread. Returns what it returns, unless something is raised meanwhile.
pub(crate) fn run<T: Send>(py: Python<'_>, wishes: Wishes, work: impl FnOnce(&Watch) -> T + Send) -> PyResult<T> {
    let Wishes { progress, cancel } = wishes;
    let watch = Watch::new(cancel);
    let attend = |py: Python<'_>, news: Option<Progress>| -> PyResult<()> {
        py.check_signals()?;
        if let (Some(callback), Some(news)) = (&progress, news) {
            callback.call1(py, (news,))?;
        }
        Ok(())
    };
    let (result, raised) = py.detach(|| {
        thread::scope(|scope| {
            let worker = scope.spawn(|| {
                let _ending = Ending(&watch);
                work(&watch)
            });
            let mut raised = None;
            loop {
                let (is_over, news) = watch.look();
                if raised.is_none() && !(is_over && news.is_none()) {
                    raised = Python::attach(|py| attend(py, news)).err();
                    watch.stop.fetch_or(raised.is_some(), Ordering::Relaxed);
                }
                if is_over {
                    break;
                }
            }
            (worker.join().unwrap_or_else(|panic| resume_unwind(panic)), raised)
        })
    });
    match raised {
        Some(raised) => Err(raised),
        None => Ok(result),
    }
}
