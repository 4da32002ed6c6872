//! What is known of CUDA devices and drivers, whether or not there is a driver.

use std::fmt;

/// A version of CUDA, as supported by a driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Version {
    /// 12 of 12.4.
    pub(crate) major: u32,
    /// 4 of 12.4.
    pub(crate) minor: u32,
}

impl Version {
    #[cfg_attr(not(feature = "cuda"), allow(dead_code, reason = "only the driver has one"))]
    /// Decodes the driver's number: 12040 is 12.4.
    pub(crate) fn from_code(code: i32) -> Version {
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
#[cfg_attr(not(feature = "cuda"), expect(dead_code, reason = "only the driver makes one"))]
pub(crate) struct Gpu {
    /// N of `cuda:N`, among the visible devices.
    pub(crate) number: u32,
    /// The vendor's name for the device.
    pub(crate) name: String,
    /// Compute capability times ten.
    pub(crate) capability: u32,
    /// Bytes of memory.
    pub(crate) memory: u64,
    /// Whether it has stream-ordered memory.
    pub(crate) pools: bool,
    /// The driver's handle.
    pub(crate) handle: i32,
}

/// The value of CUDA_VISIBLE_DEVICES. The driver itself obeys it: only the listed devices exist, and they are renumbered.
pub(crate) fn visible_devices() -> Option<String> {
    std::env::var_os("CUDA_VISIBLE_DEVICES").map(|value| value.to_string_lossy().into_owned())
}

/// Formats a compute capability times ten in the usual way.
pub(crate) fn capability(tenfold: u32) -> String {
    format!("{}.{}", tenfold / 10, tenfold % 10)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_driver_tells_its_version_as_a_number() {
        assert_eq!(Version::from_code(12040).to_string(), "12.4");
        assert_eq!(Version::from_code(11080).to_string(), "11.8");
        assert!(Version::from_code(9020) < Version::from_code(12000));
        assert_eq!(Version::from_code(-1), Version { major: 0, minor: 0 });
    }
}
