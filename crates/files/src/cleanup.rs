//! Programs that may have to end at any moment: what is unfinished then, and what is written.
//!
//! A program that is asked to end takes the lock of the [registry](crate::registry) for good: from then on, nothing can appear any more,
//! and nothing unfinished stays.

use std::fs;
use std::mem;
use std::path::PathBuf;

use crate::output::{Ready, Step};
use crate::registry::registry;
use crate::standby::exchange;

/// What a program has written that ended early. Paths are those that were given for the outputs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Aborted {
    /// Outputs that are there.
    pub written: Vec<PathBuf>,
    /// A pipe or device that has a part of an output, or at most that.
    pub partial: Option<PathBuf>,
}

/// From now on, the names of outputs are recorded for [`abort`]. For programs that may have to end early.
pub fn record_written() {
    registry().written.get_or_insert_default();
}

/// What was written since [`record_written`], or since this was called before: for programs that do one piece of work after the other.
pub fn take_written() -> Aborted {
    let mut registry = registry();
    Aborted { written: registry.written.as_mut().map(mem::take).unwrap_or_default(), partial: registry.partial.take() }
}

/// An output that [`abort`] publishes, such as results so far; it replaces an earlier one, and [`publish`](crate::publish())
/// replaces it. Only a file can stand by: what is written through would have to wait for a reader.
pub fn publish_on_abort(output: Option<Ready>) {
    let earlier = exchange(output, &mut registry());
    // The registry is free again.
    drop(earlier);
}

/// Publishes the output that stands by, and removes all temporary files of this process, for good: whoever creates,
/// publishes or removes an output afterwards, or calls this again, waits forever. To be called just before the process
/// exits, from any thread.
pub fn abort() -> Aborted {
    let mut registry = registry();
    if let Some((path, Step::Rename(file, target))) = exchange(None, &mut registry).map(Ready::step) {
        if file.rename(&target, &mut registry).is_ok() {
            registry.wrote(path);
        }
        // Dropping it would take the registry.
        mem::forget(file);
    }
    for path in &registry.temporaries {
        // If it cannot be removed, the next run will.
        let _ = fs::remove_file(path);
    }
    let (written, partial) = (registry.written.take().unwrap_or_default(), registry.partial.take());
    mem::forget(registry);
    Aborted { written, partial }
}
