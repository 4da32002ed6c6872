//! PLY files that cannot be used.

use std::path::Path;

use crate::build::error::{LoadError, Place};

/// The error at a line, if the file has lines.
pub(super) fn malformed(path: &Path, line: Option<usize>, problem: String, remedy: &str) -> LoadError {
    let place = line.map_or_else(|| Place::file(path), |line| Place::line(path, line));
    LoadError::Malformed { place: place.into(), problem, remedy: remedy.to_owned() }
}
