//! The interface between the backend and a device.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

/// A number that is unique in this process.
pub fn new_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// A kernel: the module that contains it (the stage's folder) and its name there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// Module, `short_tests` for instance: its PTX is one file.
    pub module: &'static str,
    /// Name of the function.
    pub name: &'static str,
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}::{}", self.module, self.name)
    }
}

/// The dimensions of a launch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Launch {
    /// Thread blocks.
    pub blocks: u32,
    /// Threads per block.
    pub threads: u32,
    /// Bytes of dynamic shared memory per block.
    pub shared: u32,
}

/// Why an operation on a device failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Out of memory.
    OutOfMemory {
        /// Bytes that are free, if the device reports them.
        free: Option<u64>,
    },
    /// Any other error, as described by the driver, with the operation that failed.
    Failed(String),
}

/// A device: memory, kernels, a queue (stream) that they run in, and a clock.
///
/// All work is queued in the order of the calls. Only [`read`](Runtime::read) and [`seconds`](Runtime::seconds) wait for it.
pub trait Runtime: Send + Sync + 'static {
    /// Device memory; freed when dropped, after the work queued before.
    type Memory: Send + Sync;
    /// A point in the queue.
    type Mark: Send;

    /// The vendor's name for the device.
    fn name(&self) -> String;

    /// Distinguishes devices that hold their own copies of a scene: a [`new_id`].
    fn id(&self) -> u64;

    /// Whether it has the kernels that test every triangle: the reference of tests.
    fn has_brute_force(&self) -> bool;

    /// Bytes that can still be allocated.
    fn free_memory(&self) -> Option<u64>;

    /// Allocates `bytes` bytes, at least one; aligned to 256 bytes, content undefined.
    fn allocate(&self, bytes: u64) -> Result<Self::Memory, Fault>;

    /// Its device address.
    fn address(&self, memory: &Self::Memory) -> u64;

    /// Sets `bytes` bytes at `offset` to zero.
    fn clear(&self, memory: &Self::Memory, offset: u64, bytes: u64) -> Result<(), Fault>;

    /// Copies `bytes` to the device. `bytes` may be changed as soon as this returns.
    fn write(&self, memory: &Self::Memory, offset: u64, bytes: &[u8]) -> Result<(), Fault>;

    /// Waits for all work queued before and copies from the device.
    fn read(&self, memory: &Self::Memory, offset: u64, bytes: &mut [u8]) -> Result<(), Fault>;

    /// Sets the beginning of a `__constant__` variable of a module.
    fn constant(&self, module: &'static str, name: &'static str, bytes: &[u8]) -> Result<(), Fault>;

    /// Queues a kernel whose only parameter is a record with these bytes.
    fn launch(&self, kernel: Kernel, launch: Launch, arguments: &[u8]) -> Result<(), Fault>;

    /// Marks the current end of the queue.
    fn mark(&self) -> Result<Self::Mark, Fault>;

    /// Waits for `to` and returns the seconds between two marks.
    fn seconds(&self, from: &Self::Mark, to: &Self::Mark) -> Result<f64, Fault>;
}
