//! The program around the work: what it shows of it, what it calls it, and how it ends it.

use std::cell::Cell;
use std::time::{Duration, Instant};

use lightmesh_render::{Observer, Progress, Setting, Stage};

use crate::words::Words;

/// What messages call the construction of an acceleration structure.
pub const BUILDING: &str = "building the acceleration structure";
/// What messages call the work on the image itself.
pub const RENDERING: &str = "rendering";

/// A finished frame of a film.
#[derive(Clone, Debug)]
pub struct FrameDone {
    /// Its number.
    pub number: u32,
    /// The film's last frame.
    pub last: u32,
    /// What it is called besides.
    pub when: String,
    /// Which of the frames of this run it is, from 1 on.
    pub index: usize,
    /// The frames of this run.
    pub count: usize,
    /// Frames that were there and are kept.
    pub kept: usize,
    /// How long it took to render.
    pub seconds: f64,
    /// About how long the others of this run will take.
    pub left: Duration,
    /// Its files.
    pub files: Vec<String>,
    /// Its image, or its movie.
    pub picture: String,
}

/// The program around the work. By default it shows nothing.
pub trait Host: Observer {
    /// How it names settings.
    fn words(&self) -> Words {
        Words::Fields
    }

    /// Something that may not be as it should be; a sentence for people.
    fn warning(&self, text: &str) {
        let _ = text;
    }

    /// The same about the file of the scene.
    fn warning_of_scene(&self, text: &str) {
        self.warning(text);
    }

    /// The same about images: the first one about each thing is enough, however many frames it holds for.
    fn warning_about(&self, what: &'static str, text: &str) {
        let _ = what;
        self.warning(text);
    }

    /// A frame of a film is finished.
    fn frame(&self, frame: &FrameDone) {
        let _ = frame;
    }

    /// What can be said of outputs if the work ends now.
    fn remark(&self, text: String) {
        let _ = text;
    }

    /// Does work that is called `task` where memory runs out: "reading a.obj".
    fn in_task(&self, task: &str, work: &mut dyn FnMut()) {
        let _ = task;
        work();
    }

    /// Does work that asks whether it is [cancelled](Observer::cancelled), and then ends soon.
    fn in_cancellable(&self, work: &mut dyn FnMut()) {
        work();
    }
}

impl Host for lightmesh_render::Unobserved {}

/// Does `work` that returns something, by a function that calls work that returns nothing.
fn with_result<T>(work: impl FnOnce() -> T, call: impl FnOnce(&mut dyn FnMut())) -> T {
    let (work, result) = (Cell::new(Some(work)), Cell::new(None));
    call(&mut || {
        if let Some(work) = work.take() {
            result.set(Some(work()));
        }
    });
    result.into_inner().expect("a host does the work that it is given")
}

impl dyn Host + '_ {
    /// Does `work` that is called `task`.
    pub fn during<T>(&self, task: &str, work: impl FnOnce() -> T) -> T {
        with_result(work, |work| self.in_task(task, work))
    }

    /// Does `work` that ends soon when it is cancelled.
    pub fn cancellable<T>(&self, work: impl FnOnce() -> T) -> T {
        with_result(work, |work| self.in_cancellable(work))
    }
}

/// Parts of some work, each of which takes about as long as those before it: frames of a film.
pub struct Parts {
    count: usize,
    /// What each one took that is done, seconds.
    took: Vec<f64>,
}

impl Parts {
    /// None of so many parts is done.
    pub fn new(count: usize) -> Parts {
        Parts { count, took: Vec::new() }
    }

    /// The host of the next one.
    pub fn next<'a>(&self, host: &'a dyn Host) -> Part<'a> {
        self.several(1, host)
    }

    /// The host of the next ones, of which so many are done at the same time.
    pub(crate) fn several<'a>(&self, count: usize, host: &'a dyn Host) -> Part<'a> {
        let share = |index: usize| index as f64 / self.count.max(1) as f64;
        let done = self.took.len();
        let (spent, shares) = (self.took.iter().sum(), [share(done), share(done + count)]);
        Part { others: self.whole(), ..Part::new(host, shares, spent) }
    }

    /// It took so many seconds.
    pub fn took(&mut self, seconds: f64) {
        self.several_took(1, seconds);
    }

    /// So many together took so many seconds.
    pub(crate) fn several_took(&mut self, count: usize, seconds: f64) {
        self.took.extend(std::iter::repeat_n(seconds / count as f64, count));
    }

    /// What all seem to take: the mean of all so far, and of the latest quarter, since some take longer than others and neighbours as long as each other.
    fn whole(&self) -> Option<f64> {
        let mean = |took: &[f64]| took.iter().sum::<f64>() / took.len() as f64;
        let latest = self.took.len().div_ceil(4);
        let both = 0.5 * (mean(&self.took) + mean(&self.took[self.took.len() - latest..]));
        (!self.took.is_empty()).then_some(self.count as f64 * both)
    }
}

/// The host of a part of some work, which hears of its progress as that of the whole.
pub struct Part<'a> {
    host: &'a dyn Host,
    shares: [f64; 2],
    /// Seconds of the whole before the part.
    spent: f64,
    /// Seconds of the whole, by the parts before it.
    others: Option<f64>,
    start: Instant,
}

impl<'a> Part<'a> {
    /// The part of the whole between two shares, after `spent` seconds of it.
    pub fn new(host: &'a dyn Host, shares: [f64; 2], spent: f64) -> Part<'a> {
        Part { host, shares, spent, others: None, start: Instant::now() }
    }
}

impl Observer for Part<'_> {
    fn begin(&self, stage: Stage, total: u64) {
        self.host.begin(stage, total);
    }

    fn advance(&self, pieces: u64) {
        self.host.advance(pieces);
    }

    fn progress(&self, progress: Progress) {
        let seconds = self.spent + self.start.elapsed().as_secs_f64();
        self.host.progress(progress.of_whole(self.shares, self.others, seconds));
    }

    fn end(&self, stage: Stage) {
        self.host.end(stage);
    }

    fn report_default(&self, setting: Setting, text: &str) {
        self.host.report_default(setting, text);
    }

    fn note(&self, text: &str) {
        self.host.note(text);
    }

    fn cancelled(&self) -> bool {
        self.host.cancelled()
    }
}

impl Host for Part<'_> {
    fn words(&self) -> Words {
        self.host.words()
    }

    fn warning(&self, text: &str) {
        self.host.warning(text);
    }

    fn warning_of_scene(&self, text: &str) {
        self.host.warning_of_scene(text);
    }

    fn warning_about(&self, what: &'static str, text: &str) {
        self.host.warning_about(what, text);
    }

    fn frame(&self, frame: &FrameDone) {
        self.host.frame(frame);
    }

    fn remark(&self, text: String) {
        self.host.remark(text);
    }

    fn in_task(&self, task: &str, work: &mut dyn FnMut()) {
        self.host.in_task(task, work);
    }

    fn in_cancellable(&self, work: &mut dyn FnMut()) {
        self.host.in_cancellable(work);
    }
}

/// A host that says nothing, and ends work when another one does.
pub(crate) struct Quiet<'a>(pub(crate) &'a dyn Host);

impl Observer for Quiet<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

impl Host for Quiet<'_> {
    fn words(&self) -> Words {
        self.0.words()
    }

    fn in_task(&self, task: &str, work: &mut dyn FnMut()) {
        self.0.in_task(task, work);
    }

    fn in_cancellable(&self, work: &mut dyn FnMut()) {
        self.0.in_cancellable(work);
    }
}
