//! From the requested device to one that is ready for use.

use std::sync::Arc;
use std::thread;

use lightmesh_kernels::{DeviceError, Driver, Library, open_cuda};

use super::report::{cpu, ready};
use super::{Device, DeviceList};
use crate::error::RenderError;

/// The result of choosing a [`Device`].
pub struct Choice {
    /// [`Device::Cpu`], [`Device::Cuda`] with a number, or [`Device::Several`] with those that work.
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
    /// Each of several.
    Several(Vec<Choice>),
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
            Device::Several(list) => Choice::several(list),
            Device::Auto => Ok(open_cuda(None).map_or_else(Choice::instead_of_cuda, Choice::cuda)),
        }
    }

    /// All that are listed; of all CUDA devices those that work.
    fn several(list: DeviceList) -> Result<Choice, RenderError> {
        let numbers: Vec<u32> = match Library::open() {
            Ok(library) if list.has_all_cuda() => library.devices.iter().map(|gpu| gpu.number).collect(),
            _ => list.numbers().collect(),
        };
        // Each wakes while the others do.
        let opened: Vec<Result<Arc<Driver>, DeviceError>> = thread::scope(|scope| {
            let open = |&number| scope.spawn(move || open_cuda(Some(number)));
            let opening: Vec<_> = numbers.iter().map(open).collect();
            opening
                .into_iter()
                .map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
                .collect()
        });
        let (mut choices, mut unusable) = (Vec::new(), Vec::new());
        for opened in opened {
            match opened {
                Ok(driver) => choices.push(Choice::cuda(driver)),
                Err(error) if list.has_all_cuda() => unusable.push(format!("; {error}")),
                Err(error) => return Err(error.into()),
            }
        }
        if choices.is_empty() && list.has_all_cuda() {
            // It says why.
            choices.push(Choice::cuda(open_cuda(None)?));
        }
        choices.extend(list.has_cpu().then(Choice::cpu));
        if choices.len() == 1 && unusable.is_empty() {
            return Ok(choices.remove(0));
        }
        let numbers: Vec<u32> = choices.iter().filter_map(|choice| choice.device.number()).collect();
        let cuda = DeviceList::of_cuda(&numbers);
        let device = cuda.map_or(Device::Cpu, |cuda| if list.has_cpu() { cuda.and_cpu() } else { cuda }.into());
        let reasons: Vec<&str> = choices.iter().map(|choice| &*choice.reason).collect();
        let reason = format!("{}{}", reasons.join(" and "), unusable.concat());
        Ok(Choice { device, reason, no_cuda: None, misses_cuda: false, chosen: Chosen::Several(choices) })
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
