//! The files that a draft refers to.

use std::path::{Path, PathBuf};

use super::Draft;
use crate::LoadError;
use crate::build::file_access::beside;
use crate::build::quote::reference;

impl Draft {
    /// The file that `source` refers to as `name`. One that is missing or outside, as are paths of its author's computer, may lie next to
    /// `source`: then there is a warning.
    pub(crate) fn read_nearby(&mut self, source: &Path, name: &str) -> Result<(PathBuf, Vec<u8>), LoadError> {
        let missing = match self.access.read_beside(source, name) {
            Err(error @ (LoadError::Outside { .. } | LoadError::Read { .. })) => error,
            found => return found,
        };
        let base = name.rsplit(['/', '\\']).next().unwrap_or_default();
        match self.access.read_beside(source, base) {
            Ok(found) if base != name => {
                self.refer(source, base);
                let (source, named) = (source.display(), reference(name));
                self.warnings
                    .push(format!("{source}: `{named}` cannot be used; {base} next to the file is used instead"));
                Ok(found)
            }
            _ => Err(missing),
        }
    }

    /// Notes that `source` refers to a file as `name`, whether or not the file exists and is used.
    pub(crate) fn refer(&mut self, source: &Path, name: &str) {
        self.files.extend(beside(source, name));
    }
}
