//! Reading regular files, anywhere or only in a folder.
//!
//! A file that another file names is [read in its folder](read_inside): links are followed, and what they lead to must lie in the folder.
//! The path without links is then opened one name after another, following none, so that a link that appears in the meantime is an
//! error (on Unix; elsewhere the check is not repeated).

use std::fs::{self, File, Metadata};
use std::io::{self, Read};
use std::path::Path;

use lightmesh_memory::{Budget, OverBudget};

/// Bytes of a stream that are read before more memory is asked for.
const FIRST: usize = 1 << 16;

/// Why a file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The system's error.
    #[error(transparent)]
    System(#[from] io::Error),
    /// It is a folder, a pipe, a socket or a device, or a link to one.
    #[error("not a regular file")]
    Irregular,
    /// Its real path is not in the folder.
    #[error("outside the folder")]
    Outside,
    /// What is to be read does not fit into memory.
    #[error(transparent)]
    Memory(#[from] OverBudget),
}

/// How much of a file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portion {
    /// This many bytes from its beginning, if it has them.
    pub wanted: u64,
    /// The memory for them.
    pub budget: Budget,
}

impl Portion {
    /// Everything, if the machine has memory for it.
    pub const ALL: Portion = Portion { wanted: u64::MAX, budget: Budget::new(None) };
}

/// The content of a regular file. Pipes and devices, which might never end, are not opened.
///
/// # Errors
/// [`ReadError`] except [`ReadError::Outside`].
pub fn read(path: &Path, portion: Portion) -> Result<Vec<u8>, ReadError> {
    regular(&fs::metadata(path)?)?;
    read_portion(open(path)?, portion)
}

/// The content of a regular file whose real path is in `folder`; the empty path is the current one.
///
/// # Errors
/// [`ReadError`]; [`ReadError::Outside`] if a link or `..` in `path` leads out of the folder.
pub fn read_inside(folder: &Path, path: &Path, portion: Portion) -> Result<Vec<u8>, ReadError> {
    let folder = fs::canonicalize(if folder.as_os_str().is_empty() { Path::new(".") } else { folder })?;
    let real = fs::canonicalize(path)?;
    let inside = real.strip_prefix(&folder).map_err(|_| ReadError::Outside)?;
    regular(&fs::symlink_metadata(&real)?)?;
    read_portion(open_inside(&folder, inside)?, portion)
}

/// Everything that a stream yields, such as standard input. One that never ends is an error once the memory does not
/// suffice.
///
/// # Errors
/// [`ReadError::System`] or [`ReadError::Memory`].
pub fn read_stream(mut source: impl Read, budget: Budget) -> Result<Vec<u8>, ReadError> {
    let mut bytes: Vec<u8> = Vec::new();
    loop {
        let more = bytes.len().max(FIRST);
        let needed = (bytes.len() + more) as u64;
        // While the content moves to a larger place, the smaller one is still held.
        budget.check(needed)?;
        let refused = |_| OverBudget { needed, left: 0, limit: budget.limit() };
        bytes.try_reserve_exact(more).map_err(refused)?;
        if source.by_ref().take(more as u64).read_to_end(&mut bytes)? < more {
            return Ok(bytes);
        }
    }
}

/// Looked at before opening, which may wait or have effects, and once more afterwards.
fn regular(status: &Metadata) -> Result<(), ReadError> {
    if status.is_file() { Ok(()) } else { Err(ReadError::Irregular) }
}

fn read_portion(file: File, Portion { wanted, budget }: Portion) -> Result<Vec<u8>, ReadError> {
    let status = file.metadata()?;
    regular(&status)?;
    let size = status.len().min(wanted);
    budget.check(size)?;
    let mut bytes = Vec::with_capacity(size as usize);
    file.take(wanted).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(unix)]
use unix::{open, open_inside};

#[cfg(unix)]
mod unix {
    use std::fs::File;
    use std::io;
    use std::path::Path;

    use rustix::fs::{CWD, Mode, OFlags, openat};

    /// Opening a pipe does not wait for its other end.
    const FLAGS: OFlags = OFlags::RDONLY.union(OFlags::CLOEXEC).union(OFlags::NONBLOCK).union(OFlags::NOCTTY);

    pub(super) fn open(path: &Path) -> io::Result<File> {
        Ok(File::from(openat(CWD, path, FLAGS, Mode::empty())?))
    }

    /// Opens a path below `folder`; any link on the way is an error.
    pub(super) fn open_inside(folder: &Path, inside: &Path) -> io::Result<File> {
        let mut found = openat(CWD, folder, FLAGS | OFlags::DIRECTORY, Mode::empty())?;
        for name in inside {
            found = openat(&found, name, FLAGS | OFlags::NOFOLLOW, Mode::empty())?;
        }
        Ok(File::from(found))
    }
}

