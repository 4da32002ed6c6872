//! Requests to end: Ctrl-C and the signals INT, TERM and HUP.
//!
//! 1. A request is recorded. Work that [asks for it](watched) has a short time to end by itself: a suite saves its rows
//!    so far. Work that [keeps](keeping) what it has takes the time it needs: a render finishes the files of its
//!    picture. A second request ends that, too.
//! 2. The process [leaves](leave): temporary files are removed, from then on none can be created or renamed, so that each output is
//!    there completely or not at all; the message says which are there.
//!
//! A client of a [server](crate::server) waits until the server has ended the work, and a server takes a client that goes for a request, of which the
//! server itself does not end.
//!
//! So nothing has to cooperate, be it reading, decoding, building or encoding. Libraries know nothing of signals. GPU memory is freed
//! by the driver.

use std::path::Path;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use lightmesh_files::{Aborted, abort, record_written, take_written};

use crate::failure::Failure;
use crate::output;

/// How long work may take to end by itself.
const GRACE: Duration = Duration::from_millis(100);

/// Outputs that the last message lists one by one.
const LISTED: usize = 8;

/// The exit code of the request; 0: none so far.
static REQUESTED: AtomicU8 = AtomicU8::new(0);
/// The [`Manner`] in which the work in progress ends.
static MANNER: AtomicU8 = AtomicU8::new(Manner::AtOnce as u8);
/// What the last message says about the outputs that are there.
static REMARK: Mutex<String> = Mutex::new(String::new());
/// What else to do before the process ends.
static AT_END: Mutex<Option<Box<dyn Fn() + Send>>> = Mutex::new(None);

/// How work ends when the program shall end; later ones take longer.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Manner {
    /// It is left.
    AtOnce,
    /// It has a short time.
    Watched,
    /// It has the time it needs, unless there is a second request.
    Keeping,
    /// Another process ends it, unless there is a second request, and says what is written.
    Elsewhere,
}

/// Obeys requests from now on.
pub(crate) fn install() -> Result<(), Failure> {
    record_written();
    listen(|code| {
        // The first one decides about the exit code.
        let first = REQUESTED.compare_exchange(0, code, Ordering::SeqCst, Ordering::SeqCst);
        match MANNER.load(Ordering::SeqCst) {
            manner if manner == Manner::Keeping as u8 && first.is_ok() => return,
            manner if manner == Manner::Elsewhere as u8 => match first {
                Ok(_) => return,
                Err(code) => abandon(code),
            },
            manner if manner == Manner::Watched as u8 => thread::sleep(GRACE),
            _ => {}
        }
        leave(first.err().unwrap_or(code))
    })
}

/// Does work that ends by itself when the program [shall end](requested).
pub(crate) fn watched<T>(work: impl FnOnce() -> T) -> T {
    in_manner(Manner::Watched, work)
}

/// Does work that is not left when the program [shall end](requested): it ends by itself, and what it has then is
/// written. Only a second request ends it at once.
pub(crate) fn keeping<T>(work: impl FnOnce() -> T) -> T {
    in_manner(Manner::Keeping, work)
}

/// Waits for work of another process, which is told to end when this one [shall end](requested), and says what is written.
#[cfg(unix)]
pub(crate) fn elsewhere<T>(wait: impl FnOnce() -> T) -> T {
    in_manner(Manner::Elsewhere, wait)
}

/// Work within work that keeps what it has does so, too.
fn in_manner<T>(manner: Manner, work: impl FnOnce() -> T) -> T {
    let outer = MANNER.fetch_max(manner as u8, Ordering::SeqCst);
    let result = work();
    MANNER.store(outer, Ordering::SeqCst);
    result
}

/// What the last message says about the outputs, if they are there.
pub(crate) fn remark(text: String) {
    *REMARK.lock().unwrap_or_else(PoisonError::into_inner) = text;
}

/// Whether the program shall end.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed) != 0
}

/// The exit code, if the program shall end.
#[cfg(unix)]
pub(crate) fn code() -> Option<u8> {
    Some(REQUESTED.load(Ordering::SeqCst)).filter(|&code| code != 0)
}

/// Asks the work in progress to end, as a signal would, but not the process.
#[cfg(unix)]
pub(crate) fn request(code: u8) {
    REQUESTED.store(code, Ordering::SeqCst);
}

