//! The kernels as PTX, and the requirements on a driver.
//!
//! PTX is text for a virtual machine. `cargo xtask kernels` generates it ahead of time, and `build.rs` compresses it; the driver compiles it for
//! its device when a module is loaded, and keeps the result in its own cache (`~/.nv/ComputeCache`) for the next start.

use zlib_rs::{InflateConfig, ReturnCode, decompress_slice};

use crate::cuda::gpu::Version;

/// All modules by name, in a list that `build.rs` makes.
pub(super) const MODULES: &[Module] = include!(concat!(env!("OUT_DIR"), "/ptx.rs"));

/// The PTX of a module.
pub(super) struct Module {
    pub(super) name: &'static str,
    /// Its first directives: PTX version and target.
    head: &'static str,
    /// Bytes of the text.
    bytes: usize,
    /// The text as a zlib stream.
    packed: &'static [u8],
}

impl Module {
    /// The text with a zero after it, as the driver takes it.
    pub(super) fn unpacked(&self) -> Result<Vec<u8>, String> {
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
        MODULES.iter().fold(Needs::of(""), |needs, module| needs.and(Needs::of(module.head)))
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
        for Module { name, head, .. } in MODULES {
            let version = directive(head, ".version").unwrap_or_else(|| panic!("{name} has no .version"));
            assert!(VERSIONS.iter().any(|row| row.0 == version), "{name}: PTX {version} is not in the table");
            assert_eq!(Needs::of(head).capability, 75, "{name}");
        }
        assert_eq!(capability(Needs::of_kernels().capability), "7.5");
    }

    #[test]
    fn modules_are_unpacked_as_they_are_committed() {
        let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/cuda/ptx"));
        for module in MODULES {
            let committed = std::fs::read(folder.join(format!("{}.ptx", module.name))).unwrap();
            let unpacked = module.unpacked().unwrap();
            assert!(unpacked.split_last() == Some((&0, &committed[..])), "{}", module.name);
            assert!(!committed.contains(&0) && committed.len() > 4 * module.packed.len(), "{}", module.name);
        }
        let files = std::fs::read_dir(folder).unwrap().filter(|file| {
            file.as_ref().is_ok_and(|file| file.path().extension().is_some_and(|extension| extension == "ptx"))
        });
        assert_eq!(files.count(), MODULES.len());
    }

    #[test]
    fn damaged_modules_are_errors() {
        let whole = MODULES.first().unwrap();
        let cut = Module { packed: &whole.packed[..whole.packed.len() / 2], ..*whole };
        let longer = Module { bytes: whole.bytes + 1, ..*whole };
        let shorter = Module { bytes: whole.bytes - 1, ..*whole };
        for damaged in [cut, longer, shorter] {
            let why = damaged.unpacked().unwrap_err();
            assert!(why.contains(whole.name) && why.contains("damaged"), "{why}");
        }
    }
}
