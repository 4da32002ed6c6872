//! Checks of the repository itself, what is made from its sources and committed, and inputs for fuzzing: `cargo xtask licences`,
//! `cargo xtask check-docs`, `cargo xtask kernels`, `cargo xtask readme` and `cargo xtask fuzz-corpus`.
//!
//! A check gives back what it found; only this file prints and exits.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod corpus;
mod docs;
mod kernels;
mod licences;
mod readme;

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask licences      every dependency, for any target, is under a licence that the project may use
       cargo xtask check-docs    every file that the documents point to exists
       cargo xtask kernels       makes the layout header, the kernels' PTX and docs/kernels.md; with --check, says whether they are
                                 as they should be
       cargo xtask readme        writes the tables of README and METHOD from the results that they name; with --check, says
                                 whether they are as they should be
       cargo xtask fuzz-corpus   fills fuzz/corpus with the seeds and the scenes here, and with the models in the folder
                                 whose name follows";

/// What a check has to say; an error where it could not be made.
type Outcome = Result<Verdict, Box<dyn Error>>;

/// What was found.
enum Verdict {
    /// All is well: how much was looked at.
    Passed(String),
    /// What is wrong, a line each.
    Failed(Vec<String>),
}

impl Verdict {
    fn new(problems: Vec<impl ToString>, passed: impl FnOnce() -> String) -> Verdict {
        if problems.is_empty() {
            Verdict::Passed(passed())
        } else {
            Verdict::Failed(problems.iter().map(ToString::to_string).collect())
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    let verdict = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["licences"] => licences::check(root),
        ["check-docs"] => docs::check(root),
        ["kernels"] => kernels::run(root, false),
        ["kernels", "--check"] => kernels::run(root, true),
        ["readme"] => readme::run(root, false),
        ["readme", "--check"] => readme::run(root, true),
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
