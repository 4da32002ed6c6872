//! Writing a report to a folder.

use std::path::Path;

use super::Report;
use crate::OutputError;
use crate::output::{make_folder, write};

/// Parts of the folder.
const FOLDERS: [&str; 2] = ["plots", "pictures"];

impl Report {
    /// Writes `report.md` with its plots and images, and `report.html`, to `folder`, which is created if missing. Each file is
    /// replaced completely or not at all; pages are written after the files they refer to.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        make_folder(folder)?;
        for part in FOLDERS {
            if self.assets.files().any(|(name, _)| name.starts_with(part)) {
                make_folder(&folder.join(part))?;
            }
        }
        for (name, bytes) in self.assets.files() {
            write(&folder.join(name), bytes)?;
        }
        write(&folder.join("report.md"), self.markdown().as_bytes())?;
        write(&folder.join("report.html"), self.html().as_bytes())
    }
}
