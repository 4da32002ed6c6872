//! `cargo xtask kernels`: committed files generated from the CUDA kernels.
//!
//! 1. `crates/kernels/src/cuda/layout.cuh` from the records of `crates/layout`.
//! 2. `crates/kernels/src/cuda/ptx/<module>.ptx` from each kernel file: the code that users' drivers compile.
//! 3. `docs/kernels.md`: the resources of each kernel, as reported by `ptxas`.
//! 4. `crates/kernels/src/cuda/ptx/digests.txt`: the digests of what 2 and 3 are made from, and of themselves.
//!
//! Before that, kernels are checked for copies of host constants. Only products whose digests differ are made again. With `--check` nothing is
//! written, no compiler is needed, and stale files are listed; `--check --recompile` also makes everything again and compares it byte by byte.
//! The compilers are pinned in `xtask/cuda-tools.txt`.

mod compile;
mod copies;
mod digest;
mod parallel;
mod report;
mod sources;
mod tools;

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use self::sources::{LAYOUT, Module, PTX, SOURCES, Source, kernel_files, ptx_path};
use crate::verdict::{Outcome, Verdict};
pub(crate) use compile::ONE;

const REPORT: &str = "docs/kernels.md";
const TOOLS: &str = "target/cuda-tools";

/// A file and its expected content; `None` if it should not exist.
struct Product {
    path: PathBuf,
    content: Option<String>,
}

/// What is done with the products.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Task {
    /// Those that are stale are made and written.
    Write,
    /// Digests are compared.
    Check,
    /// All products are made and compared.
    Recompile,
}

/// Does a task for all products.
pub(crate) fn run(root: &Path, task: Task) -> Outcome {
    // Relative paths, so that generated files do not depend on the location of the repository.
    std::env::set_current_dir(root)?;
    let copies = copies::find(&SOURCES.map(Path::new))?;
    if !copies.is_empty() {
        return Ok(Verdict::Failed(copies));
    }
    let layout = Product { path: LAYOUT.into(), content: Some(lightmesh_layout::header()) };
    if layout.differs() && task == Task::Write {
        layout.write()?;
    }
    let sources = kernel_files()?;
    let done = format!("{} kernel files; header, PTX and report up to date", sources.len());
    let known = digest::committed();
    let stale = match task {
        Task::Write => {
            let stale = digest::differing(&known, &current(&sources)?);
            if !stale.is_empty() {
                write(&sources, &stale)?;
            }
            return Ok(Verdict::Passed(done));
        }
        Task::Check => digest::differing(&known, &current(&sources)?).into_iter().map(path_of).collect(),
        Task::Recompile => {
            let made = made(&sources, &sources.iter().collect::<Vec<_>>(), true)?;
            made.into_iter().filter(Product::differs).map(|product| product.path).collect::<Vec<_>>()
        }
    };
    let stale = stale.into_iter().chain(layout.differs().then_some(layout.path));
    let say = |path: PathBuf| format!("{} is stale; run `cargo xtask kernels` and commit it", path.display());
    Ok(Verdict::new(stale.map(say).collect(), || done))
}

/// Prints the PTX of a module.
pub(crate) fn print(root: &Path, module: &str) -> Result<String, Box<dyn Error>> {
    std::env::set_current_dir(root)?;
    let sources = kernel_files()?;
    let source = sources.iter().find(|source| source.module == module);
    let source = source.ok_or_else(|| format!("there is no module {module}"))?;
    // The line ends where it is printed.
    Ok(compile::one(&tools::install(Path::new(TOOLS))?, source)?.trim_end().to_owned())
}

/// Makes and writes the products whose digests differ.
fn write(sources: &[Source], stale: &BTreeSet<String>) -> Result<(), Box<dyn Error>> {
    let chosen: Vec<&Source> = sources.iter().filter(|source| stale.contains(&source.module)).collect();
    for product in made(sources, &chosen, false)? {
        product.write()?;
    }
    Product { path: digest::FILE.into(), content: Some(digest::text(&current(sources)?)) }.write()
}

/// The PTX of the `chosen` modules, the report, and PTX files of modules that no longer exist, which go.
fn made(sources: &[Source], chosen: &[&Source], check: bool) -> Result<Vec<Product>, Box<dyn Error>> {
    let tools = tools::install(Path::new(TOOLS))?;
    let modules = compile::all(chosen, check)?;
    let known = fs::read_to_string(REPORT).unwrap_or_default();
    let is_same = |name: &str| modules.iter().all(|module| module.name != name);
    let rows = if check { BTreeMap::new() } else { report::rows(&known, &tools, is_same) };
    let mut all = Vec::new();
    for source in sources {
        all.push(match modules.iter().find(|module| module.name == source.module) {
            Some(Module { name, ptx }) => Module { name: name.clone(), ptx: ptx.clone() },
            None => Module { name: source.module.clone(), ptx: fs::read_to_string(ptx_path(&source.module))? },
        });
    }
    let mut products = vec![Product { path: REPORT.into(), content: Some(report::of(&tools, &all, &rows)?) }];
    products.extend(modules.into_iter().map(|it| Product { path: ptx_path(&it.name), content: Some(it.ptx) }));
    products.extend(left_over(sources)?.into_iter().map(|path| Product { path, content: None }));
    Ok(products)
}

/// The digests of all products as they are now.
fn current(sources: &[Source]) -> Result<BTreeMap<String, digest::Digests>, Box<dyn Error>> {
    let versions = tools::versions()?;
    let settings = compile::settings(&versions.nvrtc);
    let read = |path: &Path| fs::read(path).unwrap_or_default();
    let mut all = BTreeMap::new();
    let mut of_modules = vec![versions.ptxas.as_bytes().to_vec(), report::FORM.as_bytes().to_vec()];
    for source in sources {
        let ptx = read(&ptx_path(&source.module));
        let inputs = digest::of_inputs(&SOURCES.map(Path::new), &source.path, &settings)?;
        all.insert(source.module.clone(), digest::Digests { inputs, product: digest::of([&ptx[..]]) });
        of_modules.extend([source.module.clone().into_bytes(), ptx]);
    }
    let inputs = digest::of(of_modules.iter().map(Vec::as_slice));
    all.insert(REPORT.to_owned(), digest::Digests { inputs, product: digest::of([&read(Path::new(REPORT))[..]]) });
    for path in left_over(sources)? {
        all.insert(path.display().to_string(), digest::Digests { inputs: 0, product: 0 });
    }
    Ok(all)
}

/// The path of a product by its name in the file of digests.
fn path_of(name: String) -> PathBuf {
    if name.contains('/') { name.into() } else { ptx_path(&name) }
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

/// Files among the PTX that belong to no module.
fn left_over(sources: &[Source]) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(PTX).into_iter().flatten() {
        let path = entry?.path();
        let of_module = sources.iter().any(|source| ptx_path(&source.module) == path);
        if !of_module && path != Path::new(digest::FILE) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The committed products are those of the present sources: a changed source without its PTX fails here.
    #[test]
    fn what_is_committed_is_fresh() {
        let verdict = run(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")), Task::Check).unwrap();
        assert!(matches!(&verdict, Verdict::Passed(_)), "{verdict:?}");
    }
}
