//! An output while it is being written, and when it is ready.

use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{SpooledTempFile, spooled_tempfile};

use crate::stream::Stream;
use crate::target::{Target, TargetError};
use crate::temporary::Temporary;

/// What is written through is held in memory up to so many bytes, and then in a file without a name.
const SPOOLED: usize = 64 << 20;
/// What messages call standard output.
const STANDARD_OUTPUT: &str = "standard output";
/// Data become durable in steps of so many bytes. A process cannot end while the system writes, so none may take long.
const SYNCED: u64 = 16 << 20;

/// Why a whole file cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// It cannot be created.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing its data failed, most often because the disk is full.
    #[error("cannot write {}: {reason}; nothing was written; check the free disk space", path.display())]
    Data {
        /// The file.
        path: PathBuf,
        /// The system's error.
        reason: io::Error,
    },
}

/// An output that is being written. If dropped, it has never been.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    /// Next to `target`, and how many bytes may not be durable yet.
    File { file: Temporary, target: PathBuf, pending: u64 },
    /// Collected, because it may be needed again while it is being written, and so that no part of it is sent alone.
    Stream { bytes: SpooledTempFile, stream: Stream },
}

impl Output {
    /// An empty output for `path`. A file appears only when it is published, with the permissions of the one it replaces or of an
    /// ordinary new one.
    ///
    /// # Errors
    /// [`TargetError`] if it cannot be written.
    pub fn to(path: impl AsRef<Path>) -> Result<Output, TargetError> {
        let path = path.as_ref();
        let sink = match Target::of(path)? {
            Target::File(target) => {
                Sink::File { file: Temporary::new(path, &target)?, target: target.path, pending: 0 }
            }
            Target::Stream(stream) => Sink::Stream { bytes: spooled_tempfile(SPOOLED), stream },
        };
        Ok(Output { path: path.to_owned(), sink })
    }

    /// An empty output for standard output, which is written when it is published.
    pub fn to_stdout() -> Output {
        let sink = Sink::Stream { bytes: spooled_tempfile(SPOOLED), stream: Stream::Stdout };
        Output { path: PathBuf::from(STANDARD_OUTPUT), sink }
    }

    /// The path that was given, or what messages call standard output.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The temporary file, for another program that writes it instead of this one, in place; `None` if this is no file.
    pub fn temporary_path(&self) -> Option<&Path> {
        match &self.sink {
            Sink::File { file, .. } => Some(file.path()),
            Sink::Stream { .. } => None,
        }
    }

    /// Fills an output that is ready then.
    ///
    /// # Errors
    /// [`WriteError`], which names the file.
    pub fn filled(mut self, bytes: &[u8]) -> Result<Ready, WriteError> {
        let path = self.path.clone();
        let written = self.write_all(bytes).and_then(|()| self.ready());
        written.map_err(|reason| WriteError::Data { path, reason })
    }

    /// Makes the data durable. A file is not yet visible under its name.
    ///
    /// # Errors
    /// The system's error, such as that of a full disk.
    pub fn ready(mut self) -> io::Result<Ready> {
        self.flush()?;
        match &mut self.sink {
            Sink::File { file, .. } => file.file.sync_all()?,
            Sink::Stream { bytes, .. } => bytes.rewind()?,
        }
        Ok(Ready(self))
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::File { file, pending, .. } => {
                let count = file.file.write(bytes)?;
                *pending += count as u64;
                if *pending >= SYNCED {
                    *pending = 0;
                    file.file.sync_data()?;
                }
                Ok(count)
            }
            Sink::Stream { bytes: collected, .. } => collected.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::File { file, .. } => file.file.flush(),
            Sink::Stream { bytes, .. } => bytes.flush(),
        }
    }
}

impl Seek for Output {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        match &mut self.sink {
            Sink::File { file, .. } => file.file.seek(position),
            Sink::Stream { bytes, .. } => bytes.seek(position),
        }
    }
}

/// An output that is complete and durable, but does not exist before it is [published](crate::publish()). If dropped, it has never been.
#[derive(Debug)]
pub struct Ready(Output);

/// What publishing does with an output.
pub(crate) enum Step {
    Rename(Temporary, PathBuf),
    Send(SpooledTempFile, Stream),
}

impl Ready {
    /// A complete file with this content.
    ///
    /// # Errors
    /// [`WriteError`], which names the file.
    pub fn with(path: impl AsRef<Path>, bytes: &[u8]) -> Result<Ready, WriteError> {
        Output::to(path)?.filled(bytes)
    }

    /// The path that was given.
    pub fn path(&self) -> &Path {
        &self.0.path
    }

    pub(crate) fn step(self) -> (PathBuf, Step) {
        let Output { path, sink } = self.0;
        match sink {
            Sink::File { file, target, .. } => (path, Step::Rename(file, target)),
            Sink::Stream { bytes, stream } => (path, Step::Send(bytes, stream)),
        }
    }
}
