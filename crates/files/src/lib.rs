//! The border between the program and files: output files that are written completely or not at all, input files that are
//! [read](read_inside) only where they may lie, and text of either made [visible].
//!
//! A [`Replacement`] is a temporary file next to its target. It is filled, then renamed over the target: an interrupted program
//! or a full disk leaves the previous file intact and no temporary file behind.
//!
//! ```
//! use std::io::Write;
//!
//! use lightmesh_files::Replacement;
//!
//! let folder = tempfile::tempdir()?;
//! let mut file = Replacement::of(folder.path().join("notes.txt"))?;
//! file.write_all(b"all of it")?;
//! file.commit()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod read;
mod visible;

use std::fs;
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

pub use read::{ReadError, read, read_inside};
pub use visible::{visible, visible_json, visible_lines};

/// Why a target cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// The target is a directory.
    #[error("cannot write {}: it is a directory; name a file in it", path.display())]
    IsDirectory {
        /// The target.
        path: PathBuf,
    },
    /// The directory of the target does not exist.
    #[error("cannot write {}: the directory {} does not exist; create it first", path.display(), directory.display())]
    NoDirectory {
        /// The target.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
    },
    /// No file can be created in the directory of the target.
    #[error(
        "cannot write {}: no file can be created in {} ({reason}); choose another directory or change its permissions",
        path.display(), directory.display()
    )]
    Unwritable {
        /// The target.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
}

/// A file that replaces its target when it is committed. If dropped before, it is removed.
#[derive(Debug)]
pub struct Replacement {
    file: NamedTempFile,
    target: PathBuf,
}

impl Replacement {
    /// Creates an empty file next to `path`, with the permissions of an ordinary new file.
    ///
    /// # Errors
    /// [`TargetError`] if the file cannot be created.
    pub fn of(path: impl AsRef<Path>) -> Result<Replacement, TargetError> {
        let path = path.as_ref();
        let target = resolved(path);
        if target.is_dir() {
            return Err(TargetError::IsDirectory { path: path.to_owned() });
        }
        let directory = directory(&target);
        if !directory.is_dir() {
            return Err(TargetError::NoDirectory { path: path.to_owned(), directory: directory.to_owned() });
        }
        let mut builder = Builder::new();
        builder.prefix(".lightmesh-").suffix(".tmp");
        // Temporary files are private, but this one will be permanent. The umask still applies.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(directory).map_err(|reason| TargetError::Unwritable {
            path: path.to_owned(),
            directory: directory.to_owned(),
            reason,
        })?;
        Ok(Replacement { file, target })
    }

    /// Renames the file over its target.
    ///
    /// # Errors
    /// The system's error; the target is then unchanged.
    pub fn commit(self) -> io::Result<()> {
        self.file.persist(self.target).map(drop).map_err(|error| error.error)
    }
}

impl Write for Replacement {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Replacement {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}

/// Checks that a file could be written to `path`, without touching an existing one.
///
/// # Errors
/// The [`TargetError`] that [`Replacement::of`] would return.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), TargetError> {
    Replacement::of(path).map(drop)
}

/// The target of `path`, whether or not it exists yet: links are followed, so that the linked file is replaced.
pub fn resolved(path: &Path) -> PathBuf {
    let in_directory = || Some(fs::canonicalize(directory(path)).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(in_directory).unwrap_or_else(|| path.to_owned())
}

fn directory(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn put(path: &Path, bytes: &[u8]) {
        let mut file = Replacement::of(path).unwrap();
        file.write_all(bytes).unwrap();
        file.commit().unwrap();
    }

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        check_writable(&path).unwrap();
        assert!(!path.exists());
        put(&path, b"first");
        put(&path, b"2nd");
        assert_eq!(fs::read(&path).unwrap(), b"2nd");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn an_unfinished_file_leaves_the_earlier_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        put(&path, b"first");
        Replacement::of(&path).unwrap().write_all(b"half of the sec").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"first");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_directory_or_a_missing_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(check_writable(folder.path()), Err(TargetError::IsDirectory { .. })));
        assert!(matches!(check_writable(folder.path().join("no/a")), Err(TargetError::NoDirectory { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn a_new_file_is_open_to_whom_new_files_are() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, usual) = (folder.path().join("ours"), folder.path().join("usual"));
        put(&ours, b"");
        fs::write(&usual, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&usual));
    }

    #[cfg(unix)]
    #[test]
    fn the_file_behind_a_link_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        put(&link, b"new");
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    }
}
