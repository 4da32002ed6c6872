//! Output on standard error during a computation: messages, a bar, a line now and then, JSON, or lines for the runners of jobs.

mod bar;
mod json;
mod lines;
mod openjd;

use std::collections::BTreeSet;
use std::io::{self, IsTerminal};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use lightmesh::render::Setting;
use lightmesh::request::{FrameDone, Host, Words};
use lightmesh::{Observer, Stage};

use crate::args::Progress;
use crate::failure::Failure;
use crate::{flags, interrupt, memory, output};
use bar::Bar;
use json::Json;
use lines::Lines;
use openjd::Openjd;

/// Observes a render and reports on it.
pub(crate) struct Watcher {
    quiet: bool,
    sink: Sink,
    /// Notes of this command, and what warnings about images are about: each is said once, however many frames it holds for.
    said: Mutex<BTreeSet<String>>,
}

enum Sink {
    Plain,
    Bar(Bar),
    Lines(Lines),
    Json(Json),
    Openjd(Openjd),
}

impl Watcher {
    /// Shows progress as requested; `quiet` suppresses messages, and progress unless requested.
    pub(crate) fn new(progress: Progress, quiet: bool) -> Watcher {
        let terminal = io::stderr().is_terminal();
        let sink = match progress {
            Progress::Json => Sink::Json(Json::new()),
            Progress::Openjd => Sink::Openjd(Openjd::new()),
            Progress::None => Sink::Plain,
            Progress::Auto if quiet => Sink::Plain,
            Progress::Auto | Progress::Bar if terminal => Sink::Bar(Bar::new()),
            Progress::Auto | Progress::Bar => Sink::Lines(Lines::new()),
        };
        Watcher { quiet, sink, said: Mutex::default() }
    }

    /// Messages only.
    pub(crate) fn plain(quiet: bool) -> Watcher {
        Watcher { quiet, sink: Sink::Plain, said: Mutex::default() }
    }

    /// Whether a text has not been said before.
    fn is_new(&self, text: &str) -> bool {
        self.said.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_owned())
    }

    /// A summary at the end.
    pub(crate) fn summary(&self, text: &str) {
        if let Sink::Bar(bar) = &self.sink {
            bar.close();
        }
        self.say("summary", text, text);
    }

    /// The work has failed, which the error says.
    pub(crate) fn failed(&self, error: &Failure) {
        if let Sink::Openjd(openjd) = &self.sink {
            openjd.fail(&error.to_string());
        }
    }

    fn say(&self, event: &'static str, line: &str, text: &str) {
        if self.quiet {
            return;
        }
        match &self.sink {
            Sink::Plain | Sink::Lines(_) | Sink::Openjd(_) => output::complain(line),
            Sink::Bar(bar) => bar.aside(line),
            Sink::Json(json) => json.text(event, text),
        }
    }
}

fn time_left(left: Duration) -> String {
    match left.as_secs() {
        0 => String::new(),
        seconds if seconds < 60 => format!(", about {seconds} s left"),
        seconds if seconds < 3600 => format!(", about {} min {} s left", seconds / 60, seconds % 60),
        seconds => format!(", about {} h {} min left", seconds / 3600, seconds % 3600 / 60),
    }
}

impl Observer for Watcher {
    fn begin(&self, stage: Stage, total: u64) {
        match &self.sink {
            Sink::Plain | Sink::Openjd(_) => {}
            Sink::Bar(bar) => bar.begin(stage),
            Sink::Lines(lines) => lines.begin(stage),
            Sink::Json(json) => json.begin(stage, total),
        }
    }

    fn advance(&self, pieces: u64) {
        match &self.sink {
            Sink::Plain | Sink::Bar(_) | Sink::Lines(_) | Sink::Openjd(_) => {}
            Sink::Json(json) => json.advance(pieces),
        }
    }

    fn progress(&self, progress: lightmesh::render::Progress) {
        match &self.sink {
            Sink::Plain => {}
            Sink::Bar(bar) => bar.whole(progress),
            Sink::Lines(lines) => lines.whole(progress),
            Sink::Json(json) => json.whole(progress),
            Sink::Openjd(openjd) => openjd.whole(progress),
        }
    }

    fn end(&self, stage: Stage) {
        match &self.sink {
            Sink::Plain | Sink::Bar(_) | Sink::Openjd(_) => {}
            Sink::Lines(lines) => lines.end(),
            Sink::Json(json) => json.end(stage),
        }
    }

    fn report_default(&self, setting: Setting, text: &str) {
        self.note(&format!("{text} ({} sets another)", flags::of(setting)));
    }

    fn note(&self, text: &str) {
        if self.is_new(text) {
            self.say("note", text, text);
        }
    }

    fn cancelled(&self) -> bool {
        interrupt::requested()
    }
}

impl Host for Watcher {
    fn words(&self) -> Words {
        Words::Flags
    }

    fn warning(&self, text: &str) {
        self.say("warning", &format!("warning: {text}"), text);
    }

    fn warning_about(&self, what: &'static str, text: &str) {
        if self.is_new(what) {
            self.warning(text);
        }
    }

    fn frame(&self, frame: &FrameDone) {
        let FrameDone { number, last, when, seconds, left, picture, .. } = frame;
        let when = if when.is_empty() { String::new() } else { format!(", {when}") };
        if let Sink::Openjd(openjd) = &self.sink {
            openjd.frame(frame);
        }
        match &self.sink {
            Sink::Json(json) if !self.quiet => json.frame(frame),
            _ => self.say(
                "frame",
                &format!("frame {number} of {last}{when}: {seconds:.3} s, {picture}{}", time_left(*left)),
                "",
            ),
        }
    }

    fn remark(&self, text: String) {
        interrupt::remark(text);
    }

    fn in_task(&self, task: &str, work: &mut dyn FnMut()) {
        memory::during(task, work);
    }

    fn in_cancellable(&self, work: &mut dyn FnMut()) {
        interrupt::watched(work);
    }
}
