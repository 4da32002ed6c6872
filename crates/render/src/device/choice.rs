//! From the requested device to one that is ready for use.

use std::sync::Arc;

use super::Device;
use super::report::{cpu, ready};
use crate::cuda::{Driver, Library, open_cuda};
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
            Device::Cuda(number) => open_cuda(number).map(Choice::cuda),
            Device::Auto => Ok(open_cuda(None).map_or_else(Choice::instead_of_cuda, Choice::cuda)),
        }
    }

    fn instead_of_cuda(error: RenderError) -> Choice {
        let (why, is_ordinary) = match (Library::open(), error) {
            (Err(why), _) => (why.explained(), why.is_ordinary()),
            (Ok(_), RenderError::Device { reason, .. }) => (reason, false),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_can_always_be_chosen() {
        let choice = Choice::of(Device::Cpu).unwrap();
        assert_eq!(choice.device, Device::Cpu);
        assert!(choice.reason.starts_with("cpu (") && choice.no_cuda.is_none(), "{}", choice.reason);
    }

    #[test]
    fn what_is_left_open_is_decided_and_explained() {
        let choice = Choice::of(Device::Auto).unwrap();
        match choice.device {
            Device::Cuda(Some(number)) => {
                assert!(choice.reason.starts_with(&format!("cuda:{number} (")), "{}", choice.reason)
            }
            Device::Cpu => assert!(choice.no_cuda.is_some_and(|why| !why.is_empty()), "{}", choice.reason),
            other => panic!("{other} is not decided"),
        }
    }

    #[test]
    fn a_device_that_is_not_there_is_an_error() {
        let refused = Choice::of(Device::Cuda(Some(4096)));
        let Err(RenderError::Device { device, reason }) = refused.map(|choice| choice.device) else {
            panic!("4097 devices")
        };
        assert_eq!(device, "cuda:4096");
        assert!(!reason.is_empty());
    }
}
