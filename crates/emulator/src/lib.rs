//! Runs the renderer's CUDA kernels on the host, so that a machine without a GPU tests every launch, buffer and kernel.
//!
//! # Use
//!
//! [`Emulator`] is a [`Runtime`]: code that is generic over that trait runs on it as on a device.
//!
//! ```
//! use std::sync::Arc;
//! use lightmesh_emulator::Emulator;
//! use lightmesh_render::cuda::Pool;
//!
//! let pool = Pool::new(Arc::new(Emulator::new()));
//! let values = pool.upload("values", &[1u32, 2, 3])?;
//! assert_eq!(values.read()?, [1, 2, 3]);
//! # Ok::<(), lightmesh_render::RenderError>(())
//! ```
//!
//! A kernel file is any `.cu` under `crates/render/src`; `build.rs` finds it, and compiles it with `shim/shim.h` in place of CUDA. The
//! module is named after the folder of a `kernel.cu`, and after the file otherwise. `LIGHTMESH_EMULATE=primary_rays,scan cargo test -p
//! lightmesh-emulator` builds only these modules; then launches of others fail. If no C++ compiler works, all do, and tests are ignored:
//! `LIGHTMESH_REQUIRE_CXX=1` makes that an error. A CUDA name that the shim lacks does not compile: add
//! it to `shim/numbers.h`, `shim/atomics.h` or `shim/collectives.h`.
//!
//! # Detected errors
//!
//! A launch returns [`Fault::Failed`] with kernel, block and thread if
//! - a thread waits at a collective or barrier that another does not reach (stricter than CUDA: all lanes of a mask, and all threads
//!   of a block at a barrier, must arrive; those that have exited do not);
//! - a lane is not in its own mask, or shuffles from a lane outside it;
//! - something was written up to 4 KiB before or after an allocation, or after a shared variable;
//! - a thread reads or writes unmapped memory, such as an address that was never set;
//! - a block needs more than 64 KiB of shared memory, or 48 KiB of declared variables, or a thread more than 128 KiB of stack;
//! - the launch does not match the kernel: size of the arguments, number of threads per block.
//!
//! Uninitialised memory, shared memory, local variables and constants contain poison: NaN as a float, far out of range as an index, so
//! that it shows in the results. Blocks with odd numbers run their threads in reverse order, and blocks run on all CPU cores: results
//! that depend on an order differ from the twin's.
//!
//! It does not detect races that all these orders hide, nor reads past an allocation: they return poison, or other data. A loop that
//! spins until another thread of the block has written something never ends.
//!
//! # Numbers
//!
//! `f32` operations, including division and square root, give the bits of a device: nothing is fused or reordered. `sinf`, `cosf`,
//! `powf` and `cbrtf` are the host's and may differ in the last bits. Convert floats that may be out of range by `__float2int_rz` and
//! similar functions; a cast of such a float has a different result on the host.
#![cfg(unix)]

mod host;
mod launch;
mod memory;

use std::collections::{BTreeMap, HashMap};

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use lightmesh_render::cuda::{Fault, Kernel, Launch, Runtime, new_id};

use crate::memory::Ledger;
pub use crate::memory::Memory;

/// An emulated CUDA device.
pub struct Emulator {
    id: u64,
    ledger: Arc<Ledger>,
    /// Work is done when it is queued, one operation at a time.
    queue: Mutex<Queue>,
    brute_force: bool,
    slow: bool,
}

#[derive(Default)]
struct Queue {
    /// The values of the constants that were set, by module and name.
    constants: HashMap<(&'static str, &'static str), Vec<u8>>,
    traffic: Traffic,
}

/// The operations that went through the queue.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Bytes written by the host, including constants.
    pub written: u64,
    /// Bytes read by the host.
    pub read: u64,
    /// Number of attempted allocations.
    pub allocations: u64,
    /// Launches by kernel, in the order of the names.
    pub launches: BTreeMap<String, u64>,
}

impl Default for Emulator {
    fn default() -> Emulator {
        Emulator::new()
    }
}

impl Emulator {
    /// A device with as much memory as the host has; it does not report how much.
    pub fn new() -> Emulator {
        Emulator::with_ledger(Ledger::default())
    }

    /// A device with this much memory.
    pub fn with_memory(bytes: u64) -> Emulator {
        Emulator::with_ledger(Ledger::new(Some(bytes)))
    }

    /// The same without the kernels that no device has: those that test every triangle.
    pub fn without_brute_force(self) -> Emulator {
        Emulator { brute_force: false, ..self }
    }

    /// The same with a clock by which each launch takes a second: from the second image on, launches are as short as they can be.
    pub fn slow(self) -> Emulator {
        Emulator { slow: true, ..self }
    }

