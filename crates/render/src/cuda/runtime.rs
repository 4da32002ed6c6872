//! The boundary between the backend and a device.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

/// A number that no other device of this process has.
pub fn new_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// A kernel: the module that holds it (the stage's folder) and its name there.
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

/// How many threads a launch has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Launch {
    /// Thread blocks.
    pub blocks: u32,
    /// Threads of a block.
    pub threads: u32,
    /// Bytes of dynamic shared memory of a block.
    pub shared: u32,
}

/// What a device could not do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Memory is used up.
    OutOfMemory {
        /// Bytes that are free, where the device tells.
        free: Option<u64>,
    },
    /// Anything else, in the words of the driver, with what was being done.
    Failed(String),
}

/// A device: memory, kernels, a queue that they run in, and a clock.
///
/// All work is queued in the order of the calls. Only [`read`](Runtime::read) and [`seconds`](Runtime::seconds) wait for it.
pub trait Runtime: Send + Sync + 'static {
    /// Device memory; freed when dropped, after the work queued before.
    type Memory: Send + Sync;
    /// A moment in the queue.
    type Mark: Send;

    /// What the maker calls the device.
    fn name(&self) -> String;

    /// Tells devices apart that hold their own copies of a scene: a [`new_id`].
    fn id(&self) -> u64;

    /// Bytes that can still be allocated.
    fn free_memory(&self) -> Option<u64>;

    /// Takes `bytes` of memory, at least one; aligned to 256 bytes, content undefined.
    fn allocate(&self, bytes: u64) -> Result<Self::Memory, Fault>;

    /// Its device address.
    fn address(&self, memory: &Self::Memory) -> u64;

    /// Sets `bytes` bytes from `offset` on to zero.
    fn clear(&self, memory: &Self::Memory, offset: u64, bytes: u64) -> Result<(), Fault>;

    /// Copies `bytes` to the device. `bytes` may be changed as soon as this returns.
    fn write(&self, memory: &Self::Memory, offset: u64, bytes: &[u8]) -> Result<(), Fault>;

    /// Waits for all work queued before and copies from the device.
    fn read(&self, memory: &Self::Memory, offset: u64, bytes: &mut [u8]) -> Result<(), Fault>;

    /// Sets the beginning of a `__constant__` variable of a module.
    fn constant(&self, module: &'static str, name: &'static str, bytes: &[u8]) -> Result<(), Fault>;

    /// Queues a kernel whose one parameter is a record with these bytes.
    fn launch(&self, kernel: Kernel, launch: Launch, arguments: &[u8]) -> Result<(), Fault>;

    /// Marks the present moment of the queue.
    fn mark(&self) -> Result<Self::Mark, Fault>;

    /// Waits for `to` and gives the seconds between two marks.
    fn seconds(&self, from: &Self::Mark, to: &Self::Mark) -> Result<f64, Fault>;
}
