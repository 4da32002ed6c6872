//! The kernels as PTX, and the requirements on a driver.
//!
//! PTX is text for a virtual machine. `cargo xtask kernels` generates it ahead of time; the driver compiles it for its device
//! when a module is loaded, and keeps the result in its own cache (`~/.nv/ComputeCache`) for the next start.

use crate::cuda::gpu::Version;

/// All modules by name, in a list that `cargo xtask kernels` generates.
pub(super) const MODULES: &[(&str, &str)] = include!("../ptx/modules.rs");

/// PTX version, the first CUDA version that supports it, and the first branch of NVIDIA's driver for that one ("Release History"
/// in the PTX ISA document). Nothing older is listed: the bindings need a driver for CUDA 12.0 in any case.
const VERSIONS: [(&str, Version, u32); 10] = [
    ("8.0", Version { major: 12, minor: 0 }, 525),
    ("8.1", Version { major: 12, minor: 1 }, 530),
    ("8.2", Version { major: 12, minor: 2 }, 535),
    ("8.3", Version { major: 12, minor: 3 }, 545),
    ("8.4", Version { major: 12, minor: 4 }, 550),
    ("8.5", Version { major: 12, minor: 5 }, 555),
    ("8.6", Version { major: 12, minor: 7 }, 565),
    ("8.7", Version { major: 12, minor: 8 }, 570),
    ("8.8", Version { major: 12, minor: 9 }, 575),
    ("9.0", Version { major: 13, minor: 0 }, 580),
];

/// What PTX requires of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Needs {
    /// CUDA version that the driver must support.
    pub(crate) cuda: Version,
    /// First branch of NVIDIA's driver for it.
    pub(crate) driver: u32,
    /// Compute capability that the device must have, times ten: 75 is 7.5.
    pub(crate) capability: u32,
}

impl Needs {
    /// The requirements of all modules together.
    pub(crate) fn of_kernels() -> Needs {
        MODULES.iter().fold(Needs::of(""), |needs, (_, text)| needs.and(Needs::of(text)))
    }

    /// The requirements of one module. A version that is not in the table is left to the driver.
    fn of(text: &str) -> Needs {
        let version = directive(text, ".version").and_then(|word| VERSIONS.iter().find(|row| row.0 == word));
        let (_, cuda, driver) = *version.unwrap_or(&VERSIONS[0]);
        let target = directive(text, ".target").and_then(|word| word.strip_prefix("sm_")?.parse().ok());
        Needs { cuda, driver, capability: target.unwrap_or(0) }
    }

    fn and(self, other: Needs) -> Needs {
        Needs {
            cuda: self.cuda.max(other.cuda),
            driver: self.driver.max(other.driver),
            capability: self.capability.max(other.capability),
        }
    }
}

/// The first word after a directive at the beginning of a line.
fn directive<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let rest = text.lines().find_map(|line| line.trim_start().strip_prefix(name))?;
    rest.split([' ', '\t', ',']).find(|word| !word.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cuda::gpu::capability;

    #[test]
    fn newer_ptx_needs_newer_drivers() {
        assert!(VERSIONS.is_sorted_by(|a, b| a.0 < b.0 && a.1 < b.1 && a.2 < b.2));
        let text = "//\n// Generated\n//\n\n.version 8.4\n.target sm_75, debug\n.address_size 64\n";
        let needs = Needs { cuda: Version { major: 12, minor: 4 }, driver: 550, capability: 75 };
        assert_eq!(Needs::of(text), needs);
        assert_eq!(Needs::of(".version 8.0\n.target sm_90\n").and(needs), Needs { capability: 90, ..needs });
        assert_eq!(Needs::of("").cuda, Version { major: 12, minor: 0 });
    }

    #[test]
    fn all_kernels_are_for_devices_from_7_5_on_and_their_version_is_in_the_table() {
        for (name, text) in MODULES {
            let version = directive(text, ".version").unwrap_or_else(|| panic!("{name} has no .version"));
            assert!(VERSIONS.iter().any(|row| row.0 == version), "{name}: PTX {version} is not in the table");
            assert_eq!(Needs::of(text).capability, 75, "{name}");
        }
        assert_eq!(capability(Needs::of_kernels().capability), "7.5");
    }
}
