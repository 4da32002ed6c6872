//! A global allocator that counts what it hands out, and ends the program before there is too much.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicI64, AtomicPtr, AtomicU64, Ordering};

use crate::resident;

/// A thread counts for itself up to this many bytes, so that threads do not wait for each other.
const BATCH: i64 = 64 << 10;
/// Smaller allocations are counted, but never refused because of the ceiling: they are those of someone who holds a lock, or writes a
/// message.
const LARGE: u64 = 64 << 10;
/// Kept for the message, and for threads that write it, when the system refuses even small allocations. It is never touched.
const SPARE: usize = 8 << 20;
const SPARE_LAYOUT: Layout = match Layout::from_size_align(SPARE, 16) {
    Ok(layout) => layout,
    Err(_) => unreachable!(),
};

/// Bytes handed out, apart from what threads have not added yet.
static HELD: AtomicI64 = AtomicI64::new(0);
/// Bytes that may be handed out.
static CEILING: AtomicU64 = AtomicU64::new(u64::MAX);
static SPARE_BLOCK: AtomicPtr<u8> = AtomicPtr::new(std::ptr::null_mut());
static END: OnceLock<fn(Refused) -> !> = OnceLock::new();

thread_local! {
    static PENDING: Cell<i64> = const { Cell::new(0) };
}

/// The system's allocator, counted. To be installed with `#[global_allocator]`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counting;

/// An allocation that is not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused {
    /// Its bytes.
    pub needed: u64,
    /// Bytes that the program holds.
    pub held: u64,
    /// Bytes that it may hold; `None` if the system refused.
    pub ceiling: Option<u64>,
}

/// From now on, an allocation that would make the program hold more than `bytes`, or that the system refuses, calls `end`, once or from
/// several threads. It is called wherever memory is allocated, perhaps under a lock: it should leave the work to another thread.
/// Allocations that it makes are not refused.
///
/// `end` is that of the first call. Without [`Counting`] this has no effect.
pub fn set_ceiling(bytes: u64, end: fn(Refused) -> !) {
    if END.set(end).is_ok() {
        // SAFETY: the layout has a size.
        SPARE_BLOCK.store(unsafe { System.alloc(SPARE_LAYOUT) }, Ordering::SeqCst);
    }
    CEILING.store(bytes, Ordering::SeqCst);
}

/// Bytes that the program may hold; `None` if no ceiling is set.
pub fn ceiling() -> Option<u64> {
    Some(CEILING.load(Ordering::Relaxed)).filter(|&bytes| bytes != u64::MAX)
}

/// Bytes that this process holds: those that [`Counting`] has handed out if it is installed, else those that are resident.
pub fn held() -> u64 {
    match HELD.load(Ordering::Relaxed) {
        0 => resident().unwrap_or(0),
        counted => counted.max(0) as u64,
    }
}

/// Adds to the count of bytes, at once or later.
fn count(change: i64) {
    let add = |pending: &Cell<i64>| {
        let sum = pending.get() + change;
        let kept = if sum.abs() < BATCH { sum } else { 0 };
        pending.set(kept);
        sum - kept
    };
    // Without the thread's own count at its end.
    let now = PENDING.try_with(add).unwrap_or(change);
    if now != 0 {
        HELD.fetch_add(now, Ordering::Relaxed);
    }
}

/// Ends the program if `more` bytes exceed the ceiling.
#[inline]
fn check(more: usize) {
    if more as u64 >= LARGE {
        let (held, ceiling) = (HELD.load(Ordering::Relaxed).max(0) as u64, CEILING.load(Ordering::Relaxed));
        if held.saturating_add(more as u64) > ceiling {
            refuse(Refused { needed: more as u64, held, ceiling: Some(ceiling) });
        }
    }
}

/// Ends the program, if it has said how.
#[cold]
fn refuse(refused: Refused) {
    let Some(end) = END.get() else { return };
    CEILING.store(u64::MAX, Ordering::SeqCst);
    let spare = SPARE_BLOCK.swap(std::ptr::null_mut(), Ordering::SeqCst);
    if !spare.is_null() {
        // SAFETY: allocated with this layout, and taken by this thread alone.
        unsafe { System.dealloc(spare, SPARE_LAYOUT) };
    }
    end(refused)
}

/// Counts an allocation that the system has made, or ends the program if it has not.
fn made(block: *mut u8, size: usize, change: i64) -> *mut u8 {
    if block.is_null() {
        refuse(Refused { needed: size as u64, held: held(), ceiling: None });
    } else {
        count(change);
    }
    block
}

// SAFETY: all blocks are the system allocator's, with the caller's layouts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        check(layout.size());
        // SAFETY: the caller's promise.
        made(unsafe { System.alloc(layout) }, layout.size(), layout.size() as i64)
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        check(layout.size());
        // SAFETY: the caller's promise.
        made(unsafe { System.alloc_zeroed(layout) }, layout.size(), layout.size() as i64)
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        check(size.saturating_sub(layout.size()));
        // SAFETY: the caller's promise.
        made(unsafe { System.realloc(block, layout, size) }, size, size as i64 - layout.size() as i64)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(block, layout) };
        count(-(layout.size() as i64));
    }
}
