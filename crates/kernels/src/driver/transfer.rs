//! Copies between host and device through page-locked memory.
//!
//! The device can access only page-locked host memory. For pageable memory, the driver copies piece by piece on one thread, while
//! the bus waits. Here several pieces are in flight while all threads copy the others.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cudarc::driver::result;
use cudarc::driver::sys::{CUdeviceptr, CUevent_flags};
use rayon::prelude::*;

use super::context::Context;
use super::mark::Event;
use crate::runtime::Fault;

/// Bytes per piece: long enough that the start-up cost of a copy does not matter.
const PIECE: usize = 4 << 20;

/// Number of pieces in flight at once, which are kept for the next copy.
const PIECES: usize = 4;

/// Bytes that one thread copies at a time.
const GRAIN: usize = 256 << 10;

/// Page-locked staging memory. No lock is held while a copy runs, so that copies may run concurrently, and in any nesting that a
/// thread pool produces.
pub(super) struct Staging {
    context: Arc<Context>,
    /// Pieces that nobody fills or empties; the device may still be reading them. Oldest first.
    idle: Mutex<VecDeque<Piece>>,
}

impl Staging {
    /// Nothing is locked before the first copy.
    pub(super) fn new(context: &Arc<Context>) -> Staging {
        Staging { context: Arc::clone(context), idle: Mutex::default() }
    }

    /// Queues a copy to the device. The bytes may be changed when this returns.
    pub(super) fn upload(&self, address: CUdeviceptr, bytes: &[u8]) -> Result<(), Fault> {
        for (part, address) in bytes.chunks(PIECE).zip((address..).step_by(PIECE)) {
            let mut piece = self.take()?;
            let staged = &mut piece.bytes()[..part.len()];
            copy(staged, part);
            // SAFETY: the caller has checked the address; the piece stays alive until its event is reached.
            let queue = |stream| unsafe { result::memcpy_htod_async(address, staged, stream) };
            self.context.run(|| format!("copying {} bytes to the device", bytes.len()), queue)?;
            piece.event.record()?;
            self.give_back(piece);
        }
        Ok(())
    }

    /// Waits for all work queued before, and copies from the device.
    pub(super) fn download(&self, address: CUdeviceptr, bytes: &mut [u8]) -> Result<(), Fault> {
        let length = bytes.len();
        let mut coming: VecDeque<(Piece, &mut [u8])> = VecDeque::with_capacity(PIECES);
        for (part, address) in bytes.chunks_mut(PIECE).zip((address..).step_by(PIECE)) {
            if coming.len() == PIECES {
                self.receive(&mut coming)?;
            }
            let mut piece = self.take()?;
            let staged = &mut piece.bytes()[..part.len()];
            // SAFETY: the caller has checked the address; the piece stays alive until its event is reached.
            let queue = |stream| unsafe { result::memcpy_dtoh_async(staged, address, stream) };
            self.context.run(|| format!("copying {length} bytes from the device"), queue)?;
            piece.event.record()?;
            coming.push_back((piece, part));
        }
        while !coming.is_empty() {
            self.receive(&mut coming)?;
        }
        Ok(())
    }

    /// Waits for the oldest piece and empties it.
    fn receive(&self, coming: &mut VecDeque<(Piece, &mut [u8])>) -> Result<(), Fault> {
        let Some((mut piece, part)) = coming.pop_front() else { return Ok(()) };
        piece.event.wait()?;
        copy(part, &piece.bytes()[..part.len()]);
        self.give_back(piece);
        Ok(())
    }

    /// A piece that the device has finished with.
    fn take(&self) -> Result<Piece, Fault> {
        let piece = {
            let mut idle = self.idle();
            let usable = idle.len() >= PIECES || idle.front().is_some_and(|piece| piece.event.has_come());
            if usable { idle.pop_front() } else { None }
        };
        match piece {
            Some(piece) => piece.event.wait().map(|()| piece),
            None => Piece::new(&self.context),
        }
    }

    fn give_back(&self, piece: Piece) {
        let mut idle = self.idle();
        if idle.len() < PIECES {
            idle.push_back(piece);
        }
    }

    fn idle(&self) -> MutexGuard<'_, VecDeque<Piece>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Page-locked memory.
struct Piece {
    context: Arc<Context>,
    start: *mut u8,
    /// Reached when the device has finished with it.
    event: Event,
}

// SAFETY: the memory belongs to the piece.
unsafe impl Send for Piece {}

impl Piece {
    fn new(context: &Arc<Context>) -> Result<Piece, Fault> {
        let event = Event::new(context, CUevent_flags::CU_EVENT_DISABLE_TIMING)?;
        let what = || format!("locking {PIECE} bytes of host memory");
        // SAFETY: the memory belongs to nobody else, and is freed in `drop`.
        let start = context.run(what, |_| unsafe { result::malloc_host(PIECE, 0) })?.cast::<u8>();
        // SAFETY: the allocation has this size. It is written once, so that it may be read.
        unsafe { start.write_bytes(0, PIECE) };
        Ok(Piece { context: Arc::clone(context), start, event })
    }

    /// The memory. The device must have finished with it.
    fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: the allocation has this size and is initialised, and the slice borrows the piece.
        unsafe { std::slice::from_raw_parts_mut(self.start, PIECE) }
    }
}

impl Drop for Piece {
    fn drop(&mut self) {
        // A copy that failed half-way may still be running.
        let _ = self.context.wait();
        // SAFETY: from `malloc_host`, and nobody uses it any more.
        let _ = self.context.call(|_| unsafe { result::free_host(self.start.cast()) });
    }
}

/// Copies with all threads where it pays. The system provides fresh memory page by page as it is written, and that takes longer
/// than the copy.
fn copy(to: &mut [u8], from: &[u8]) {
    if from.len() <= GRAIN {
        to.copy_from_slice(from);
    } else {
        let pairs = to.par_chunks_mut(GRAIN).zip(from.par_chunks(GRAIN));
        pairs.for_each(|(to, from)| to.copy_from_slice(from));
    }
}
