//! `cargo xtask readme`: tables of documents that are made from results.
//!
//! The work is done by an example of `lightmesh-bench`, which knows results and reports; it is built only when it is asked for.

use std::env;
use std::path::Path;
use std::process::Command;

use crate::{Outcome, Verdict};

/// Documents with such tables.
const DOCUMENTS: [&str; 2] = ["README.md", "METHOD.md"];

/// Writes the tables anew, or says which differ where they are only to be looked at (`check`).
pub(crate) fn run(root: &Path, check: bool) -> Outcome {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(root);
    command.args(["run", "--quiet", "--package", "lightmesh-bench", "--example", "readme", "--"]).args(DOCUMENTS);
    if check {
        command.arg("--check");
    }
    let output = command.output()?;
    let lines = |bytes: &[u8]| String::from_utf8_lossy(bytes).lines().map(str::to_owned).collect::<Vec<_>>();
    if output.status.success() {
        return Ok(Verdict::Passed(lines(&output.stdout).join("; ")));
    }
    // Each line comes with the word that is printed before it again.
    let problems = lines(&output.stderr).into_iter().map(|line| line.trim_start_matches("error: ").to_owned());
    Ok(Verdict::Failed(problems.collect()))
}
