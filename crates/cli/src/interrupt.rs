//! Requests to end: Ctrl-C and the signals INT, TERM and HUP.
//!
//! 1. A request is recorded. Work that [asks for it](watched) has a short time to end by itself: a suite saves its rows so far.
//! 2. The process [leaves](leave): temporary files are removed, from then on none can be created or renamed, so that each output is
//!    there completely or not at all; the message says which are there.
//!
//! So nothing has to cooperate, be it reading, decoding, building or encoding. Libraries know nothing of signals. GPU memory is freed
//! by the driver.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::thread;
use std::time::Duration;

use lightmesh_files::{Abandoned, abandon, record_written};

use crate::failure::Failure;
use crate::output;

/// How long work may take to end by itself.
const GRACE: Duration = Duration::from_millis(100);

/// The exit code of the request; 0: none so far.
static REQUESTED: AtomicU8 = AtomicU8::new(0);
/// Whether the work in progress asks for requests.
static WATCHED: AtomicBool = AtomicBool::new(false);

/// Obeys requests from now on.
pub(crate) fn install() -> Result<(), Failure> {
    record_written();
    listen(|code| {
        REQUESTED.store(code, Ordering::SeqCst);
        if WATCHED.load(Ordering::SeqCst) {
            thread::sleep(GRACE);
        }
        leave(code)
    })
}

/// Does work that ends by itself when the program [shall end](requested).
pub(crate) fn watched<T>(work: impl FnOnce() -> T) -> T {
    WATCHED.store(true, Ordering::SeqCst);
    let result = work();
    WATCHED.store(false, Ordering::SeqCst);
    result
}

/// Whether the program shall end.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed) != 0
}

/// Leaves if the program shall end: called when it has ended by itself.
pub(crate) fn leave_if_requested() {
    match REQUESTED.load(Ordering::SeqCst) {
        0 => {}
        code => leave(code),
    }
}

/// Removes what is unfinished, says what is written, and exits. Of two threads that call this, one waits for the other to exit.
fn leave(code: u8) -> ! {
    output::conclude(&message(&abandon()));
    exit(code)
}

/// The same for another reason, which is the message, unless it is known that outputs are there.
pub(crate) fn end(code: u8, reason: &str) -> ! {
    match abandon() {
        abandoned if abandoned == Abandoned::default() => output::conclude(reason),
        abandoned => output::conclude(&format!("{reason}; {}", message(&abandoned))),
    }
    exit(code)
}

fn message(Abandoned { written, partial, .. }: &Abandoned) -> String {
    let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    let whole = match &names[..] {
        [] => "nothing was written".to_owned(),
        names => format!("written: {}", names.join(", ")),
    };
    let part = |path: &Path| format!("interrupted: {whole}, and part of an output to {}", path.display());
    partial.as_deref().map_or_else(|| format!("interrupted: {whole}"), part)
}

/// Calls `end` with an exit code for the first request, on a thread of its own.
#[cfg(unix)]
fn listen(end: impl Fn(u8) + Send + 'static) -> Result<(), Failure> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    // One that is ignored stays so: nohup and shells ask for it.
    let signals = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal));
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    let first = move || signals.forever().for_each(|signal| end(128 + signal as u8));
    thread::Builder::new().name("signals".to_owned()).spawn(first)?;
    Ok(())
}

/// Whether the parent process has set the signal to be ignored. Known on Linux only.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

#[cfg(not(unix))]
fn listen(end: impl Fn(u8) + Send + 'static) -> Result<(), Failure> {
    let listening = ctrlc::set_handler(move || end(crate::failure::INTERRUPTED));
    Ok(listening.map_err(std::io::Error::other)?)
}

/// Exits without the clean-up of libraries, which would wait for threads at work.
#[cfg(unix)]
pub(crate) fn exit(code: u8) -> ! {
    signal_hook::low_level::exit(code.into())
}

#[cfg(not(unix))]
pub(crate) fn exit(code: u8) -> ! {
    std::process::exit(code.into())
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn the_message_says_what_is_written() {
        let mut state = Abandoned::default();
        assert_eq!(message(&state), "interrupted: nothing was written");
        state.written = ["a.png", "a.json"].map(PathBuf::from).into();
        assert_eq!(message(&state), "interrupted: written: a.png, a.json");
        state.partial = Some("/dev/stdout".into());
        assert_eq!(message(&state), "interrupted: written: a.png, a.json, and part of an output to /dev/stdout");
    }
}
