//! Lines of OBJ and MTL files that cannot be used.

use std::path::Path;

use crate::build::error::{LoadError, Place};

/// The problem with a line, and the remedy.
pub(super) struct Fault(pub(super) String, pub(super) &'static str);

/// The error for a line that cannot be used.
pub(super) fn malformed(path: &Path, line: usize, problem: String, remedy: &str) -> LoadError {
    LoadError::Malformed { place: Place::line(path, line).into(), problem, remedy: remedy.to_owned() }
}
