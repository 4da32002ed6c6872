//! What is written through: standard output and error, pipes, devices.

#[cfg(unix)]
use std::fs::File;
use std::fs::{self, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether standard output was closed when that was looked at.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Something that is not replaced by renaming.
#[derive(Debug)]
pub(crate) enum Stream {
    /// Standard output, or the file it goes to.
    Stdout,
    /// Standard error, or the file it goes to.
    Stderr,
    /// A pipe, a device, or another open file of this process.
    Named(PathBuf),
}

impl Stream {
    /// The stream at `path`, which exists; `None` if it is an ordinary file.
    pub(crate) fn at(path: &Path, status: &Metadata) -> Option<Stream> {
        if is_open(status, io::stdout()) {
            return Some(Stream::Stdout);
        }
        if is_open(status, io::stderr()) {
            return Some(Stream::Stderr);
        }
        (!status.is_file() || is_descriptor(path)).then(|| Stream::Named(path.to_owned()))
    }

    /// Opens it for writing. For a pipe this waits until there is a reader.
    pub(crate) fn open(&self) -> io::Result<Box<dyn Write>> {
        Ok(match self {
            Stream::Stdout => check_output().map(|()| Box::new(io::stdout().lock()))?,
            Stream::Stderr => Box::new(io::stderr().lock()),
            Stream::Named(path) => {
                // Another open file of this process may have content, to which shells may append.
                let append = fs::metadata(path)?.is_file();
                Box::new(OpenOptions::new().write(true).append(append).open(path)?)
            }
        })
    }
}

/// Finds out whether standard output is closed, as by `>&-` in a shell. Rust's runtime opens `/dev/null` in its place before `main`, and calls what is
/// written to a closed one written: so a program asks before its `main`, and a library when it is called.
pub fn look_at_output() {
    #[cfg(unix)]
    if rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err() {
        CLOSED.store(true, Ordering::Relaxed);
    }
}

/// Fails if standard output was closed when [`look_at_output`] was called.
///
/// # Errors
/// That it is closed.
pub fn check_output() -> io::Result<()> {
    if CLOSED.load(Ordering::Relaxed) { Err(io::Error::other("it is closed")) } else { Ok(()) }
}

/// Whether what is written to `path` goes where standard output goes.
pub fn is_standard_output(path: impl AsRef<Path>) -> bool {
    fs::metadata(path).is_ok_and(|status| is_open(&status, io::stdout()))
}

/// Writes everything that `input` yields to an open stream. A reader that leaves early has what it wanted.
pub(crate) fn send(input: &mut impl Read, output: &mut impl Write) -> io::Result<()> {
    match io::copy(input, output).and_then(|_| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error),
        _ => Ok(()),
    }
}

/// Whether `status` is that of the file behind a standard stream.
#[cfg(unix)]
fn is_open(status: &Metadata, stream: impl std::os::fd::AsFd) -> bool {
    use std::os::unix::fs::MetadataExt;
    let open = stream.as_fd().try_clone_to_owned().and_then(|descriptor| File::from(descriptor).metadata());
    open.is_ok_and(|open| (open.dev(), open.ino()) == (status.dev(), status.ino()))
}

#[cfg(not(unix))]
fn is_open<S>(_: &Metadata, _: S) -> bool {
    false
}

/// Whether `path` is in the directory of this process's open files, as in `/dev/fd/3`.
fn is_descriptor(path: &Path) -> bool {
    let directory = |path: &Path| fs::canonicalize(path).ok();
    path.parent().and_then(directory).is_some_and(|parent| Some(parent) == directory(Path::new("/dev/fd")))
}
