//! From a device number to a device that is ready for use.

use std::sync::Arc;

use super::Driver;
use super::library::Library;
use super::ptx::Needs;
use crate::error::DeviceError;
use crate::gpu::{Gpu, name_of, visible_devices};
use crate::runtime::Fault;

/// Prepares a CUDA device: the one with this number, or the first that works. The driver lists the fastest first.
///
/// Each call returns a device with its own stream, modules and memory, so that renderers do not interfere.
///
/// # Errors
/// [`DeviceError::Unusable`] with the requested device, why it cannot be used, and what to do.
pub fn open_cuda(number: Option<u32>) -> Result<Arc<Driver>, DeviceError> {
    let opened = Library::open().map_err(|why| why.to_string()).and_then(|library| match number {
        Some(number) => numbered(&library, number),
        None => first(&library),
    });
    opened.map_err(|reason| DeviceError::Unusable { device: name_of(number), reason })
}

impl Library {
    /// Prepares one of the devices, or returns why it cannot be used.
    pub fn ready(&self, gpu: &Gpu) -> Result<Driver, String> {
        if let Some(refusal) = gpu.refusal(Needs::of_kernels()) {
            return Err(refusal);
        }
        Driver::new(gpu, self.version).map_err(|fault| match fault {
            Fault::OutOfMemory { .. } => "its memory is used up".to_owned(),
            Fault::Failed(reason) => reason,
        })
    }
}

fn numbered(library: &Library, number: u32) -> Result<Arc<Driver>, String> {
    let gpu = library.devices.iter().find(|gpu| gpu.number == number);
    let gpu = gpu.ok_or_else(|| no_such_device(&library.devices, visible_devices()))?;
    library.ready(gpu).map(Arc::new).map_err(|reason| format!("{}: {reason}", gpu.name))
}

fn first(library: &Library) -> Result<Arc<Driver>, String> {
    let mut reasons = Vec::new();
    for gpu in &library.devices {
        match library.ready(gpu) {
            Ok(driver) => return Ok(Arc::new(driver)),
            Err(reason) => reasons.push(format!("cuda:{} ({}): {reason}", gpu.number, gpu.name)),
        }
    }
    Err(reasons.join("; "))
}

/// What there is instead of a device that is not there.
pub fn no_such_device(devices: &[Gpu], visible: Option<String>) -> String {
    let there: Vec<String> = devices.iter().map(|gpu| format!("cuda:{} ({})", gpu.number, gpu.name)).collect();
    let numbering = visible.map_or_else(String::new, |value| {
        format!("; CUDA_VISIBLE_DEVICES is \"{value}\", which chooses and numbers them")
    });
    format!("there is no such device, only {}{numbering}", there.join(", "))
}
