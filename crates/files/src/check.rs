//! Checks before any work is done for an output.

use std::fs;
use std::path::Path;

use crate::target::{FileTarget, Target, TargetError, check_directory, directory};
use crate::temporary::Temporary;

/// Checks that an output could be written to `path`, without touching what is there: that a file can be created next to it, and
/// that the disk is not full.
///
/// # Errors
/// The [`TargetError`] that [`Output::to`](crate::Output::to) would return.
pub fn check_writable(path: impl AsRef<Path>) -> Result<(), TargetError> {
    let path = path.as_ref();
    match Target::of(path)? {
        Target::File(file) => Temporary::new(path, &file)?.check_space(path, &file),
        Target::Stream(_) => Ok(()),
    }
}

/// Checks that files could be written to `folder`, which may be missing together with its parents. None is created.
///
/// # Errors
/// [`TargetError`]
pub fn check_folder(folder: impl AsRef<Path>) -> Result<(), TargetError> {
    let folder = folder.as_ref();
    let mut there = folder;
    while fs::symlink_metadata(there).is_err() && there != directory(there) {
        there = directory(there);
    }
    check_directory(folder, there)?;
    let file = FileTarget { path: there.join("file"), existing: None };
    Temporary::new(folder, &file)?.check_space(folder, &file)
}
