//! Reading results back.

use std::fs;
use std::path::Path;

use crate::{BenchError, Results};

impl Results {
    /// Reads a file written by `lightmesh bench --json`.
    ///
    /// # Errors
    /// [`BenchError::Read`] if the file cannot be read, [`BenchError::Malformed`] if it contains something else,
    /// [`BenchError::Version`] if it has another version of the format.
    pub fn load(path: impl AsRef<Path>) -> Result<Results, BenchError> {
        let path = path.as_ref();
        let text = fs::read_to_string(path).map_err(|reason| BenchError::Read { path: path.to_owned(), reason })?;
        let results: Result<Results, _> = serde_json::from_str(&text);
        let results = results.map_err(|reason| BenchError::Malformed { path: path.to_owned(), reason })?;
        if results.version != Results::VERSION {
            let (found, known) = (results.version, Results::VERSION);
            return Err(BenchError::Version { path: path.to_owned(), found, known });
        }
        Ok(results)
    }
}
