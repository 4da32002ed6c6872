//! Programs that may have to end at any moment: what is unfinished then, and what is written.
//!
//! Every temporary file is created, renamed and removed under one lock. A program that is asked to end takes it for good: from then
//! on, nothing can appear any more, and nothing unfinished stays.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::output::{Ready, Step};

/// Paths of temporary files.
pub(crate) type Temporaries = BTreeSet<PathBuf>;

/// The unfinished outputs of this process.
#[derive(Debug)]
pub(crate) struct Registry {
    /// All temporary files.
    pub(crate) temporaries: Temporaries,
    /// Directories that have been searched for the files of dead runs.
    pub(crate) swept: BTreeSet<PathBuf>,
    /// What is written, as the user calls it; `None` if nobody asks.
    written: Option<Vec<PathBuf>>,
    /// The stream that is being written.
    partial: Option<PathBuf>,
    /// What is published if the program ends early.
    pub(crate) standby: Option<Ready>,
}

static REGISTRY: Mutex<Registry> = Mutex::new(Registry {
    temporaries: BTreeSet::new(),
    swept: BTreeSet::new(),
    written: None,
    partial: None,
    standby: None,
});

pub(crate) fn registry() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Registry {
    /// An output is there.
    pub(crate) fn wrote(&mut self, path: PathBuf) {
        self.partial = None;
        self.written.iter_mut().for_each(|written| written.push(path.clone()));
    }

    /// A stream will have a part of an output.
    pub(crate) fn begins(&mut self, path: PathBuf) {
        self.partial = Some(path);
    }
}

/// What a program has written that ended early. Paths are those that were given for the outputs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Abandoned {
    /// Outputs that are there.
    pub written: Vec<PathBuf>,
    /// A pipe or device that has a part of an output, or at most that.
    pub partial: Option<PathBuf>,
}

/// From now on, the names of outputs are recorded for [`abandon`]. For programs that may have to end early.
pub fn record_written() {
    registry().written.get_or_insert_default();
}

/// An output that [`abandon`] publishes, such as results so far; it replaces an earlier one, and [`publish`](crate::publish())
/// replaces it. Only a file can stand by: what is written through would have to wait for a reader.
pub fn stand_by(output: Option<Ready>) {
    let earlier = std::mem::replace(&mut registry().standby, output);
    // The registry is free again.
    drop(earlier);
}

/// Publishes the output that stands by, and removes all temporary files of this process, for good: whoever creates,
/// publishes or removes an output afterwards, or calls this again, waits forever. To be called just before the process
/// exits, from any thread.
pub fn abandon() -> Abandoned {
    let mut registry = registry();
    if let Some((path, Step::Rename(file, target))) = registry.standby.take().map(Ready::step) {
        if file.rename(&target, &mut registry).is_ok() {
            registry.wrote(path);
        }
        // Dropping it would take the registry.
        std::mem::forget(file);
    }
    for path in &registry.temporaries {
        // If it cannot be removed, the next run will.
        let _ = fs::remove_file(path);
    }
    let (written, partial) = (registry.written.take().unwrap_or_default(), registry.partial.take());
    std::mem::forget(registry);
    Abandoned { written, partial }
}
