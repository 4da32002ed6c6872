//! The outputs of a run appear together.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use crate::output::{Output, Ready, Step};
use crate::registry::registry;
use crate::standby;
use crate::stream::{self, Stream};
use crate::target::directory;
use crate::temporary::Temporary;

/// Why an output did not appear.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {reason}; {}", path.display(), self.state())]
#[non_exhaustive]
pub struct PublishError {
    /// The output.
    pub path: PathBuf,
    /// The system's message.
    pub reason: io::Error,
    /// Outputs of the same run that are already there.
    pub written: Vec<PathBuf>,
}

impl PublishError {
    /// What is written, and what to do.
    fn state(&self) -> String {
        let names: Vec<String> = self.written.iter().map(|path| path.display().to_string()).collect();
        match &names[..] {
            [] => "nothing was written; check its disk and its permissions".to_owned(),
            names => format!("of the outputs, only these were written: {}", names.join(", ")),
        }
    }
}

/// Lets outputs appear, in their order, but streams first: files are renamed only when nothing else can fail any more. Directories
/// are synced afterwards, as far as file systems support that.
///
/// # Errors
/// [`PublishError`] for the first output that fails, or has the same target as another; it says which are already there. The
/// others are removed.
pub fn publish(outputs: impl IntoIterator<Item = Ready>) -> Result<(), PublishError> {
    let mut written = Vec::new();
    let (mut files, mut targets) = (Vec::new(), BTreeSet::new());
    for output in outputs {
        match output.step() {
            (path, Step::Rename(_, target)) if !targets.insert(target.clone()) => {
                let reason =
                    io::Error::new(io::ErrorKind::AlreadyExists, "another output of this run is the same file");
                return Err(PublishError { path, reason, written });
            }
            (path, Step::Rename(file, target)) => files.push((path, file, target)),
            (path, Step::Send(mut bytes, stream)) => match send(&path, &mut bytes, &stream) {
                Ok(()) => written.push(path),
                Err(reason) => return Err(PublishError { path, reason, written }),
            },
        }
    }
    rename(&files, written)?;
    let directories: BTreeSet<&Path> = targets.iter().map(|target| directory(target)).collect();
    directories.into_iter().for_each(sync_directory);
    Ok(())
}

impl Output {
    /// Publishes this output alone.
    ///
    /// # Errors
    /// The system's error; a file at the target is then unchanged.
    pub fn commit(self) -> io::Result<()> {
        publish([self.ready()?]).map_err(|error| error.reason)
    }
}

/// Lets a file appear that a program keeps for itself, such as a record of its outputs: [`abort`](crate::abort) does not name it.
///
/// # Errors
/// [`PublishError`]; also if the target is no regular file.
pub fn publish_record(record: Ready) -> Result<(), PublishError> {
    let (path, step) = record.step();
    let failed = |reason| PublishError { path, reason, written: Vec::new() };
    let Step::Rename(file, target) = step else {
        return Err(failed(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file")));
    };
    let renamed = file.rename(&target, &mut registry());
    renamed.map_err(failed)?;
    sync_directory(directory(&target));
    Ok(())
}

fn send(path: &Path, bytes: &mut impl io::Read, stream: &Stream) -> io::Result<()> {
    let mut output = stream.open()?;
    registry().begins(path.to_owned());
    stream::send(bytes, &mut output)?;
    registry().wrote(path.to_owned());
    Ok(())
}

/// Renames all files while holding the registry, so that a program that ends early does so before the first or after the last.
fn rename(files: &[(PathBuf, Temporary, PathBuf)], mut written: Vec<PathBuf>) -> Result<(), PublishError> {
    // Dropped after the registry, which dropping it takes.
    let _superseded;
    let mut registry = registry();
    _superseded = standby::exchange(None, &mut registry);
    for (path, file, target) in files {
        match file.rename(target, &mut registry) {
            Ok(()) => {
                registry.wrote(path.clone());
                written.push(path.clone());
            }
            Err(reason) => return Err(PublishError { path: path.clone(), reason, written }),
        }
    }
    Ok(())
}

/// The name of a file is durable only when its directory is. If that fails, the file is still complete under one name or the other.
fn sync_directory(path: &Path) {
    #[cfg(unix)]
    let _ = std::fs::File::open(path).and_then(|directory| directory.sync_all());
}
