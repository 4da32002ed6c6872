//! Typed arrays in device memory, and accounting of the memory in use.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bytemuck::Pod;
use lightmesh_layout::{In, Out};

use crate::error::DeviceError;
use crate::runtime::{Fault, Runtime};

/// A device's memory, with accounting of the memory in use.
pub struct Pool<R: Runtime> {
    runtime: Arc<R>,
    /// Bytes in use.
    taken: Arc<AtomicU64>,
    /// The largest number of bytes ever in use at once.
    peak: AtomicU64,
    /// The largest number of bytes that may be in use at once.
    limit: AtomicU64,
}

/// `len` values of type `T` on a device; freed when dropped.
pub struct Buffer<R: Runtime, T> {
    runtime: Arc<R>,
    memory: R::Memory,
    len: usize,
    bytes: u64,
    taken: Arc<AtomicU64>,
    content: std::marker::PhantomData<fn() -> T>,
}

impl<R: Runtime> Pool<R> {
    /// A pool with nothing allocated.
    pub fn new(runtime: Arc<R>) -> Pool<R> {
        Pool { runtime, taken: Arc::default(), peak: AtomicU64::new(0), limit: AtomicU64::new(u64::MAX) }
    }

    /// The device.
    pub fn runtime(&self) -> &R {
        &self.runtime
    }

    /// Sets the limit on the bytes in use at once.
    pub fn set_limit(&self, limit: Option<u64>) {
        self.limit.store(limit.unwrap_or(u64::MAX), Ordering::Relaxed);
    }

    /// How many bytes may still be allocated; `None` if there is no limit.
    pub fn left(&self) -> Option<u64> {
        let limit = self.limit.load(Ordering::Relaxed);
        (limit < u64::MAX).then(|| limit.saturating_sub(self.taken()))
    }

    /// Bytes in use.
    pub fn taken(&self) -> u64 {
        self.taken.load(Ordering::Relaxed)
    }

    /// The largest number of bytes in use at once.
    pub fn peak(&self) -> u64 {
        self.peak.load(Ordering::Relaxed)
    }

    /// Allocates `len` values, content undefined. `what` names the buffer in the error if memory does not suffice.
    ///
    /// # Errors
    /// [`DeviceError::Memory`] if it does not fit, [`DeviceError::Fault`] if the device fails.
    pub fn room<T: Pod>(&self, what: &'static str, len: usize) -> Result<Buffer<R, T>, DeviceError> {
        let bytes = (size_of::<T>() as u64 * len as u64).max(1);
        let short = |free| DeviceError::Memory { device: self.runtime.name(), buffer: what, needed: bytes, free };
        let allowed = self.limit.load(Ordering::Relaxed).saturating_sub(self.taken());
        if bytes > allowed {
            return Err(short(Some(allowed)));
        }
        let memory = self.runtime.allocate(bytes).map_err(|fault| match fault {
            Fault::OutOfMemory { free } => short(free),
            failed => self.fault(failed),
        })?;
        let taken = self.taken.fetch_add(bytes, Ordering::Relaxed) + bytes;
        self.peak.fetch_max(taken, Ordering::Relaxed);
        let (runtime, taken) = (Arc::clone(&self.runtime), Arc::clone(&self.taken));
        Ok(Buffer { runtime, memory, len, bytes, taken, content: std::marker::PhantomData })
    }

    /// Allocates `len` values with all bits zero.
    pub fn zeros<T: Pod>(&self, what: &'static str, len: usize) -> Result<Buffer<R, T>, DeviceError> {
        let buffer = self.room(what, len)?;
        buffer.clear()?;
        Ok(buffer)
    }

    /// A copy of `values`.
    pub fn upload<T: Pod>(&self, what: &'static str, values: &[T]) -> Result<Buffer<R, T>, DeviceError> {
        let buffer = self.room(what, values.len())?;
        buffer.write(values)?;
        Ok(buffer)
    }

    /// Converts a fault of the device into an error.
    pub fn fault(&self, fault: Fault) -> DeviceError {
        fault_of(&*self.runtime, fault)
    }
}

fn fault_of<R: Runtime>(runtime: &R, fault: Fault) -> DeviceError {
    let reason = match fault {
        Fault::OutOfMemory { .. } => "out of memory".to_owned(),
        Fault::Failed(reason) => reason,
    };
    DeviceError::Fault { device: runtime.name(), reason }
}

impl<R: Runtime, T: Pod> Buffer<R, T> {
    /// Number of values.
    #[allow(clippy::len_without_is_empty, reason = "not needed")]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Its address, for reading.
    pub fn input(&self) -> In<T> {
        In::to(self.runtime.address(&self.memory))
    }

    /// Its address, for writing.
    pub fn output(&self) -> Out<T> {
        Out::to(self.runtime.address(&self.memory))
    }

    /// Sets all bits to zero.
    pub fn clear(&self) -> Result<(), DeviceError> {
        if self.len == 0 {
            return Ok(());
        }
        self.runtime.clear(&self.memory, 0, self.bytes).map_err(|fault| fault_of(&*self.runtime, fault))
    }

    /// Sets the last value to zero.
    pub fn clear_last(&self) -> Result<(), DeviceError> {
        let bytes = size_of::<T>() as u64;
        let cleared = self.runtime.clear(&self.memory, self.bytes - bytes, bytes);
        cleared.map_err(|fault| fault_of(&*self.runtime, fault))
    }

    /// Overwrites the first values.
    pub fn write(&self, values: &[T]) -> Result<(), DeviceError> {
        debug_assert!(values.len() <= self.len);
        if values.is_empty() {
            return Ok(());
        }
        let bytes = bytemuck::cast_slice(values);
        self.runtime.write(&self.memory, 0, bytes).map_err(|fault| fault_of(&*self.runtime, fault))
    }

    /// Reads values starting at `first`. Waits for all work queued before.
    pub fn read_into(&self, first: usize, values: &mut [T]) -> Result<(), DeviceError> {
        debug_assert!(first + values.len() <= self.len);
        if values.is_empty() {
            return Ok(());
        }
        let offset = (first * size_of::<T>()) as u64;
        let bytes = bytemuck::cast_slice_mut(values);
        self.runtime.read(&self.memory, offset, bytes).map_err(|fault| fault_of(&*self.runtime, fault))
    }

    /// Reads all values. Waits for all work queued before.
    pub fn read(&self) -> Result<Vec<T>, DeviceError> {
        let mut values = vec![T::zeroed(); self.len];
        self.read_into(0, &mut values)?;
        Ok(values)
    }
}

impl<R: Runtime, T> Drop for Buffer<R, T> {
    fn drop(&mut self) {
        self.taken.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}
