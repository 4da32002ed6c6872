//! Records the commit from which the program is built: `LIGHTMESH_COMMIT` if set, else from Git, else nothing.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-env-changed=LIGHTMESH_COMMIT");
    // The index changes with every commit, checkout and staged change.
    if let Some(index) = git(&["rev-parse", "--path-format=absolute", "--git-path", "index"]) {
        println!("cargo::rerun-if-changed={index}");
    }
    let given = std::env::var("LIGHTMESH_COMMIT").ok();
    if let Some(commit) = given.or_else(|| git(&["describe", "--always", "--abbrev=12", "--dirty", "--exclude=*"])) {
        println!("cargo::rustc-env=LIGHTMESH_COMMIT={commit}");
    }
}

/// The first line printed by Git; `None` without Git or a repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()?.lines().next().map(str::to_owned)
}
