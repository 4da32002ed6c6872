//! A report in a folder.

use std::fs;
use std::io::Write;
use std::path::Path;

use lightmesh_files::{Replacement, check_writable};

use super::{Report, ReportError};

/// Parts of the folder.
const FOLDERS: [&str; 2] = ["plots", "pictures"];

/// Makes a folder where it is missing, and says whether a report could be written into it: to be asked before a long run.
///
/// # Errors
/// [`ReportError::Folder`] or [`ReportError::Target`].
pub fn prepare_folder(folder: &Path) -> Result<(), ReportError> {
    made(folder)?;
    Ok(check_writable(folder.join("report.md"))?)
}

impl Report {
    /// Writes `report.md`, `report.html` and what the former needs into `folder`, which is made where it is missing. Each file is there
    /// whole or as it was before; pages come after what they show.
    ///
    /// # Errors
    /// [`ReportError::Folder`], [`ReportError::Target`] or [`ReportError::Write`].
    pub fn write(&self, folder: &Path) -> Result<(), ReportError> {
        made(folder)?;
        for part in FOLDERS {
            if self.assets.files().any(|(name, _)| name.starts_with(part)) {
                made(&folder.join(part))?;
            }
        }
        for (name, bytes) in self.assets.files() {
            write(&folder.join(name), bytes)?;
        }
        write(&folder.join("report.md"), self.markdown().as_bytes())?;
        write(&folder.join("report.html"), self.html().as_bytes())
    }
}

fn made(path: &Path) -> Result<(), ReportError> {
    fs::create_dir_all(path).map_err(|reason| ReportError::Folder { path: path.to_owned(), reason })
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let failed = |reason| ReportError::Write { path: path.to_owned(), reason };
    let mut file = Replacement::of(path)?;
    file.write_all(bytes).map_err(failed)?;
    file.commit().map_err(failed)
}