/// Nothing is asked for, written or to be said: other work begins.
#[cfg(unix)]
pub(crate) fn clear() {
    REQUESTED.store(0, Ordering::SeqCst);
    remark(String::new());
    take_written();
}

/// The message of work that has ended by itself when it [should](request).
#[cfg(unix)]
pub(crate) fn ended() -> String {
    told(&take_written())
}

/// What else to do before the process ends, however it is asked to.
#[cfg(unix)]
pub(crate) fn at_end(work: Option<Box<dyn Fn() + Send>>) {
    *AT_END.lock().unwrap_or_else(PoisonError::into_inner) = work;
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
    let aborted = abort();
    finish();
    output::conclude(&told(&aborted));
    exit(code)
}

/// Leaves without the answer of a process that works for this one.
fn abandon(code: u8) -> ! {
    output::conclude("interrupted: the server goes on until it can end the work");
    exit(code)
}

/// Does what else is to be done.
fn finish() {
    if let Ok(Some(work)) = AT_END.try_lock().as_deref() {
        work();
    }
}

/// What is written, and what can be said of it.
fn told(aborted: &Aborted) -> String {
    // If it is being written, there is no picture.
    let remark = REMARK.try_lock().map(|remark| remark.clone()).unwrap_or_default();
    match aborted.written.is_empty() || remark.is_empty() {
        true => message(aborted),
        false => format!("{}; {remark}", message(aborted)),
    }
}

/// What to do instead of exiting when memory has run out, which a text says.
#[cfg(unix)]
static AGAIN: Mutex<Option<Again>> = Mutex::new(None);

#[cfg(unix)]
type Again = Box<dyn FnOnce(&str) + Send>;

/// Does this instead of exiting when memory has run out.
#[cfg(unix)]
pub(crate) fn begin_again(again: Again) {
    *AGAIN.lock().unwrap_or_else(PoisonError::into_inner) = Some(again);
}

/// The same for another reason, which is the message, unless it is known that outputs are there.
pub(crate) fn end(code: u8, reason: &str) -> ! {
    match abort() {
        aborted if aborted == Aborted::default() => output::conclude(reason),
        aborted => output::conclude(&format!("{reason}; {}", message(&aborted))),
    }
    #[cfg(unix)]
    if let Some(begin) = AGAIN.lock().unwrap_or_else(PoisonError::into_inner).take() {
        begin(reason);
    }
    finish();
    exit(code)
}

fn message(Aborted { written, partial, .. }: &Aborted) -> String {
    let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    let whole = match &names[..] {
        [] => "nothing was written".to_owned(),
        [first, .., last] if names.len() > LISTED => format!("written: {} files, {first} to {last}", names.len()),
        names => format!("written: {}", names.join(", ")),
    };
    let part = |path: &Path| format!("interrupted: {whole}, and part of an output to {}", path.display());
    partial.as_deref().map_or_else(|| format!("interrupted: {whole}"), part)
}

/// Calls `end` with an exit code for each request, on a thread of its own.
#[cfg(unix)]
fn listen(end: impl Fn(u8) + Send + 'static) -> Result<(), Failure> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    // A file that exceeds the limit of the shell is an error of its output, as a full disk is: the signal has no other effect, and programs
    // that are started do not inherit it, as they would one that is ignored.
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;
    // One that is ignored stays so: nohup and shells ask for it.
    let signals = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal));
    let mut signals = signal_hook::iterator::Signals::new(signals)?;
    let each = move || signals.forever().for_each(|signal| end(128 + signal as u8));
    thread::Builder::new().name("signals".to_owned()).spawn(each)?;
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
        let mut state = Aborted::default();
        assert_eq!(message(&state), "interrupted: nothing was written");
        state.written = ["a.png", "a.json"].map(PathBuf::from).into();
        assert_eq!(message(&state), "interrupted: written: a.png, a.json");
        state.written = (1..=40).map(|number| format!("f.{number}.png").into()).collect();
        assert_eq!(message(&state), "interrupted: written: 40 files, f.1.png to f.40.png");
        state.written.truncate(2);
        state.partial = Some("/dev/stdout".into());
        assert_eq!(message(&state), "interrupted: written: f.1.png, f.2.png, and part of an output to /dev/stdout");
    }
}
