//! What a check has found.

use std::error::Error;

/// The result of a check; an error if it could not run.
pub(crate) type Outcome = Result<Verdict, Box<dyn Error>>;

/// What was found.
#[derive(Debug)]
pub(crate) enum Verdict {
    /// All is well; how much was checked.
    Passed(String),
    /// The problems, a line each.
    Failed(Vec<String>),
}

impl Verdict {
    pub(crate) fn new(problems: Vec<impl ToString>, passed: impl FnOnce() -> String) -> Verdict {
        if problems.is_empty() {
            Verdict::Passed(passed())
        } else {
            Verdict::Failed(problems.iter().map(ToString::to_string).collect())
        }
    }
}
