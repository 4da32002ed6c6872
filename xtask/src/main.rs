//! Checks of the repository itself, files generated from its sources and committed, and inputs for fuzzing: see `USAGE`.
//!
//! A check returns what it found; only this file prints and exits.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod circles;
mod corpus;
mod docs;
mod examples;
mod kernels;
mod map;
mod pages;
mod references;
mod verdict;

use std::path::Path;
use std::process::ExitCode;

use kernels::Task;
use verdict::Verdict;

const USAGE: &str = "\
usage: cargo xtask check-docs          checks that every file that the documents name exists
       cargo xtask circles             checks that no modules of a crate import each other in a circle
       cargo xtask kernels [--check [--recompile]]
                                       writes the layout header, the kernels' PTX and docs/kernels.md
       cargo xtask map [--check]       writes docs/map.md: each source file with the first sentence of its header
       cargo xtask readme [--check]    writes the tables of docs/results and docs/method from the results they name
       cargo xtask drawings [--check]  writes the drawings of docs/method to docs/drawings
       cargo xtask settings [--check]  writes types and help of Python's keyword arguments from the table of settings
       cargo xtask fuzz-corpus [DIR]   fills fuzz/corpus with the seeds, the scenes here and the models in DIR

With --check nothing is written: the command fails if a file is out of date. Kernels are checked by digests of their sources; with
--recompile they are also compiled again and compared.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    let verdict = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["check-docs"] => docs::check(root),
        ["circles"] => circles::check(root),
        ["kernels"] => kernels::run(root, Task::Write),
        ["kernels", "--check"] => kernels::run(root, Task::Check),
        ["kernels", "--check", "--recompile"] => kernels::run(root, Task::Recompile),
        ["kernels", kernels::ONE, module] => kernels::print(root, module).map(Verdict::Passed),
        ["map"] => map::run(root, false),
        ["map", "--check"] => map::run(root, true),
        ["readme"] => examples::readme(root, false),
        ["readme", "--check"] => examples::readme(root, true),
        ["drawings"] => examples::drawings(root, false),
        ["drawings", "--check"] => examples::drawings(root, true),
        ["settings"] => examples::settings(root, false),
        ["settings", "--check"] => examples::settings(root, true),
        ["fuzz-corpus"] => corpus::fill(root, None),
        ["fuzz-corpus", scenes] => corpus::fill(root, Some(Path::new(scenes))),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match verdict {
        Ok(Verdict::Passed(summary)) => {
            println!("{summary}");
            ExitCode::SUCCESS
        }
        Ok(Verdict::Failed(problems)) => {
            for problem in problems {
                eprintln!("error: {problem}");
            }
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}