#[cfg(not(unix))]
fn open(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(not(unix))]
fn open_inside(folder: &Path, inside: &Path) -> io::Result<File> {
    File::open(folder.join(inside))
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use tempfile::TempDir;

    use super::*;

    /// The folder `scene` with the file `parts/a`, and the file `b` next to it.
    fn scene() -> (TempDir, PathBuf) {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("scene");
        fs::create_dir_all(folder.join("parts")).unwrap();
        fs::write(folder.join("parts/a"), "in").unwrap();
        fs::write(place.path().join("b"), "out").unwrap();
        (place, folder)
    }

    #[test]
    fn a_file_in_the_folder_is_read_and_others_are_not() {
        let (place, folder) = scene();
        assert_eq!(read_inside(&folder, &folder.join("parts/../parts/a"), Portion::ALL).unwrap(), b"in");
        assert_eq!(read(&place.path().join("b"), Portion::ALL).unwrap(), b"out");
        assert!(matches!(read_inside(&folder, &folder.join("../b"), Portion::ALL), Err(ReadError::Outside)));
        assert!(matches!(read_inside(&folder, &folder, Portion::ALL), Err(ReadError::Irregular)));
        assert!(matches!(read(&folder, Portion::ALL), Err(ReadError::Irregular)));
        assert!(matches!(read_inside(&folder, &folder.join("c"), Portion::ALL), Err(ReadError::System(_))));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_in_the_folder_and_not_out_of_it() {
        use std::os::unix::fs::symlink;
        let (place, folder) = scene();
        symlink("parts", folder.join("near")).unwrap();
        symlink(folder.join("parts/a"), folder.join("absolute")).unwrap();
        symlink("../b", folder.join("far")).unwrap();
        symlink("..", folder.join("up")).unwrap();
        symlink("/dev/zero", folder.join("device")).unwrap();
        symlink(&folder, place.path().join("scene again")).unwrap();
        let read = |path: &str| read_inside(&place.path().join("scene again"), &folder.join(path), Portion::ALL);
        for path in ["near/a", "absolute", "parts/a"] {
            assert_eq!(read(path).unwrap(), b"in", "{path}");
        }
        for path in ["far", "up/b", "device"] {
            assert!(matches!(read(path), Err(ReadError::Outside)), "{path}");
        }
        assert_eq!(read("up/scene/parts/a").unwrap(), b"in");
        assert!(matches!(super::read(&folder.join("device"), Portion::ALL), Err(ReadError::Irregular)));
    }

    /// What happens if a folder becomes a link after its path was found good.
    #[cfg(unix)]
    #[test]
    fn a_link_that_appears_later_is_not_followed() {
        let place = tempfile::tempdir().unwrap();
        fs::create_dir_all(place.path().join("out")).unwrap();
        fs::write(place.path().join("out/a"), "out").unwrap();
        let folder = place.path().join("scene");
        fs::create_dir(&folder).unwrap();
        std::os::unix::fs::symlink("../out", folder.join("parts")).unwrap();
        assert!(open_inside(&folder, Path::new("parts/a")).is_err());
    }

    #[test]
    fn a_stream_is_read_to_its_end_or_until_memory_is_short() {
        for length in [0, 1, FIRST - 1, FIRST, FIRST + 1, 5 * FIRST + 7] {
            let bytes: Vec<u8> = (0..length).map(|place| (place % 251) as u8).collect();
            // In small portions, as from a pipe.
            let (first, rest) = bytes.split_at(length / 3);
            assert_eq!(read_stream(first.chain(rest), Budget::default()).unwrap(), bytes);
        }
        let endless = read_stream(io::repeat(0), Budget::new(Some(1 << 24)));
        assert!(matches!(endless, Err(ReadError::Memory(OverBudget { limit: Some(0x100_0000), .. }))), "{endless:?}");
    }

    #[test]
    fn no_more_is_read_than_wanted_and_none_if_that_is_too_much() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a");
        fs::write(&path, "abcdef").unwrap();
        File::options().write(true).open(&path).unwrap().set_len(1 << 32).unwrap();
        let portion = |wanted| read(&path, Portion { wanted, budget: Budget::new(Some(1 << 24)) });
        assert_eq!(portion(4).unwrap(), b"abcd");
        assert_eq!(portion(0).unwrap(), b"");
        assert!(matches!(portion(u64::MAX), Err(ReadError::Memory(OverBudget { needed: 0x1_0000_0000, .. }))));
        assert!(matches!(portion(1 << 25), Err(ReadError::Memory(OverBudget { needed: 0x200_0000, .. }))));
    }
}
