//! Initial fuzzing inputs: the committed seeds, and small files and the beginnings of larger ones from a folder of scenes.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::verdict::{Outcome, Verdict};

/// Maximum input size in bytes. A fuzzer mutates small inputs faster.
const LONGEST: u64 = 16 << 10;

/// Fuzz targets, and the extensions of the files that they accept.
const TARGETS: [(&str, &[&str]); 13] = [
    ("obj", &["obj"]),
    ("ply", &["ply"]),
    ("stl", &["stl"]),
    ("gltf", &["gltf"]),
    ("glb", &["glb"]),
    ("toml", &["toml"]),
    ("texture", &["png", "jpg", "jpeg", "bmp", "tga"]),
    ("grid", &["grid"]),
    ("mesh", &["mesh"]),
    ("scene", &[]),
    ("picture", &["png", "exr", "bmp"]),
    ("values", &[]),
    ("bvh", &[]),
];

/// Fills `fuzz/corpus` in the repository at `root`, also with files below `scenes`.
pub(crate) fn fill(root: &Path, scenes: Option<&Path>) -> Outcome {
    let mut found = files(&root.join("scenes"))?;
    if let Some(scenes) = scenes {
        found.extend(files(scenes)?);
    }
    let mut count = 0;
    for (target, endings) in TARGETS {
        let (seeds, corpus) = (root.join("fuzz/seeds").join(target), root.join("fuzz/corpus").join(target));
        fs::create_dir_all(&corpus)?;
        let fitting = found.iter().filter(|path| has_ending(path, endings)).cloned();
        for path in files(&seeds)?.into_iter().chain(fitting) {
            fs::write(corpus.join(name(&path)), beginning(&path)?)?;
            count += 1;
        }
    }
    Ok(Verdict::Passed(format!("{count} inputs in fuzz/corpus")))
}

/// All files in a folder, recursively.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn std::error::Error>> {
    let mut files = Vec::new();
    let entries = fs::read_dir(folder).map_err(|error| format!("cannot list {}: {error}", folder.display()))?;
    for entry in entries {
        let entry = entry?;
        match entry.file_type()? {
            kind if kind.is_dir() => files.extend(self::files(&entry.path())?),
            kind if kind.is_file() => files.push(entry.path()),
            _ => {}
        }
    }
    Ok(files)
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().unwrap_or_default();
    endings.iter().any(|known| ending.eq_ignore_ascii_case(known))
}

/// A name that distinguishes files of the same name in different folders.
fn name(path: &Path) -> String {
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
    [folder, path.file_name().unwrap_or_default()].map(OsStr::to_string_lossy).join("-")
}

fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(LONGEST).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_target_has_a_place_and_seeds() {
        let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
        for (target, _) in TARGETS {
            assert!(fuzz.join(format!("targets/{target}.rs")).is_file(), "{target}");
            assert!(fuzz.join(format!("dictionaries/{target}.dict")).is_file(), "{target}");
            assert!(!files(&fuzz.join("seeds").join(target)).unwrap().is_empty(), "{target}");
        }
        assert_eq!(fs::read_dir(fuzz.join("targets")).unwrap().count(), TARGETS.len());
    }

    #[test]
    fn endings_are_told_in_any_case() {
        assert!(has_ending(Path::new("a/part.STL"), &["stl"]) && !has_ending(Path::new("stl"), &["stl"]));
        assert_eq!(name(Path::new("models/spot/spot.obj")), "spot-spot.obj");
    }
}
