//! The kernels as PTX, and the requirements on a driver.
//!
//! PTX is text for a virtual machine. `cargo xtask kernels` generates it ahead of time, and `build.rs` compresses it; the driver compiles it for
//! its device when a module is loaded, and keeps the result in its own cache (`~/.nv/ComputeCache`) for the next start.

use zlib_rs::{InflateConfig, ReturnCode, decompress_slice};

use crate::gpu::Version;

/// All modules by name, in a list that `build.rs` makes.
pub const MODULES: &[Module] = include!(concat!(env!("OUT_DIR"), "/ptx.rs"));

/// The PTX of a module.
pub struct Module {
    /// Its name.
    pub name: &'static str,
    /// Its first directives: PTX version and target.
    pub head: &'static str,
    /// Bytes of the text.
    pub bytes: usize,
    /// The text as a zlib stream.
    pub packed: &'static [u8],
}

impl Module {
    /// The text with a zero after it, as the driver takes it.
    pub fn unpacked(&self) -> Result<Vec<u8>, String> {
        let mut text = vec![0; self.bytes + 1];
        let (written, code) = decompress_slice(&mut text[..self.bytes], self.packed, InflateConfig::default());
        if code == ReturnCode::Ok && written.len() == self.bytes {
            Ok(text)
        } else {
            Err(format!(
                "the kernels of {} cannot be unpacked ({code:?}): this build of the program is damaged",
                self.name
            ))
        }
    }
}

/// PTX version, the first CUDA version that supports it, and the first branch of NVIDIA's driver for that one ("Release History"
/// in the PTX ISA document). Nothing older is listed: the bindings need a driver for CUDA 12.0 in any case.
pub const VERSIONS: [(&str, Version, u32); 10] = [
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
pub struct Needs {
    /// CUDA version that the driver must support.
    pub cuda: Version,
    /// First branch of NVIDIA's driver for it.
    pub driver: u32,
    /// Compute capability that the device must have, times ten: 75 is 7.5.
    pub capability: u32,
}

impl Needs {
    /// The requirements of all modules together.
    pub fn of_kernels() -> Needs {
        MODULES.iter().fold(Needs::of(""), |needs, module| needs.and(Needs::of(module.head)))
    }

    /// The requirements of one module. A version that is not in the table is left to the driver.
    pub fn of(text: &str) -> Needs {
        let version = directive(text, ".version").and_then(|word| VERSIONS.iter().find(|row| row.0 == word));
        let (_, cuda, driver) = *version.unwrap_or(&VERSIONS[0]);
        let target = directive(text, ".target").and_then(|word| word.strip_prefix("sm_")?.parse().ok());
        Needs { cuda, driver, capability: target.unwrap_or(0) }
    }

    /// The stricter of both.
    pub fn and(self, other: Needs) -> Needs {
        Needs {
            cuda: self.cuda.max(other.cuda),
            driver: self.driver.max(other.driver),
            capability: self.capability.max(other.capability),
        }
    }
}

/// The first word after a directive at the beginning of a line.
pub fn directive<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let rest = text.lines().find_map(|line| line.trim_start().strip_prefix(name))?;
    rest.split([' ', '\t', ',']).find(|word| !word.is_empty())
}
