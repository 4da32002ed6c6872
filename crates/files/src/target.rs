//! What a path names, and whether it can be written.

use std::fs::{self, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::stream::Stream;

/// Links from link to link that are followed to a file that does not exist yet; systems follow no more either.
const MAX_LINKS: usize = 40;

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
    /// The path does not end with a name.
    #[error("cannot write `{}`: this does not name a file; add a file name", path.display())]
    NoName {
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
    /// What should be the directory of the target is a file.
    #[error("cannot write {}: {} is not a directory; choose another", path.display(), directory.display())]
    NotADirectory {
        /// The target.
        path: PathBuf,
        /// What is not a directory.
        directory: PathBuf,
    },
    /// No file can be created in the directory of the target.
    #[error("cannot write {}: no file can be created in {} ({reason}); {}", path.display(), directory.display(), remedy(reason))]
    Unwritable {
        /// The target.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
    /// The target exists, but must not be written.
    #[error("cannot write {}: it cannot be opened for writing ({reason}); choose another file or change its permissions", path.display())]
    Protected {
        /// The target.
        path: PathBuf,
        /// The system's message.
        reason: io::Error,
    },
}

/// What to do if no file can be created in a directory.
fn remedy(reason: &io::Error) -> &'static str {
    match reason.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "free space on its disk or choose another directory",
        _ => "choose another directory or change its permissions",
    }
}

/// Where the bytes of an output go.
#[derive(Debug)]
pub(crate) enum Target {
    /// To a file that is replaced.
    File(FileTarget),
    /// To something that is written through.
    Stream(Stream),
}

/// A file that will be replaced or created.
#[derive(Debug)]
pub(crate) struct FileTarget {
    /// The file itself: links are resolved.
    pub(crate) path: PathBuf,
    /// The file that is there now.
    pub(crate) existing: Option<Metadata>,
}

impl Target {
    /// Whether a file could really be created is seen by creating it.
    pub(crate) fn of(path: &Path) -> Result<Target, TargetError> {
        let owned = || path.to_owned();
        let protected = |reason| TargetError::Protected { path: owned(), reason };
        let existing = match fs::metadata(path) {
            Ok(status) if status.is_dir() => return Err(TargetError::IsDirectory { path: owned() }),
            Ok(status) => Some(status),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => None,
            Err(reason) => return Err(protected(reason)),
        };
        let Some(status) = existing else {
            let file = followed(path);
            if path.file_name().is_none() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
                return Err(TargetError::NoName { path: owned() });
            }
            check_directory(path, directory(&file))?;
            return Ok(Target::File(FileTarget { path: file, existing: None }));
        };
        check_permission(path).map_err(protected)?;
        match Stream::at(path, &status) {
            Some(stream) => Ok(Target::Stream(stream)),
            None => {
                let file = fs::canonicalize(path).map_err(protected)?;
                Ok(Target::File(FileTarget { path: file, existing: Some(status) }))
            }
        }
    }
}

/// Checks that an existing file may be written, without opening it: that would have effects on pipes and devices.
#[cfg(unix)]
fn check_permission(path: &Path) -> io::Result<()> {
    use rustix::fs::{Access, AtFlags, CWD, accessat};
    Ok(accessat(CWD, path, Access::WRITE_OK, AtFlags::EACCESS)?)
}

#[cfg(not(unix))]
fn check_permission(path: &Path) -> io::Result<()> {
    fs::OpenOptions::new().write(true).open(path).map(drop)
}

/// Fails unless files can be in what should be the directory of a target.
pub(crate) fn check_directory(path: &Path, directory: &Path) -> Result<(), TargetError> {
    let (path, directory) = (path.to_owned(), directory.to_owned());
    match fs::metadata(&directory) {
        Ok(status) if status.is_dir() => Ok(()),
        Ok(_) => Err(TargetError::NotADirectory { path, directory }),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(TargetError::NoDirectory { path, directory }),
        Err(error) if error.kind() == ErrorKind::NotADirectory => Err(TargetError::NotADirectory { path, directory }),
        Err(reason) => Err(TargetError::Unwritable { path, directory, reason }),
    }
}

/// What makes two paths the same file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Identity(Key);

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Key {
    /// Device and number of a file that exists.
    #[cfg(unix)]
    Inode(u64, u64),
    /// The resolved path of one that does not exist yet.
    Path(PathBuf),
}

/// The identity of the file at `path`, whether or not it exists yet; links are followed. `None` for devices, such as `/dev/null`:
/// what is written there overwrites nothing.
pub fn identity(path: impl AsRef<Path>) -> Option<Identity> {
    let path = path.as_ref();
    #[cfg(unix)]
    if let Ok(status) = fs::metadata(path) {
        use std::os::unix::fs::{FileTypeExt, MetadataExt};
        let inode = Identity(Key::Inode(status.dev(), status.ino()));
        return (!status.file_type().is_char_device()).then_some(inode);
    }
    let file = followed(path);
    let in_directory = || Some(fs::canonicalize(directory(&file)).ok()?.join(file.file_name()?));
    Some(Identity(Key::Path(fs::canonicalize(&file).ok().or_else(in_directory).unwrap_or(file))))
}

/// The end of a chain of links, which does not exist yet.
fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        let Ok(next) = fs::read_link(&path) else { break };
        path = directory(&path).join(next);
    }
    path
}

/// The directory in which a path names something: `.` for a name alone, and the root for the root.
pub fn directory(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        Some(_) => Path::new("."),
        None => path,
    }
}
