//! What is unfinished: every temporary file is created, renamed and removed under one lock.

use std::collections::BTreeSet;
use std::convert::Infallible;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use crate::per_process::PerProcess;

/// Paths of temporary files.
pub(crate) type Temporaries = BTreeSet<PathBuf>;

/// The unfinished outputs of this process.
#[derive(Debug, Default)]
pub(crate) struct Registry {
    /// All temporary files.
    pub(crate) temporaries: Temporaries,
    /// Directories that have been searched for the files of dead runs.
    pub(crate) swept: BTreeSet<PathBuf>,
    /// What is written, as the user calls it; `None` if nobody asks.
    pub(crate) written: Option<Vec<PathBuf>>,
    /// The stream that is being written.
    pub(crate) partial: Option<PathBuf>,
}

/// A child has written nothing yet, and files of its parent are not its own.
static REGISTRY: LazyLock<PerProcess<Mutex<Registry>>> = LazyLock::new(|| PerProcess::new(Mutex::default()));

pub(crate) fn registry() -> MutexGuard<'static, Registry> {
    let Ok(own) = REGISTRY.get_or_make(|| Ok::<_, Infallible>(Mutex::default()));
    own.lock().unwrap_or_else(PoisonError::into_inner)
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
