//! What is said of errors, and of bugs in the program itself.

use std::ffi::OsString;
use std::panic::PanicHookInfo;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::{Failure, INTERRUPTED};
use crate::{args, flags, output};

/// Reports an error; returns the exit code.
pub(crate) fn failed(failure: &Failure, arguments: &[OsString]) -> u8 {
    match failure {
        Failure::Exceeded(_) => output::complain(&failure.to_string()),
        // The last message, on what is written, says it.
        _ if failure.exit_code() == INTERRUPTED => {}
        _ => match flags::that_mend(failure) {
            flags if flags.is_empty() => output::complain(&format!("error: {failure}")),
            flags => {
                // A flag with a value is what to write instead.
                let variable = |flag: &str| args::variable_of(flag, arguments).filter(|_| !flag.contains(' '));
                let flags: Vec<String> = flags.into_iter().map(|flag| variable(&flag).unwrap_or(flag)).collect();
                output::complain(&format!("error: {failure} ({})", flags.join(", ")));
            }
        },
    }
    failure.exit_code()
}

/// Whether a bug in the program itself was reported.
static REPORTED: AtomicBool = AtomicBool::new(false);

/// A bug is reported again, if there is one.
pub(crate) fn forget_fault() {
    REPORTED.store(false, Ordering::Relaxed);
}

/// Reports a bug in the program itself, once, however many threads run into it.
pub(crate) fn report_fault(fault: &PanicHookInfo) {
    let payload = fault.payload();
    let text = payload.downcast_ref::<&str>().copied().or(payload.downcast_ref::<String>().map(String::as_str));
    let message = text.unwrap_or("no message");
    let place = fault.location().map_or_else(String::new, |place| format!(", {}:{}", place.file(), place.line()));
    let text = format!("error: internal error in lightmesh ({message}){place}; please report it with the command line");
    if !REPORTED.swap(true, Ordering::Relaxed) {
        output::complain(&text);
    }
}
