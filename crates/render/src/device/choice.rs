//! From the requested device to one that is ready for use.

use std::sync::Arc;

use lightmesh_kernels::{DeviceError, Driver, Library, open_cuda};

use super::report::{cpu, ready, unopened};
use super::{Device, DeviceList, DeviceReport};
use crate::error::RenderError;

/// The result of choosing a [`Device`].
pub struct Choice {
    /// [`Device::Cpu`], [`Device::Cuda`] with a number, or [`Device::Several`] with the first that works and those that are tried later.
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
    /// Several.
    Several(ChosenDevices),
}

/// Several devices.
pub(crate) struct ChosenDevices {
    /// The first one that works.
    pub(crate) first: Box<Choice>,
    /// The numbers of CUDA devices that are made while it works.
    pub(crate) others: Vec<u32>,
    /// Whether the CPU helps.
    pub(crate) cpu: bool,
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

    /// All that are listed. The first CUDA device that works is made at once, others are only looked up.
    fn several(list: DeviceList) -> Result<Choice, RenderError> {
        let library = match Library::open() {
            Ok(library) => library,
            // It says why.
            Err(_) => return Ok(Choice::cuda(open_cuda(list.numbers().next())?)),
        };
        let is_listed = |number: u32| list.has_all_cuda() || list.numbers().any(|listed| listed == number);
        let there: Vec<u32> = library.devices.iter().map(|gpu| gpu.number).collect();
        if let Some(missing) = list.numbers().find(|number| !there.contains(number)) {
            open_cuda(Some(missing))?;
        }
        let mut numbers = there.into_iter().filter(|&number| is_listed(number));
        let mut unusable: Vec<DeviceError> = Vec::new();
        let first = loop {
            let Some(number) = numbers.next() else {
                return Err(unusable.swap_remove(0).into());
            };
            match open_cuda(Some(number)) {
                Ok(driver) => break Choice::cuda(driver),
                Err(error) => unusable.push(error),
            }
        };
        let (others, cpu): (Vec<u32>, bool) = (numbers.collect(), list.has_cpu());
        if others.is_empty() && !cpu && unusable.is_empty() {
            return Ok(first);
        }
        let known = first.device.number().into_iter().chain(others.iter().copied()).collect::<Vec<_>>();
        let cuda = DeviceList::of_cuda(&known);
        let device = cuda.map_or(Device::Cpu, |cuda| if cpu { cuda.and_cpu() } else { cuda }.into());
        let waking = library.devices.iter().filter(|gpu| others.contains(&gpu.number));
        let mut reasons = vec![first.reason.clone()];
        reasons.extend(waking.map(|gpu| Choice::reason(&unopened(gpu, library.version))));
        reasons.extend(cpu.then(|| Choice::cpu().reason));
        let unusable: String = unusable.iter().map(|error| format!("; {error}")).collect();
        let reason = format!("{}{unusable}", reasons.join(" and "));
        let chosen = Chosen::Several(ChosenDevices { first: first.into(), others, cpu });
        Ok(Choice { device, reason, no_cuda: None, misses_cuda: false, chosen })
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
        let reason = Choice::reason(&cpu());
        Choice { device: Device::Cpu, reason, no_cuda: None, misses_cuda: false, chosen: Chosen::Cpu }
    }

    fn cuda(driver: Arc<Driver>) -> Choice {
        let reason = Choice::reason(&ready(&driver));
        let device = Device::Cuda(Some(driver.number()));
        Choice { device, reason, no_cuda: None, misses_cuda: false, chosen: Chosen::Cuda(driver) }
    }

    fn reason(DeviceReport { device, name, remark, .. }: &DeviceReport) -> String {
        format!("{device} ({name}, {remark})")
    }
}
