//! Temporary files, which are registered until they are renamed or removed.

use std::fs::{self, File, Permissions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::registry::{Registry, registry};
use crate::stale;
use crate::target::{FileTarget, TargetError, directory};

/// Bytes written to see whether a disk is full: the usual size of a block.
const PROBE: [u8; 4096] = [0; 4096];
/// Attempts to create a file. Each fails only if another run looks at the file in the instant before it is locked.
const ATTEMPTS: usize = 16;

/// A temporary file next to its target, removed when dropped unless it was renamed.
#[derive(Debug)]
pub(crate) struct Temporary {
    /// Locked, to show other runs that this one lives. Closed before the file is removed, as some systems require.
    pub(crate) file: File,
    name: Registered,
}

/// The path of a temporary file, which the registry has until it is renamed or removed.
#[derive(Debug)]
struct Registered(PathBuf);

impl Temporary {
    /// An empty file that looks like the one it will replace, or like a new one. `path` is the target as the user calls it.
    pub(crate) fn new(path: &Path, target: &FileTarget) -> Result<Temporary, TargetError> {
        let directory = directory(&target.path);
        let create = || {
            stale::sweep(directory);
            let temporary = Temporary::locked(directory, permissions(target).as_ref())?;
            if let Some(existing) = &target.existing {
                resemble(&temporary.file, existing)?;
            }
            Ok(temporary)
        };
        create().map_err(|reason| unwritable(path, directory, reason))
    }

    fn locked(directory: &Path, permissions: Option<&Permissions>) -> io::Result<Temporary> {
        for _ in 0..ATTEMPTS {
            let temporary = Temporary::unlocked(directory, permissions)?;
            let is_ours = match temporary.file.try_lock() {
                Ok(()) => fs::symlink_metadata(&temporary.name.0).is_ok(),
                Err(TryLockError::WouldBlock) => false,
                // This file system has no locks, so that no other run will take this one for dead.
                Err(TryLockError::Error(_)) => true,
            };
            if is_ours {
                return Ok(temporary);
            }
        }
        Err(io::Error::other("another run removes new files"))
    }

    fn unlocked(directory: &Path, permissions: Option<&Permissions>) -> io::Result<Temporary> {
        let mut registry = registry();
        let (file, path) = stale::builder(permissions).tempfile_in(directory)?.keep()?;
        registry.temporaries.insert(path.clone());
        Ok(Temporary { file, name: Registered(path) })
    }

    /// Where it is until it is renamed.
    pub(crate) fn path(&self) -> &Path {
        &self.name.0
    }

    /// Writes a block to see whether the disk is full.
    pub(crate) fn check_space(mut self, path: &Path, target: &FileTarget) -> Result<(), TargetError> {
        self.file.write_all(&PROBE).map_err(|reason| unwritable(path, directory(&target.path), reason))
    }

    /// Renames the file over its target, while the registry is held.
    pub(crate) fn rename(&self, target: &Path, registry: &mut Registry) -> io::Result<()> {
        fs::rename(&self.name.0, target)?;
        registry.temporaries.remove(&self.name.0);
        Ok(())
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        let mut registry = registry();
        if registry.temporaries.remove(&self.0) {
            // If it cannot be removed, the next run will.
            let _ = fs::remove_file(&self.0);
        }
    }
}

fn unwritable(path: &Path, directory: &Path, reason: io::Error) -> TargetError {
    TargetError::Unwritable { path: path.to_owned(), directory: directory.to_owned(), reason }
}

/// Those of the existing file, so that a private one is never readable by others; for a new file, what the umask leaves.
#[cfg(unix)]
fn permissions(target: &FileTarget) -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    let new = || Permissions::from_mode(0o666);
    Some(target.existing.as_ref().map_or_else(new, fs::Metadata::permissions))
}

/// Gives `file` the owner and permissions of the existing one.
#[cfg(unix)]
fn resemble(file: &File, existing: &fs::Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, fchown};
    let new = file.metadata()?;
    if (new.uid(), new.gid()) != (existing.uid(), existing.gid()) {
        // Only the superuser may give files away. Others replace the file by one of their own.
        let _ = fchown(file, Some(existing.uid()), Some(existing.gid()));
    }
    file.set_permissions(existing.permissions())
}

#[cfg(not(unix))]
fn permissions(_: &FileTarget) -> Option<Permissions> {
    None
}

#[cfg(not(unix))]
fn resemble(_: &File, _: &fs::Metadata) -> io::Result<()> {
    Ok(())
}
