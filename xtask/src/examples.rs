//! `cargo xtask readme`, `drawings` and `settings`: generated parts of the documents, and of the Python package.
//!
//! Programs beside other crates do the work; they are built only for these commands, so that `cargo xtask` itself stays small.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::verdict::{Outcome, Verdict};

/// Writes the tables of the pages on results and on the thesis' method from the results they name; with `check` only compares them.
pub(crate) fn readme(root: &Path, check: bool) -> Outcome {
    run(root, "readme", &["docs/results/README.md", "docs/method/thesis.md"], check)
}

/// Writes the drawings of docs/method; with `check` only compares them.
pub(crate) fn drawings(root: &Path, check: bool) -> Outcome {
    run(root, "drawings", &["docs/drawings"], check)
}

/// Writes annotations and help of Python's keyword arguments, and the menus of Blender's add-on, from the table of settings; with `check` only compares them.
pub(crate) fn settings(root: &Path, check: bool) -> Outcome {
    run(root, "settings", &["crates/python", "blender/lightmesh_addon"], check)
}

/// Runs a program in the repository's root. If it fails, each line on stderr is a problem.
fn run(root: &Path, program: &str, arguments: &[&str], check: bool) -> Outcome {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // Built with the tests, all crates have the features that they have for tests, and are not compiled once more.
    let build = ["build", "--quiet", "--workspace", "--tests", "--bin", program];
    let built = Command::new(cargo).current_dir(root).args(build).output()?;
    let output = match built.status.success() {
        false => built,
        true => {
            let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
            let mut command = Command::new(target.join("debug").join(program));
            command.current_dir(root).args(arguments).args(check.then_some("--check"));
            command.output()?
        }
    };
    let lines = |bytes: &[u8]| String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect::<Vec<_>>();
    if output.status.success() {
        return Ok(Verdict::Passed(lines(&output.stdout).join("; ")));
    }
    // The caller prefixes each line with the same word.
    let problems = lines(&output.stderr).into_iter().map(|line| line.trim_start_matches("error: ").to_owned());
    Ok(Verdict::Failed(problems.collect()))
}
