//! Memory that behaves like a device's: poisoned, guarded, and as small as a test requires.

use std::alloc::Layout;
use std::collections::BTreeMap;
use std::ptr::NonNull;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use lightmesh_render::cuda::Fault;

/// Content of fresh memory, word by word: NaN as `f32` and `f64`, far out of range as an index or an address.
pub(crate) const POISON: u32 = 0xfffa_5a5a;

/// Bytes before and after every allocation that nobody may write to. A multiple of the alignment.
const ZONE: usize = 4096;
/// Their content.
const ZONE_BYTE: u8 = 0xd7;
/// As for `cuMemAlloc`.
const ALIGNMENT: usize = 256;

/// All memory of an emulated device.
#[derive(Default)]
pub(crate) struct Ledger(Mutex<State>);

#[derive(Default)]
struct State {
    /// Sizes by address.
    live: BTreeMap<usize, usize>,
    taken: u64,
    limit: Option<u64>,
    /// Number of allocations until one fails; 0 if none is to fail.
    countdown: u64,
}

/// An allocation of an emulated device; freed when dropped.
pub struct Memory {
    /// The first byte of the allocation proper.
    start: NonNull<u8>,
    bytes: usize,
    ledger: Arc<Ledger>,
}

// SAFETY: it owns its bytes. Kernels and the host take turns, as in the queue of a device.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Ledger {
    pub(crate) fn new(limit: Option<u64>) -> Ledger {
        Ledger(Mutex::new(State { limit, ..State::default() }))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Bytes that are free, if there is a limit.
    pub(crate) fn free(&self) -> Option<u64> {
        let state = self.state();
        state.limit.map(|limit| limit.saturating_sub(state.taken))
    }

    /// Bytes in use.
    pub(crate) fn taken(&self) -> u64 {
        self.state().taken
    }

    /// Makes the `number`-th allocation from now on fail: 1 is the next.
    pub(crate) fn fail_allocation(&self, number: u64) {
        self.state().countdown = number;
    }

    /// Fails if memory outside an allocation was overwritten, and names the allocation.
    pub(crate) fn check(&self) -> Result<(), Fault> {
        for (&address, &bytes) in &self.state().live {
            // SAFETY: the allocation is live, since it leaves the ledger before it is freed, and the ledger is locked.
            let (before, behind) = unsafe {
                let behind = zone_behind(bytes);
                let start = address as *const u8;
                (
                    std::slice::from_raw_parts(start.sub(ZONE), ZONE),
                    std::slice::from_raw_parts(start.add(bytes), behind),
                )
            };
            let broken = |zone: &[u8]| {
                // All bytes are equal if each is equal to the next; comparing slices takes a tenth of the time of a search.
                let whole = zone[0] == ZONE_BYTE && zone[1..] == zone[..zone.len() - 1];
                if whole { None } else { zone.iter().position(|&byte| byte != ZONE_BYTE) }
            };
            if let Some(at) = broken(behind) {
                return Err(Fault::Failed(format!(
                    "something was written {at} bytes past the end of {bytes} bytes of memory"
                )));
            }
            if let Some(at) = broken(before) {
                let distance = ZONE - at;
                return Err(Fault::Failed(format!(
                    "something was written {distance} bytes before {bytes} bytes of memory"
                )));
            }
        }
        Ok(())
    }
}

/// Bytes after an allocation: a zone, and padding to a multiple of the alignment.
fn zone_behind(bytes: usize) -> usize {
    ZONE + bytes.next_multiple_of(ALIGNMENT) - bytes
}

/// The layout of the host allocation, if it is possible.
fn layout(bytes: u64) -> Option<Layout> {
    let bytes = usize::try_from(bytes).ok()?.checked_next_multiple_of(ALIGNMENT)?;
    Layout::from_size_align(bytes.checked_add(2 * ZONE)?, ALIGNMENT).ok()
}

impl Memory {
    pub(crate) fn new(ledger: &Arc<Ledger>, bytes: u64) -> Result<Memory, Fault> {
        let mut state = ledger.state();
        let free = state.limit.map(|limit| limit.saturating_sub(state.taken));
        let out_of_memory = || Fault::OutOfMemory { free };
        let chosen = state.countdown == 1;
        state.countdown = state.countdown.saturating_sub(1);
        if chosen || free.is_some_and(|free| bytes > free) {
            return Err(out_of_memory());
        }
        let layout = layout(bytes).ok_or_else(out_of_memory)?;
        // SAFETY: the layout is not empty; it contains at least the zones.
        let base = NonNull::new(unsafe { std::alloc::alloc(layout) }).ok_or_else(out_of_memory)?;
        // SAFETY: all of it lies within the allocation.
        let start = unsafe {
            base.write_bytes(ZONE_BYTE, layout.size());
            base.add(ZONE)
        };
        let bytes = bytes as usize;
        let memory = Memory { start, bytes, ledger: Arc::clone(ledger) };
        memory.poison();
        state.live.insert(memory.address() as usize, bytes);
        state.taken += bytes as u64;
        Ok(memory)
    }

    pub(crate) fn address(&self) -> u64 {
        self.start.as_ptr() as u64
    }

    /// A range of bytes, or an error if it is not within the memory.
    pub(crate) fn range(&self, offset: u64, bytes: usize) -> Result<NonNull<u8>, Fault> {
        let end = usize::try_from(offset).ok().and_then(|offset| offset.checked_add(bytes));
        if end.is_none_or(|end| end > self.bytes) {
            let all = self.bytes;
            return Err(Fault::Failed(format!(
                "{bytes} bytes from byte {offset} on are not within {all} bytes of memory"
            )));
        }
        // SAFETY: within the allocation, as checked above.
        Ok(unsafe { self.start.add(offset as usize) })
    }

    fn poison(&self) {
        const PATTERN: [u32; 1024] = [POISON; 1024];
        for at in (0..self.bytes).step_by(size_of_val(&PATTERN)) {
            let bytes = size_of_val(&PATTERN).min(self.bytes - at);
            // SAFETY: within the allocation; nobody else accesses it now.
            unsafe { self.start.add(at).copy_from_nonoverlapping(NonNull::from(&PATTERN).cast(), bytes) };
        }
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        let mut state = self.ledger.state();
        state.live.remove(&(self.address() as usize));
        state.taken -= self.bytes as u64;
        // Anyone who still reads it gets poison.
        self.poison();
        if let Some(layout) = layout(self.bytes as u64) {
            // SAFETY: allocated with this layout, a zone before `start`.
            unsafe { std::alloc::dealloc(self.start.sub(ZONE).as_ptr(), layout) };
        }
    }
}
