//! Writing a report to a folder.

use std::path::{Path, PathBuf};

use lightmesh_files::{Ready, publish};

use super::Report;
use crate::OutputError;
use crate::output::make_folder;

/// As Markdown and as HTML.
const PAGES: [&str; 2] = ["report.md", "report.html"];

impl Report {
    /// Folders of plots and images in the folder of a report.
    pub const FOLDERS: [&str; 2] = ["plots", "pictures"];

    /// The pages of a report in `folder`.
    pub fn pages(folder: &Path) -> [PathBuf; 2] {
        PAGES.map(|name| folder.join(name))
    }

    /// Writes `report.md` with its plots and images, and `report.html`, to `folder`, which is created if missing. All files
    /// appear together, pages after the files they refer to.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        Ok(publish(self.ready(folder)?)?)
    }

    /// The files that [`Report::write`] writes to `folder`.
    pub fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let assets = self.assets.files().map(|(name, _)| name);
        assets.chain(PAGES.map(str::to_owned)).map(|name| folder.join(name)).collect()
    }

    /// The files that [`Report::write`] writes, which appear only when they are published.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn ready(&self, folder: &Path) -> Result<Vec<Ready>, OutputError> {
        make_folder(folder)?;
        for part in Report::FOLDERS {
            if self.assets.files().any(|(name, _)| name.starts_with(part)) {
                make_folder(&folder.join(part))?;
            }
        }
        let mut files = Vec::new();
        for (name, bytes) in self.assets.files() {
            files.push(Ready::with(folder.join(name), bytes)?);
        }
        for (name, page) in PAGES.iter().zip([self.markdown(), self.html()]) {
            files.push(Ready::with(folder.join(name), page.as_bytes())?);
        }
        Ok(files)
    }
}
