//! Where an image is computed.

mod choice;
mod list;
pub(crate) mod report;

use std::fmt;
use std::str::FromStr;

pub use choice::Choice;
pub(crate) use choice::{Chosen, ChosenDevices};
pub use list::DeviceList;
pub(crate) use report::cpu_name;
pub use report::{DeviceReport, devices};

/// A device that can be requested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Device {
    /// The fastest that works: a CUDA device if possible, else the CPU.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// A CUDA device: the first that works, or the one with this number. The driver lists the fastest first and, if
    /// CUDA_VISIBLE_DEVICES is set, only the devices it names.
    Cuda(Option<u32>),
    /// Several, which render bands of one picture, or frames of one film. It is the same picture.
    Several(DeviceList),
}

/// A word that is not the name of a device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "unknown device '{0}': choose auto, cpu, cuda, cuda:N, or several: cuda:all, or a list such as cuda:0,1 or cuda:all,cpu"
)]
pub struct UnknownDevice(pub String);

impl Device {
    /// The number of a CUDA device, if it is known.
    pub(crate) fn number(self) -> Option<u32> {
        match self {
            Device::Cuda(number) => number,
            _ => None,
        }
    }
}

impl FromStr for Device {
    type Err = UnknownDevice;

    fn from_str(word: &str) -> Result<Device, UnknownDevice> {
        let unknown = || UnknownDevice(word.to_owned());
        match word {
            "auto" => Ok(Device::Auto),
            "cpu" => Ok(Device::Cpu),
            "cuda" => Ok(Device::Cuda(None)),
            _ if word == "cuda:all" || word.contains(',') => {
                DeviceList::read(word).map(Device::Several).ok_or_else(unknown)
            }
            _ => {
                let number = word.strip_prefix("cuda:").ok_or_else(unknown)?;
                Ok(Device::Cuda(Some(number.parse().map_err(|_| unknown())?)))
            }
        }
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Device::Auto => f.write_str("auto"),
            Device::Cpu => f.write_str("cpu"),
            Device::Cuda(None) => f.write_str("cuda"),
            Device::Cuda(Some(number)) => write!(f, "cuda:{number}"),
            Device::Several(list) => list.fmt(f),
        }
    }
}
