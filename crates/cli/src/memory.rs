//! The end of memory: an allocation that would exceed the limit, or that the system refuses, ends the program like a signal does.
//!
//! Libraries ask before they allocate much whose size they know, and their errors say what it was. This is for all the rest: nobody
//! knows beforehand what a parser needs for a hundred megabytes of brackets.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread::{self, Thread};
use std::time::Duration;

use lightmesh::request::value::ByteSize;
use lightmesh_memory::{Budget, Bytes, Counting, Refused, held, resident, set_ceiling};

use crate::failure::UNABLE;
use crate::interrupt;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What the program holds apart from what it allocates, beyond that at its start: stacks, and code that is not loaded yet.
const OUTSIDE: u64 = 16 << 20;
/// What was held apart at the start.
static BEFORE: OnceLock<u64> = OnceLock::new();
/// One part in this many of a limit is for gaps between allocated blocks.
const GAPS: u64 = 16;
/// How long the message may take if the thread that wants memory holds what it waits for.
const PATIENCE: Duration = Duration::from_secs(2);

static REFUSED: OnceLock<Refused> = OnceLock::new();
/// The thread that ends the program.
static ENDING: OnceLock<Thread> = OnceLock::new();
/// What the program does.
static TASK: Mutex<String> = Mutex::new(String::new());

/// Whether the command has a flag for the limit.
static HAS_FLAG: AtomicBool = AtomicBool::new(false);

/// From now on the program ends if it needs more memory than its [limit], which is that of the command's flag, if it has one.
pub(crate) fn watch(flag: Option<Option<ByteSize>>) -> io::Result<()> {
    BEFORE.get_or_init(|| resident().unwrap_or(0).saturating_sub(held()));
    let ending = thread::Builder::new().name("memory".to_owned()).spawn(|| {
        loop {
            if let Some(refused) = REFUSED.get() {
                interrupt::end(UNABLE, &message(refused, &task(), HAS_FLAG.load(Ordering::Relaxed)));
            }
            thread::park();
        }
    })?;
    // If there is one already, it serves.
    let _ = ENDING.set(ending.thread().clone());
    limit(flag);
    Ok(())
}

/// From now on the program holds at most what a command's flag says, if it has one; without a limit, what is free, less a reserve.
pub(crate) fn limit(flag: Option<Option<ByteSize>>) {
    HAS_FLAG.store(flag.is_some(), Ordering::Relaxed);
    let ceiling = match flag.flatten() {
        Some(ByteSize(limit)) => {
            let outside = BEFORE.get().copied().unwrap_or(0) + OUTSIDE;
            limit.saturating_sub(limit / GAPS + outside)
        }
        None => Budget::default().left().map_or(u64::MAX - 1, |left| held().saturating_add(left)),
    };
    set_ceiling(ceiling, end);
}

/// Does `work`, which messages call `task`: "reading a.obj".
pub(crate) fn during<T>(task: impl Into<String>, work: impl FnOnce() -> T) -> T {
    let outer = std::mem::replace(&mut *locked(), task.into());
    let result = work();
    *locked() = outer;
    result
}

fn locked() -> std::sync::MutexGuard<'static, String> {
    TASK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the program does, as messages call it; empty if that is just being changed.
pub(crate) fn task() -> String {
    TASK.try_lock().map(|task| task.clone()).unwrap_or_default()
}

/// Lets the other thread end the program: this one may hold any lock.
fn end(refused: Refused) -> ! {
    let _ = REFUSED.set(refused);
    if let Some(ending) = ENDING.get() {
        ending.unpark();
    }
    thread::sleep(PATIENCE);
    interrupt::exit(UNABLE)
}

fn message(&Refused { needed, held, ceiling }: &Refused, task: &str, has_flag: bool) -> String {
    let task = if task.is_empty() { "this" } else { task };
    let (needed, held) = (Bytes(needed), Bytes(held));
    let why = match ceiling {
        Some(ceiling) => format!("{needed} more are needed, and {held} of {} are in use", Bytes(ceiling)),
        None => format!("the system refuses {needed} more than the {held} in use"),
    };
    let remedy = if has_flag {
        "raise the limit, or choose less (--memory-limit)"
    } else {
        "end other programs, or choose less"
    };
    format!("error: there is not enough memory for {task}: {why}; {remedy}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_says_what_how_much_and_the_flag() {
        let refused = Refused { needed: 3 << 30, held: 200 << 20, ceiling: Some(256 << 20) };
        assert_eq!(
            message(&refused, "reading a.toml", true),
            "error: there is not enough memory for reading a.toml: 3.0 GiB more are needed, and 200 MiB of 256 MiB are in use; raise \
             the limit, or choose less (--memory-limit)"
        );
        let refused = Refused { ceiling: None, ..refused };
        assert!(
            message(&refused, "", false)
                .contains("memory for this: the system refuses 3.0 GiB more than the 200 MiB in use; end")
        );
    }

    #[test]
    fn tasks_nest() {
        let inner = during("outer", || (during("inner", task), task()));
        assert_eq!(inner, ("inner".to_owned(), "outer".to_owned()));
        assert_eq!(task(), "");
    }
}
