//! Ctrl-C.
//!
//! Before a render is observed, the process exits immediately: nothing has been written yet. Afterwards the request is recorded
//! and work stops at the next opportunity; a second Ctrl-C does not wait for that. Output files are renamed into place, so none
//! is ever partially written.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::{Failure, INTERRUPTED};
use crate::output;

static REQUESTED: AtomicBool = AtomicBool::new(false);
static WATCHED: AtomicBool = AtomicBool::new(false);

/// Catches Ctrl-C from now on.
pub(crate) fn install() -> Result<(), Failure> {
    ctrlc::set_handler(|| {
        let again = REQUESTED.swap(true, Ordering::SeqCst);
        if again || !WATCHED.load(Ordering::SeqCst) {
            output::complain("interrupted");
            process::exit(INTERRUPTED.into());
        }
    })?;
    Ok(())
}

/// From now on to the end of the run, [`requested`] is polled.
pub(crate) fn watch() {
    WATCHED.store(true, Ordering::SeqCst);
}

/// Whether the user wants to stop.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
