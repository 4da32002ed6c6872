//! Stream-ordered device memory.
//!
//! Freed memory stays in the pool, so that allocating it again costs microseconds instead of a system call that waits for the
//! device. If the device has no pools, memory is requested from the system each time; freeing it then waits.

use std::sync::Arc;

use cudarc::driver::result::{self, mem_pool, stream};
use cudarc::driver::sys::{CUdeviceptr, CUmemPool_attribute as PoolAttribute, CUmemoryPool, CUresult};
use cudarc::driver::{DriverError, sys};

use super::context::Context;
use crate::runtime::Fault;

/// Memory on a device. It is freed after the work that was queued before the drop.
pub struct DeviceMemory {
    context: Arc<Context>,
    address: CUdeviceptr,
    bytes: u64,
}

impl DeviceMemory {
    /// Allocates `bytes` bytes, at least one.
    pub(super) fn new(context: &Arc<Context>, bytes: u64) -> Result<DeviceMemory, Fault> {
        if bytes > context.memory() {
            return Err(Fault::OutOfMemory { free: free(context) });
        }
        let address = match take(context, bytes) {
            // The memory kept by the pool may be too fragmented: it is returned, and the system provides one contiguous block.
            Err(DriverError(CUresult::CUDA_ERROR_OUT_OF_MEMORY)) => trim(context).and_then(|()| take(context, bytes)),
            taken => taken,
        };
        match address {
            Ok(address) => Ok(DeviceMemory { context: Arc::clone(context), address, bytes }),
            Err(DriverError(CUresult::CUDA_ERROR_OUT_OF_MEMORY)) => Err(Fault::OutOfMemory { free: free(context) }),
            Err(error) => context.run(|| format!("allocating {bytes} bytes"), |_| Err(error)),
        }
    }

    /// Its start address.
    pub(super) fn address(&self) -> CUdeviceptr {
        self.address
    }

    /// The address of `bytes` bytes at `offset`; an error if they are not all inside.
    pub(super) fn place(&self, offset: u64, bytes: u64) -> Result<CUdeviceptr, Fault> {
        let end = offset.checked_add(bytes);
        if end.is_some_and(|end| end <= self.bytes) {
            Ok(self.address + offset)
        } else {
            Err(Fault::Failed(format!(
                "{bytes} bytes from {offset} on are not all in a buffer of {} bytes",
                self.bytes
            )))
        }
    }

    /// Queues setting bytes to zero.
    pub(super) fn clear(&self, offset: u64, bytes: u64) -> Result<(), Fault> {
        let address = self.place(offset, bytes)?;
        // SAFETY: the range is inside the buffer; the stream is the one it was allocated on.
        let clear = |stream| unsafe { result::memset_d8_async(address, 0, bytes as usize, stream) };
        self.context.run(|| format!("clearing {bytes} bytes"), clear)
    }
}

impl Drop for DeviceMemory {
    fn drop(&mut self) {
        // `drop` cannot fail; an error that matters recurs with the next operation.
        let _ = self.context.call(|stream| match self.context.pool() {
            // SAFETY: allocated in `new` from the pool, on this stream.
            Some(_) => unsafe { result::free_async(self.address, stream) },
            // SAFETY: allocated in `new` without a pool.
            None => unsafe { result::free_sync(self.address) },
        });
    }
}

/// Bytes that can still be allocated: free memory of the system, and unused memory of the pool. Waits for the stream, since
/// memory becomes free only when its turn has come.
pub(super) fn free(context: &Context) -> Option<u64> {
    context.wait().ok()?;
    let (free, _) = context.call(|_| result::mem_get_info()).ok()?;
    let kept = context.pool().map_or(Some(0), |pool| {
        let number = |attribute| context.call(|_| pool_number(pool, attribute)).ok();
        let reserved = number(PoolAttribute::CU_MEMPOOL_ATTR_RESERVED_MEM_CURRENT)?;
        Some(reserved.saturating_sub(number(PoolAttribute::CU_MEMPOOL_ATTR_USED_MEM_CURRENT)?))
    })?;
    Some(free as u64 + kept)
}

fn take(context: &Context, bytes: u64) -> Result<CUdeviceptr, DriverError> {
    context.call(|stream| match context.pool() {
        // SAFETY: pool and stream live as long as the context.
        Some(pool) => unsafe { mem_pool::alloc_async(pool, bytes as usize, stream) },
        // SAFETY: the content is undefined, as `Runtime::allocate` says.
        None => unsafe { result::malloc_sync(bytes as usize) },
    })
}

/// Returns unused memory of the pool to the system.
fn trim(context: &Context) -> Result<(), DriverError> {
    context.call(|stream| {
        // SAFETY: the stream lives as long as the context.
        unsafe { stream::synchronize(stream) }?;
        match context.pool() {
            // SAFETY: the pool lives as long as the context.
            Some(pool) => unsafe { mem_pool::trim_to(pool, 0) },
            None => Ok(()),
        }
    })
}

/// One of a pool's byte counts.
fn pool_number(pool: CUmemoryPool, attribute: sys::CUmemPool_attribute) -> Result<u64, DriverError> {
    let mut number = 0_u64;
    // SAFETY: the counts are 64-bit numbers.
    unsafe { mem_pool::get_attribute(pool, attribute, (&raw mut number).cast()) }?;
    Ok(number)
}
