//! What is known of CUDA devices and drivers, whether or not there is a driver.

use std::fmt;

/// A version of CUDA, as supported by a driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// 12 of 12.4.
    pub major: u32,
    /// 4 of 12.4.
    pub minor: u32,
}

impl Version {
    #[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "only the driver has one"))]
    /// Decodes the driver's number: 12040 is 12.4.
    pub fn from_code(code: i32) -> Version {
        let code = u32::try_from(code).unwrap_or(0);
        Version { major: code / 1000, minor: code % 1000 / 10 }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

/// A device as described by the driver.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// N of `cuda:N`, among the visible devices.
    pub number: u32,
    /// The vendor's name for the device.
    pub name: String,
    /// Compute capability times ten.
    pub capability: u32,
    /// Bytes of memory.
    pub memory: u64,
    /// Whether it has stream-ordered memory.
    pub pools: bool,
    /// The driver's handle.
    pub handle: i32,
}

/// The value of CUDA_VISIBLE_DEVICES. The driver itself obeys it: only the listed devices exist, and they are renumbered.
pub fn visible_devices() -> Option<String> {
    std::env::var_os("CUDA_VISIBLE_DEVICES").map(|value| value.to_string_lossy().into_owned())
}

/// The name of the CUDA device with this number, or of any.
pub(crate) fn name_of(number: Option<u32>) -> String {
    number.map_or_else(|| "cuda".to_owned(), |number| format!("cuda:{number}"))
}

/// Formats a compute capability times ten in the usual way.
pub fn capability(tenfold: u32) -> String {
    format!("{}.{}", tenfold / 10, tenfold % 10)
}
