//! A device ready for use: its context, one stream, and a memory pool.

use std::ptr;
use std::sync::{Mutex, MutexGuard, PoisonError};

use cudarc::driver::result::{self, stream};
use cudarc::driver::sys::{
    CUcontext, CUdevice, CUmemAllocationHandleType, CUmemAllocationType, CUmemLocation, CUmemLocationType,
    CUmemPool_attribute as PoolAttribute, CUmemPoolProps, CUmemoryPool, CUstream,
};
use cudarc::driver::{DriverError, result::mem_pool};

use super::fault::failed;
use crate::gpu::Gpu;
use crate::runtime::{Fault, Kernel};

/// What all operations on a device need. Everything that lives on the device keeps this alive.
pub(super) struct Context {
    device: CUdevice,
    handle: CUcontext,
    /// All work is queued here. It does not synchronise with the streams of others.
    stream: CUstream,
    /// Absent if the device has no stream-ordered memory.
    pool: Option<CUmemoryPool>,
    /// Bytes of memory on the device.
    memory: u64,
    /// The kernel launched last, for messages.
    last_kernel: Mutex<Option<Kernel>>,
}

// SAFETY: the handles name driver objects, which may be used from any thread; the driver does the necessary locking.
unsafe impl Send for Context {}
// SAFETY: as above.
unsafe impl Sync for Context {}

impl Context {
    /// Retains the device's primary context, which is shared with everyone else in the process, and creates a separate stream
    /// and pool in it.
    pub(super) fn new(gpu: &Gpu) -> Result<Context, Fault> {
        // SAFETY: the driver returned this device.
        let handle = unsafe { result::primary_ctx::retain(gpu.handle) };
        let handle = handle.map_err(|error| failed("creating a context", error, None))?;
        // From here on `drop` releases what exists.
        let mut context = Context {
            device: gpu.handle,
            handle,
            stream: ptr::null_mut(),
            pool: None,
            memory: gpu.memory,
            last_kernel: Mutex::new(None),
        };
        context.stream =
            context.run(|| "creating a stream".to_owned(), |_| stream::create(stream::StreamKind::NonBlocking))?;
        if gpu.pools {
            context.pool = Some(context.run(|| "creating a memory pool".to_owned(), |_| pool_on(gpu.handle))?);
        }
        Ok(context)
    }

    /// Makes a call in this context, on any thread.
    pub(super) fn call<T>(&self, call: impl FnOnce(CUstream) -> Result<T, DriverError>) -> Result<T, DriverError> {
        // SAFETY: retained, and not released before `drop`.
        unsafe { result::ctx::set_current(self.handle) }?;
        call(self.stream)
    }

    /// Makes a call; `what` names it in the error.
    pub(super) fn run<T>(
        &self,
        what: impl FnOnce() -> String,
        call: impl FnOnce(CUstream) -> Result<T, DriverError>,
    ) -> Result<T, Fault> {
        self.call(call).map_err(|error| failed(&what(), error, *self.last_kernel()))
    }

    /// Waits for all work queued before.
    pub(super) fn wait(&self) -> Result<(), DriverError> {
        // SAFETY: the stream lives as long as the context.
        self.call(|stream| unsafe { stream::synchronize(stream) })
    }

    /// The kernel launched last.
    pub(super) fn last_kernel(&self) -> MutexGuard<'_, Option<Kernel>> {
        self.last_kernel.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The pool to allocate from, if there is one.
    pub(super) fn pool(&self) -> Option<CUmemoryPool> {
        self.pool
    }

    /// Bytes of memory on the device, free or not.
    pub(super) fn memory(&self) -> u64 {
        self.memory
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // Errors cannot be reported from here: each step is attempted whatever happened to the one before.
        let _ = self.wait();
        if let Some(pool) = self.pool {
            // SAFETY: created in `new`; all memory from it has been freed, since that memory holds the context.
            let _ = self.call(|_| unsafe { mem_pool::destroy(pool) });
        }
        if !self.stream.is_null() {
            // SAFETY: created in `new`, and idle.
            let _ = self.call(|stream| unsafe { stream::destroy(stream) });
        }
        // SAFETY: retained in `new`.
        let _ = unsafe { result::primary_ctx::release(self.device) };
    }
}

/// A pool that keeps freed memory, so that the next allocation is cheap.
fn pool_on(device: CUdevice) -> Result<CUmemoryPool, DriverError> {
    let location = CUmemLocation { type_: CUmemLocationType::CU_MEM_LOCATION_TYPE_DEVICE, id: device };
    let properties = CUmemPoolProps {
        allocType: CUmemAllocationType::CU_MEM_ALLOCATION_TYPE_PINNED,
        handleTypes: CUmemAllocationHandleType::CU_MEM_HANDLE_TYPE_NONE,
        location,
        win32SecurityAttributes: ptr::null_mut(),
        reserved: [0; 64],
    };
    // SAFETY: the properties are fully initialised, zero where the default is wanted.
    let pool = unsafe { mem_pool::create(&properties) }?;
    let mut threshold = u64::MAX;
    let attribute = PoolAttribute::CU_MEMPOOL_ATTR_RELEASE_THRESHOLD;
    // SAFETY: this attribute is a 64-bit number.
    let set = unsafe { mem_pool::set_attribute(pool, attribute, (&raw mut threshold).cast()) };
    if set.is_err() {
        // SAFETY: created above, and empty.
        let _ = unsafe { mem_pool::destroy(pool) };
    }
    set.map(|()| pool)
}
