//! Where results go: standard output, standard error, and files that are there whole or not at all.

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// Why something was not, or will not be, written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// The target is a directory.
    #[error("cannot write {}: it is a directory, name a file in it", path.display())]
    IsDirectory { path: PathBuf },
    /// The directory of the target does not exist.
    #[error("cannot write {}: the directory {} does not exist, create it first", path.display(), directory.display())]
    NoDirectory { path: PathBuf, directory: PathBuf },
    /// Making or filling the file failed.
    #[error("cannot write {}: {reason}; choose another directory, or check its permissions and the space left", path.display())]
    Write { path: PathBuf, reason: io::Error },
    /// Two files would overwrite each other.
    #[error("{first} and {second} are the same file, {}; give them different names", path.display())]
    SameFile { first: &'static str, second: &'static str, path: PathBuf },
    /// Standard output is full or broken.
    #[error("cannot write to standard output: {0}; check where it leads")]
    Stdout(io::Error),
}

/// Prints to standard output. A reader that has seen enough is no error.
pub(crate) fn print(text: &str) -> Result<(), OutputError> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(OutputError::Stdout(error)),
        _ => Ok(()),
    }
}

/// Prints a line to standard error. Where that cannot be done, nobody is left to tell.
pub(crate) fn complain(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Says whether a file could be written to `path`, without touching what is there.
pub(crate) fn check_writable(path: &Path) -> Result<(), OutputError> {
    temporary_beside(path).map(drop)
}

/// Writes a file: beside `path` first, then renamed.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |reason| OutputError::Write { path: path.to_owned(), reason };
    let mut file = temporary_beside(path)?;
    file.write_all(bytes).map_err(failed)?;
    file.persist(resolved(path)).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Refuses files that are one and the same. Each comes with the name that the user knows it by.
pub(crate) fn check_distinct(files: &[(&'static str, Option<&Path>)]) -> Result<(), OutputError> {
    let mut seen: Vec<(&str, PathBuf)> = Vec::new();
    for &(second, path) in files {
        let Some(path) = path else { continue };
        let place = resolved(path);
        if let Some(&(first, _)) = seen.iter().find(|(_, other)| *other == place) {
            return Err(OutputError::SameFile { first, second, path: path.to_owned() });
        }
        seen.push((second, place));
    }
    Ok(())
}

/// Where `path` leads, whether or not it exists yet: links are followed, so that the file behind one is replaced.
fn resolved(path: &Path) -> PathBuf {
    let in_folder = || Some(fs::canonicalize(directory(path)).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(in_folder).unwrap_or_else(|| path.to_owned())
}

fn directory(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A new file in the directory of `path`, with the permissions of an ordinary new file.
fn temporary_beside(path: &Path) -> Result<NamedTempFile, OutputError> {
    let target = resolved(path);
    if target.is_dir() {
        return Err(OutputError::IsDirectory { path: path.to_owned() });
    }
    let directory = directory(&target);
    if !directory.is_dir() {
        return Err(OutputError::NoDirectory { path: path.to_owned(), directory: directory.to_owned() });
    }
    let mut builder = Builder::new();
    builder.prefix(".lightmesh-").suffix(".tmp");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666)); // less the umask
    builder.tempfile_in(directory).map_err(|reason| OutputError::Write { path: path.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_nothing_is_left_beside() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        check_writable(&path).unwrap();
        assert!(!path.exists());
        write(&path, b"first").unwrap();
        write(&path, b"2nd").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"2nd");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_or_a_missing_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(check_writable(folder.path()), Err(OutputError::IsDirectory { .. })));
        assert!(matches!(check_writable(&folder.path().join("no/a")), Err(OutputError::NoDirectory { .. })));
    }

    #[test]
    fn one_file_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join(".").join("a"));
        let same = check_distinct(&[("-o", Some(&a)), ("--stats", None), ("--layers", Some(&b))]).unwrap_err();
        assert!(same.to_string().starts_with("-o and --layers are the same file, "), "{same}");
        check_distinct(&[("-o", Some(&a)), ("--layers", Some(&folder.path().join("b")))]).unwrap();
    }
}
