//! The kernel files, and where what is made from them is committed.

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// The folders of kernels and headers, in which includes are searched for; all paths here are relative to the repository.
pub(super) const SOURCES: [&str; 3] = ["crates/kernels/src", "crates/trace/src", "crates/render/src"];
pub(super) const LAYOUT: &str = "crates/kernels/src/cuda/layout.cuh";
pub(super) const PTX: &str = "crates/kernels/src/cuda/ptx";

/// A kernel file.
pub(super) struct Source {
    /// Name of its module.
    pub(super) module: String,
    /// The folder among [`SOURCES`] that has it.
    pub(super) folder: PathBuf,
    /// Relative to `folder`.
    pub(super) path: PathBuf,
}

/// A module as PTX.
pub(super) struct Module {
    pub(super) name: String,
    pub(super) ptx: String,
}

/// Where the PTX of a module is committed.
pub(super) fn ptx_path(module: &str) -> PathBuf {
    Path::new(PTX).join(format!("{module}.ptx"))
}

/// The kernel files, in order of module: `kernel.cu` is named after its folder, any other file after itself.
pub(super) fn kernel_files() -> Result<Vec<Source>, Box<dyn Error>> {
    let mut sources = Vec::new();
    for folder in SOURCES {
        for path in sources_under(Path::new(folder), &["cu"])? {
            let named_by = if path.ends_with("kernel.cu") { path.parent() } else { Some(path.as_path()) };
            let module = named_by.and_then(Path::file_stem).and_then(OsStr::to_str);
            let module = module.ok_or_else(|| format!("{} has no module name", path.display()))?.to_owned();
            sources.push(Source { module, folder: folder.into(), path: path.strip_prefix(folder)?.to_owned() });
        }
    }
    sources.sort_by(|a, b| a.module.cmp(&b.module));
    Ok(sources)
}

/// All files under `folder` with one of some extensions, in order.
pub(super) fn sources_under(folder: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(inner)? {
            let path = entry?.path();
            let ending = path.extension().and_then(OsStr::to_str);
            if path.is_dir() {
                folders.push(path);
            } else if ending.is_some_and(|ending| endings.contains(&ending)) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}
