//! Names of temporary files, and those that dead runs have left.
//!
//! A run locks its temporary files, and the system releases the locks when the run ends, however it ends. A file without a lock is
//! thus stale. Locks may be unknown to other machines that share the directory: a file from another machine, or from before a
//! restart, is stale only after a day.

use std::fs::{self, DirEntry, File, OpenOptions, Permissions};
use std::path::Path;
use std::process;
use std::sync::LazyLock;
use std::time::Duration;

use tempfile::Builder;

use crate::registry::registry;

const PREFIX: &str = ".lightmesh-";
const SUFFIX: &str = ".tmp";
/// Characters of the system's id in a name.
const ID: usize = 8;
/// A file whose lock may be unknown here is stale if it has not been written for so long: no output takes nearly as much time.
const LONG: Duration = Duration::from_secs(24 * 60 * 60);

/// The beginning of the names that this run gives: with the id of the running system, for which locks are valid, and of the process,
/// for people.
static OWN: LazyLock<String> = LazyLock::new(|| format!("{PREFIX}{}-{}-", system(), process::id()));

/// The id of the running system, new with each start: processes in containers share it.
fn system() -> String {
    let id = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    id.chars().filter(char::is_ascii_hexdigit).chain(std::iter::repeat('0')).take(ID).collect()
}

/// For a hidden file with a name that no other has.
pub(crate) fn builder(permissions: Option<&Permissions>) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(OWN.as_str()).suffix(SUFFIX);
    if let Some(permissions) = permissions {
        builder.permissions(permissions.clone());
    }
    builder
}

/// Removes the temporary files that dead runs have left in a directory, once per run.
pub(crate) fn sweep(directory: &Path) {
    let is_first = registry().swept.insert(directory.to_owned());
    if is_first {
        remove_all_stale(directory);
    }
}

/// Removes the temporary files that dead runs have left in a directory, now.
pub fn remove_all_stale(directory: &Path) {
    for entry in fs::read_dir(directory).into_iter().flatten().flatten().filter(is_temporary) {
        remove_stale(&entry.path());
    }
}

fn is_temporary(entry: &DirEntry) -> bool {
    let name = entry.file_name();
    let name = name.to_string_lossy();
    let is_file = || entry.file_type().is_ok_and(|kind| kind.is_file());
    name.starts_with(PREFIX) && name.ends_with(SUFFIX) && is_file()
}

/// Removes a file unless its run may be alive.
fn remove_stale(path: &Path) {
    let Ok(file) = OpenOptions::new().read(true).write(true).open(path) else { return };
    // The lock is held until the file is removed: a run that has just created it sees that and takes another.
    if (has_valid_lock(path) || is_old(&file)) && file.try_lock().is_ok() {
        let _ = fs::remove_file(path);
    }
}

/// Whether the run that created the file is on this system.
fn has_valid_lock(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.strip_prefix(PREFIX).is_some_and(|rest| rest.starts_with(&system()))
}

fn is_old(file: &File) -> bool {
    let written = file.metadata().and_then(|status| status.modified());
    written.is_ok_and(|time| time.elapsed().is_ok_and(|age| age > LONG))
}
