//! Regenerates the tables in documents from results, or with `--check` only compares them. See [`lightmesh_bench::readme`].
//!
//! `cargo run -p lightmesh-bench-examples --bin readme -- docs/results/README.md docs/method/thesis.md [--check]`, or `cargo xtask readme [--check]`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

use std::error::Error;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use lightmesh_bench::readme;
use lightmesh_files::Output;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let (flags, documents): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word == "--check");
    let mut code = ExitCode::SUCCESS;
    for document in documents.iter().map(PathBuf::from) {
        let root = document.parent().unwrap_or(Path::new(""));
        let text = std::fs::read_to_string(&document)?;
        let name = document.display();
        let tables = readme::tables(&text, root).map_err(|error| format!("{name}: {error}"))?;
        match &tables.differing[..] {
            [] => println!("{name}: {} tables from results, all up to date", tables.count),
            lines if flags.is_empty() => {
                let mut file = Output::to(&document)?;
                file.write_all(tables.text.as_bytes())?;
                file.commit()?;
                println!("{name}: {} of {} tables updated", lines.len(), tables.count);
            }
            lines => {
                for line in lines {
                    eprintln!("error: {name}:{line}: the table does not match its results; run `cargo xtask readme`");
                }
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}