    fn with_ledger(ledger: Ledger) -> Emulator {
        #[cfg(needs_fma)]
        assert!(
            is_x86_feature_detected!("fma") && is_x86_feature_detected!("popcnt"),
            "the emulated kernels were compiled on a newer processor; compile them here: cargo clean -p lightmesh-emulator"
        );
        Emulator { id: new_id(), ledger: Arc::new(ledger), queue: Mutex::default(), brute_force: true, slow: false }
    }

    /// Makes the `number`-th allocation from now on fail, where 1 is the next; those after it succeed.
    pub fn fail_allocation(&self, number: u64) {
        self.ledger.fail_allocation(number);
    }

    /// Bytes in use.
    pub fn taken(&self) -> u64 {
        self.ledger.taken()
    }

    /// The operations since the last call.
    pub fn take_traffic(&self) -> Traffic {
        std::mem::take(&mut self.queue().traffic)
    }

    /// Whether a kernel was compiled.
    pub fn has(kernel: Kernel) -> bool {
        host::modules().kernels.contains_key(&(kernel.module, kernel.name))
    }

    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Runtime for Emulator {
    type Memory = Memory;
    type Mark = Instant;

    fn name(&self) -> String {
        "emulated CUDA device".to_owned()
    }

    fn id(&self) -> u64 {
        self.id
    }

    fn has_brute_force(&self) -> bool {
        self.brute_force
    }

    fn free_memory(&self) -> Option<u64> {
        self.ledger.free()
    }

    fn allocate(&self, bytes: u64) -> Result<Memory, Fault> {
        if bytes == 0 {
            return Err(Fault::Failed("an allocation of zero bytes".to_owned()));
        }
        self.queue().traffic.allocations += 1;
        Memory::new(&self.ledger, bytes)
    }

    fn address(&self, memory: &Memory) -> u64 {
        memory.address()
    }

    fn clear(&self, memory: &Memory, offset: u64, bytes: u64) -> Result<(), Fault> {
        let _queue = self.queue();
        let bytes = bytes as usize;
        let start = memory.range(offset, bytes)?;
        // SAFETY: within the memory, and no kernel runs while the queue is locked.
        unsafe { start.write_bytes(0, bytes) };
        Ok(())
    }

    fn write(&self, memory: &Memory, offset: u64, bytes: &[u8]) -> Result<(), Fault> {
        let mut queue = self.queue();
        let start = memory.range(offset, bytes.len())?;
        // SAFETY: as above; the host's bytes are elsewhere.
        unsafe { start.copy_from_nonoverlapping(std::ptr::NonNull::from(bytes).cast(), bytes.len()) };
        queue.traffic.written += bytes.len() as u64;
        Ok(())
    }

    fn read(&self, memory: &Memory, offset: u64, bytes: &mut [u8]) -> Result<(), Fault> {
        let mut queue = self.queue();
        let start = memory.range(offset, bytes.len())?;
        // SAFETY: as above.
        unsafe { start.copy_to_nonoverlapping(std::ptr::NonNull::from(&mut *bytes).cast(), bytes.len()) };
        queue.traffic.read += bytes.len() as u64;
        Ok(())
    }

    fn constant(&self, module: &'static str, name: &'static str, bytes: &[u8]) -> Result<(), Fault> {
        let failed = |why: String| Fault::Failed(format!("constant {module}::{name}: {why}"));
        let constant =
            host::modules().constants.get(&(module, name)).ok_or_else(|| failed("there is none".to_owned()))?;
        if bytes.len() > constant.bytes {
            return Err(failed(format!("{} bytes do not fit into {}", bytes.len(), constant.bytes)));
        }
        let mut queue = self.queue();
        let image = queue.constants.entry((module, name)).or_insert_with(|| launch::poisoned(constant.bytes));
        image[..bytes.len()].copy_from_slice(bytes);
        queue.traffic.written += bytes.len() as u64;
        Ok(())
    }

    fn launch(&self, kernel: Kernel, launch: Launch, arguments: &[u8]) -> Result<(), Fault> {
        if launch.blocks == 0 {
            return Ok(());
        }
        let mut queue = self.queue();
        launch::run(kernel, launch, arguments, &queue.constants)?;
        self.ledger.check().map_err(|fault| launch::during(kernel, fault))?;
        *queue.traffic.launches.entry(kernel.to_string()).or_default() += 1;
        Ok(())
    }

    fn mark(&self) -> Result<Instant, Fault> {
        Ok(Instant::now())
    }

    fn seconds(&self, from: &Instant, to: &Instant) -> Result<f64, Fault> {
        Ok(if self.slow { 1.0 } else { to.duration_since(*from).as_secs_f64() })
    }
}
