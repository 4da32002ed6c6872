//! `cargo xtask kernels`: committed files generated from the CUDA kernels.
//!
//! 1. `crates/render/src/cuda/layout.cuh` from the records of `crates/layout`.
//! 2. `crates/render/src/cuda/ptx/<module>.ptx` from each kernel file: the code that users' drivers compile.
//! 3. `docs/kernels.md`: the resources of each kernel, as reported by `ptxas`.
//!
//! Before that, kernels are checked for copies of host constants. With `--check` nothing is written, and stale files are listed.
//! The compilers are pinned in `xtask/cuda-tools.txt`.

mod compile;
mod copies;
mod report;
mod tools;

use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Outcome, Verdict};

/// The folder of kernels and headers; all paths in this module are relative to the repository.
const SOURCES: &str = "crates/render/src";
const LAYOUT: &str = "crates/render/src/cuda/layout.cuh";
const PTX: &str = "crates/render/src/cuda/ptx";
const REPORT: &str = "docs/kernels.md";

/// A file and its expected content; `None` if it should not exist.
struct Product {
    path: PathBuf,
    content: Option<String>,
}

/// A kernel file.
struct Source {
    /// Name of its module.
    module: String,
    /// Relative to [`SOURCES`].
    path: PathBuf,
}

/// A module as PTX.
struct Module {
    name: String,
    ptx: String,
}

/// Regenerates everything and writes what differs; with `check` only reports it.
pub(crate) fn run(root: &Path, check: bool) -> Outcome {
    // Relative paths, so that generated files do not depend on the location of the repository.
    std::env::set_current_dir(root)?;
    let copies = copies::find(Path::new(SOURCES))?;
    if !copies.is_empty() {
        return Ok(Verdict::Failed(copies));
    }
    let layout = Product { path: LAYOUT.into(), content: Some(lightmesh_layout::header()) };
    if layout.differs() && !check {
        layout.write()?;
    }
    let tools = tools::install(Path::new("target/cuda-tools"))?;
    let sources = kernel_files(Path::new(SOURCES))?;
    let modules = compile::all(&tools, &sources)?;
    let report = Product { path: REPORT.into(), content: Some(report::of(&tools, &modules)?) };

    let mut products = ptx_files(&modules)?;
    products.push(report);
    let stale: Vec<&Product> = products.iter().chain(check.then_some(&layout)).filter(|it| it.differs()).collect();
    let done = format!("{} kernel files; header, PTX and report up to date", sources.len());
    if check {
        let say = |it: &&Product| format!("{} is stale; run `cargo xtask kernels` and commit it", it.path.display());
        return Ok(Verdict::new(stale.iter().map(say).collect(), || done));
    }
    stale.iter().try_for_each(|it| it.write())?;
    Ok(Verdict::Passed(done))
}

impl Product {
    fn differs(&self) -> bool {
        fs::read_to_string(&self.path).ok() != self.content
    }

    fn write(&self) -> Result<(), Box<dyn Error>> {
        let failed = |error| format!("cannot write {}: {error}", self.path.display());
        let Some(content) = &self.content else {
            fs::remove_file(&self.path).map_err(failed)?;
            return Ok(());
        };
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(failed)?;
        }
        fs::write(&self.path, content).map_err(failed)?;
        Ok(())
    }
}

/// One file per module, and the removal of those whose module no longer exists.
fn ptx_files(modules: &[Module]) -> Result<Vec<Product>, Box<dyn Error>> {
    let path = |name: &str| Path::new(PTX).join(format!("{name}.ptx"));
    let mut products: Vec<Product> =
        modules.iter().map(|module| Product { path: path(&module.name), content: Some(module.ptx.clone()) }).collect();
    for entry in fs::read_dir(PTX).into_iter().flatten() {
        let path = entry?.path();
        if products.iter().all(|product| product.path != path) {
            products.push(Product { path, content: None });
        }
    }
    Ok(products)
}

/// The kernel files under `folder`, in order of module: `kernel.cu` is named after its folder, any other file after itself.
fn kernel_files(folder: &Path) -> Result<Vec<Source>, Box<dyn Error>> {
    let mut sources = Vec::new();
    for path in sources_under(folder, &["cu"])? {
        let named_by = if path.ends_with("kernel.cu") { path.parent() } else { Some(path.as_path()) };
        let module = named_by.and_then(Path::file_stem).and_then(OsStr::to_str);
        let module = module.ok_or_else(|| format!("{} has no module name", path.display()))?.to_owned();
        sources.push(Source { module, path: path.strip_prefix(folder)?.to_owned() });
    }
    sources.sort_by(|a, b| a.module.cmp(&b.module));
    Ok(sources)
}

/// All files under `folder` with one of some extensions, in order.
fn sources_under(folder: &Path, endings: &[&str]) -> Result<Vec<PathBuf>, Box<dyn Error>> {
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
