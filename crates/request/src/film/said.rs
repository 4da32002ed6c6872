//! What is said of a frame while it is rendered, to be told when it is written.

use std::sync::{Mutex, PoisonError};

use lightmesh_render::{Observer, Progress, Setting};

use crate::host::Host;
use crate::words::Words;

/// What was said, in its order.
pub(super) struct Said(Vec<Sentence>);

enum Sentence {
    Default(Setting, String),
    Note(String),
    Warning(String),
    WarningOfScene(String),
    WarningAbout(&'static str, String),
}

impl Said {
    /// Tells it.
    pub(super) fn tell(&self, host: &dyn Host) {
        for sentence in &self.0 {
            match sentence {
                Sentence::Default(setting, text) => host.report_default(*setting, text),
                Sentence::Note(text) => host.note(text),
                Sentence::Warning(text) => host.warning(text),
                Sentence::WarningOfScene(text) => host.warning_of_scene(text),
                Sentence::WarningAbout(what, text) => host.warning_about(what, text),
            }
        }
    }
}

/// A host that keeps what is said. It tells an observer of progress, and ends work when that does.
pub(super) struct Recorder<'a, O> {
    observer: O,
    host: &'a dyn Host,
    said: Mutex<Vec<Sentence>>,
}

impl<'a, O: Observer> Recorder<'a, O> {
    /// In the words of a host.
    pub(super) fn new(observer: O, host: &'a dyn Host) -> Recorder<'a, O> {
        Recorder { observer, host, said: Mutex::default() }
    }

    /// What was said.
    pub(super) fn said(self) -> Said {
        Said(self.said.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn keep(&self, sentence: Sentence) {
        self.said.lock().unwrap_or_else(PoisonError::into_inner).push(sentence);
    }
}

impl<O: Observer> Observer for Recorder<'_, O> {
    fn progress(&self, progress: Progress) {
        self.observer.progress(progress);
    }

    fn report_default(&self, setting: Setting, text: &str) {
        self.keep(Sentence::Default(setting, text.to_owned()));
    }

    fn note(&self, text: &str) {
        self.keep(Sentence::Note(text.to_owned()));
    }

    fn cancelled(&self) -> bool {
        self.observer.cancelled()
    }
}

/// Other frames have the same tasks at the same time: those are not named.
impl<O: Observer> Host for Recorder<'_, O> {
    fn words(&self) -> Words {
        self.host.words()
    }

    fn warning(&self, text: &str) {
        self.keep(Sentence::Warning(text.to_owned()));
    }

    fn warning_of_scene(&self, text: &str) {
        self.keep(Sentence::WarningOfScene(text.to_owned()));
    }

    fn warning_about(&self, what: &'static str, text: &str) {
        self.keep(Sentence::WarningAbout(what, text.to_owned()));
    }

    fn remark(&self, text: String) {
        self.host.remark(text);
    }
}
