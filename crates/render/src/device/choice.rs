//! From the requested device to one that is ready for use.

use std::sync::Arc;

use lightmesh_kernels::{DeviceError, Driver, Library, open_cuda};

use super::Device;
use super::report::{cpu, ready};
use crate::error::RenderError;

/// The result of choosing a [`Device`].
pub struct Choice {
    /// [`Device::Cpu`], or [`Device::Cuda`] with a number.
    pub device: Device,
    /// Which device it is.
    pub reason: String,
    /// Why no CUDA device was taken, and what to do, if the choice was left open and none works.
    pub no_cuda: Option<String>,
    /// Whether that may be news to the user: there is a driver, or a card of NVIDIA's. Elsewhere no CUDA device was to
    /// be expected.
    pub misses_cuda: bool,
    pub(crate) chosen: Chosen,
}

/// A device that is ready for use.
pub(crate) enum Chosen {
    /// The CPU.
    Cpu,
    /// A CUDA device.
    Cuda(Arc<Driver>),
}

impl Choice {
    /// Prepares the requested device. For [`Device::Auto`] that is the first CUDA device that works, or else the CPU. Pass the
    /// result to [`Renderer::on`](crate::Renderer::on).
    ///
    /// # Errors
    /// [`RenderError::Device`] if a CUDA device is requested and cannot be used.
    pub fn of(device: Device) -> Result<Choice, RenderError> {
        match device {
            Device::Cpu => Ok(Choice::cpu()),
            Device::Cuda(number) => Ok(Choice::cuda(open_cuda(number)?)),
            Device::Auto => Ok(open_cuda(None).map_or_else(Choice::instead_of_cuda, Choice::cuda)),
        }
    }

    fn instead_of_cuda(error: DeviceError) -> Choice {
        let (why, is_ordinary) = match (Library::open(), error) {
            (Err(why), _) => (why.explained(), why.is_ordinary()),
            (Ok(_), DeviceError::Unusable { reason, .. }) => (reason, false),
            (Ok(_), other) => (other.to_string(), false),
        };
        Choice { no_cuda: Some(why), misses_cuda: !is_ordinary, ..Choice::cpu() }
    }

    fn cpu() -> Choice {
        let report = cpu();
        let reason = format!("{} ({}, {})", report.device, report.name, report.remark);
        Choice { device: Device::Cpu, reason, no_cuda: None, misses_cuda: false, chosen: Chosen::Cpu }
    }

    fn cuda(driver: Arc<Driver>) -> Choice {
        let report = ready(&driver);
        let device = Device::Cuda(Some(driver.number()));
        let reason = format!("{} ({}, {})", report.device, report.name, report.remark);
        Choice { device, reason, no_cuda: None, misses_cuda: false, chosen: Chosen::Cuda(driver) }
    }
}
