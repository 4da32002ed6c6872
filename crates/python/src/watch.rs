//! Work that takes time: it runs on a thread of its own, so that the thread which asked for it can report progress and obey Ctrl-C.
//!
//! That thread lets go of the interpreter and looks in on the work now and then. Whatever is raised there, by a signal's handler or by a callback,
//! stops the work and is raised to the caller. Callbacks are called by the caller's thread alone.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use lightmesh::request::{Host, Words, fewer_threads};
use lightmesh::{Observer, Renderer, Stage};
use lightmesh_files::visible;
use pyo3::prelude::*;

use crate::argument::Given;
use crate::errors;
use crate::process;
use crate::warning::{self, About};

/// How often the caller's thread looks in.
const TICK: Duration = Duration::from_millis(40);

/// How far a render, or the whole of a film, has come.
#[pyclass(frozen, module = "lightmesh")]
#[derive(Clone)]
pub(crate) struct Progress {
    /// The share of all work that is done, from 0 to 1; it never falls, and is 1 in the end.
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

/// What is called with progress.
pub(crate) struct Callback(Py<PyAny>);

impl FromPyObject<'_, '_> for Callback {
    type Error = PyErr;

    /// Fails at once, not when there is something to tell.
    fn extract(object: Borrowed<'_, '_, PyAny>) -> PyResult<Callback> {
        if object.is_callable() {
            return Ok(Callback(object.to_owned().unbind()));
        }
        Err(errors::wrong_type("a function of a Progress, as `follow(bar)` makes one of a bar", &object))
    }
}

/// What a caller wants to know, and how it stops the work.
#[derive(Default)]
pub(crate) struct Wishes {
    pub(crate) progress: Option<Py<PyAny>>,
    pub(crate) cancel: Option<Cancel>,
    /// Whether progress is that of other work, too.
    pub(crate) is_part: bool,
    /// Whether warnings are kept among the notes.
    pub(crate) warnings: bool,
}

impl Wishes {
    /// To hear of everything that is worth a sentence.
    pub(crate) fn of_warnings() -> Wishes {
        Wishes { warnings: true, ..Wishes::default() }
    }

    pub(crate) fn new(progress: Option<Callback>, cancel: Option<Given<Cancel>>) -> Wishes {
        let (progress, cancel) = (progress.map(|Callback(progress)| progress), cancel.map(|Given(cancel)| cancel));
        Wishes { progress, cancel, ..Wishes::default() }
    }

    /// The same for a part of the work that progress is told of.
    pub(crate) fn of_part(&self, py: Python<'_>) -> Wishes {
        let progress = self.progress.as_ref().map(|callback| callback.clone_ref(py));
        Wishes { progress, cancel: self.cancel.clone(), is_part: true, warnings: self.warnings }
    }
}

/// What the work tells.
pub(crate) struct Watch {
    state: Mutex<State>,
    changed: Condvar,
    stop: AtomicBool,
    cancel: Option<Cancel>,
    keeps_warnings: bool,
}

#[derive(Default)]
struct State {
    stage: Option<Stage>,
    progress: lightmesh::render::Progress,
    is_new: bool,
    is_over: bool,
    notes: Vec<String>,
    warnings: Vec<(About, String)>,
}

impl State {
    fn told(&self) -> Progress {
        let lightmesh::render::Progress { done, seconds, left } = self.progress;
        Progress { done, seconds, left, stage: self.stage.map_or(String::new(), |stage| stage.name().to_owned()) }
    }
}

impl Watch {
    fn new(cancel: Option<Cancel>, keeps_warnings: bool) -> Watch {
        Watch { state: Mutex::default(), changed: Condvar::new(), stop: AtomicBool::new(false), cancel, keeps_warnings }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps a warning for the caller's thread.
    fn warn(&self, about: About, text: &str) {
        self.state().warnings.push((about, text.to_owned()));
    }

    /// Tells what there is to warn of.
    fn tell_warnings(&self, py: Python<'_>) -> PyResult<()> {
        let warnings = std::mem::take(&mut self.state().warnings);
        warnings.iter().try_for_each(|(about, text)| warning::warn(py, *about, text))
    }

    /// Notes that fewer threads work than were asked for, if it is so.
    pub(crate) fn note_threads(&self, asked: Option<usize>, engine: &Renderer) {
        if let Some(text) = asked.and_then(|asked| fewer_threads(asked, engine, Words::Fields)) {
            self.note(&text);
        }
    }

    /// What was said to people.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.state().notes.clone()
    }

    /// What was said to people, and warnings, made safe to show.
    pub(crate) fn said(&self) -> Vec<String> {
        self.state().notes.iter().map(|text| visible(text).into_owned()).collect()
    }

    /// Waits a little; returns whether the work is over, and its progress if that has changed.
    fn look(&self) -> (bool, Option<Progress>) {
        let state = self.state();
        let (mut state, _) = self
            .changed
            .wait_timeout_while(state, TICK, |state| !state.is_over)
            .unwrap_or_else(PoisonError::into_inner);
        let is_new = std::mem::take(&mut state.is_new);
        (state.is_over, is_new.then(|| state.told()))
    }

    /// All of it is done; what is told of that, unless it was told before.
    fn complete(&self) -> Option<Progress> {
        let mut state = self.state();
        let was_told = state.progress.done >= 1.0 && !state.is_new;
        (state.progress.done, state.progress.left) = (1.0, Some(0.0));
        (!was_told).then(|| state.told())
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

impl Host for Watch {
    fn warning(&self, text: &str) {
        if self.keeps_warnings {
            self.note(text);
        } else {
            self.warn(About::Other, text);
        }
    }

    fn warning_of_scene(&self, text: &str) {
        if self.keeps_warnings {
            self.note(text);
        } else {
            self.warn(About::Scene, text);
        }
    }
}

/// Tells the caller's thread that the work is over, however it ends.
struct Ending<'a>(&'a Watch);

impl Drop for Ending<'_> {
    fn drop(&mut self) {
        self.0.finish();
    }
}

/// Does `work` on another thread. Returns what it returns, unless something is raised meanwhile.
pub(crate) fn run<T: Send, E: Send>(
    py: Python<'_>,
    wishes: Wishes,
    work: impl FnOnce(&Watch) -> Result<T, E> + Send,
) -> PyResult<Result<T, E>> {
    let Wishes { progress, cancel, is_part, warnings } = wishes;
    let watch = Watch::new(cancel, warnings);
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
                process::run(|| work(&watch))
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
    if let Some(raised) = raised {
        return Err(raised);
    }
    let result = result?;
    watch.tell_warnings(py)?;
    // A render that was stopped may have given what was finished.
    let is_complete = result.is_ok() && !watch.cancelled() && progress.is_some() && !is_part;
    if let Some(news) = is_complete.then(|| watch.complete()).flatten() {
        attend(py, Some(news))?;
    }
    Ok(result)
}
