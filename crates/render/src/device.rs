//! Where a picture is computed.

use std::fmt;
use std::str::FromStr;

/// A device that can be asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Device {
    /// The fastest that works.
    #[default]
    Auto,
    /// The host's processor.
    Cpu,
    /// A CUDA device: the fastest, or the one with this number.
    Cuda(Option<u32>),
}

/// A word that names no device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no device '{0}': choose auto, cpu, cuda or cuda:N")]
pub struct UnknownDevice(pub String);

impl FromStr for Device {
    type Err = UnknownDevice;

    fn from_str(word: &str) -> Result<Device, UnknownDevice> {
        let unknown = || UnknownDevice(word.to_owned());
        match word {
            "auto" => Ok(Device::Auto),
            "cpu" => Ok(Device::Cpu),
            "cuda" => Ok(Device::Cuda(None)),
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
        }
    }
}

/// A device that was looked for, and whether it can be used.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct DeviceReport {
    /// `cpu`, `cuda` or `cuda:N`.
    pub device: String,
    /// What the maker calls it, as far as the system tells.
    pub name: String,
    /// Whether pictures can be computed on it.
    pub usable: bool,
    /// Why not; or what there is to know about it.
    pub remark: String,
}

/// All devices that were looked for.
pub fn devices() -> Vec<DeviceReport> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let cpu = DeviceReport {
        device: "cpu".to_owned(),
        name: cpu_name(),
        usable: true,
        remark: format!("{threads} threads, {}", simd_name()),
    };
    let cuda =
        DeviceReport { device: "cuda".to_owned(), name: String::new(), usable: false, remark: NO_CUDA.to_owned() };
    vec![cpu, cuda]
}

/// Which of the two versions of SIMD code runs here.
fn simd_name() -> &'static str {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if fearless_simd::Level::new().as_avx2().is_some() {
        return "AVX2";
    }
    "baseline SIMD"
}

/// Why a CUDA device cannot be used.
pub(crate) const NO_CUDA: &str = "this version renders on the CPU only; take --device cpu or auto";

/// The processor's name, or its architecture where the system does not tell.
pub(crate) fn cpu_name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_devices_are_read_and_written() {
        for word in ["auto", "cpu", "cuda", "cuda:0", "cuda:17"] {
            assert_eq!(word.parse::<Device>().unwrap().to_string(), word);
        }
        for word in ["", "gpu", "cuda:", "cuda:x", "cuda:-1"] {
            assert!(word.parse::<Device>().is_err(), "{word}");
        }
    }
}
