//! `cargo xtask readme`, `drawings` and `settings`: generated parts of the documents, and of the Python package.
//!
//! Programs beside other crates do the work; they are built only for these commands, so that `cargo xtask` itself stays small.

use std::env;
use std::path::Path;
use std::process::Command;

use crate::verdict::{Outcome, Verdict};

/// Writes the tables of the pages on results and on the thesis' method from the results they name; with `check` only compares them.
pub(crate) fn readme(root: &Path, check: bool) -> Outcome {
    run(root, "lightmesh-bench-examples", "readme", &["docs/results/README.md", "docs/method/thesis.md"], check)
}

/// Writes the drawings of docs/method; with `check` only compares them.
pub(crate) fn drawings(root: &Path, check: bool) -> Outcome {
    run(root, "lightmesh-render-examples", "drawings", &["docs/drawings"], check)
}

/// Writes annotations and help of Python's keyword arguments, and the menus of Blender's add-on, from the table of settings; with `check` only compares them.
pub(crate) fn settings(root: &Path, check: bool) -> Outcome {
    run(root, "lightmesh-bench-examples", "settings", &["crates/python", "blender/lightmesh_addon"], check)
}

/// Runs a program in the repository's root. If it fails, each line on stderr is a problem.
fn run(root: &Path, package: &str, program: &str, arguments: &[&str], check: bool) -> Outcome {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(root);
    command.args(["run", "--quiet", "--package", package, "--bin", program, "--"]).args(arguments);
    if check {
        command.arg("--check");
    }
    let output = command.output()?;
    let lines = |bytes: &[u8]| String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect::<Vec<_>>();
    if output.status.success() {
        return Ok(Verdict::Passed(lines(&output.stdout).join("; ")));
    }
    // The caller prefixes each line with the same word.
    let problems = lines(&output.stderr).into_iter().map(|line| line.trim_start_matches("error: ").to_owned());
    Ok(Verdict::Failed(problems.collect()))
}
