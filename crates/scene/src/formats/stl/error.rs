//! STL files that cannot be used.

use std::path::Path;

use crate::build::error::{LoadError, Place};

/// The error at a line of a text, or in a binary file.
pub(super) fn malformed(path: &Path, line: Option<usize>, problem: String) -> LoadError {
    let place = line.map_or_else(|| Place::file(path), |line| Place::line(path, line));
    let remedy = "export it again, or copy it again if it is truncated".to_owned();
    LoadError::Malformed { place: place.into(), problem, remedy }
}
