//! The border between the program and files: output files that are written completely or not at all, input files that are
//! [read](read_inside) only where they may lie, and text of either made safe to show.
//!
//! 1. An [`Output`] for a file is a temporary file next to its target; links are followed. What is no regular file (a pipe,
//!    `/dev/stdout`, a device) is never replaced: it is written through.
//! 2. [`Output::ready`] makes the data durable; the result is [`Ready`] to appear.
//! 3. [`publish`] renames the outputs of a run over their targets, all at once. An existing file keeps its permissions.
//!
//! An interrupted program or a full disk thus leaves the previous file intact. Temporary files are removed when dropped, by
//! [`abort`] if the program ends early, and by the next run in the same directory if it was killed: a lock on each of them tells
//! those of living runs.
//!
//! ```
//! use std::io::Write;
//!
//! use lightmesh_files::Output;
//!
//! let folder = tempfile::tempdir()?;
//! let mut file = Output::to(folder.path().join("notes.txt"))?;
//! file.write_all(b"all of it")?;
//! file.commit()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod check;
mod cleanup;
mod output;
mod per_process;
mod publish;
mod read;
mod registry;
mod stale;
mod standby;
mod stream;
mod target;
mod temporary;
mod visible;

#[cfg(test)]
mod tests;

pub use check::{check_folder, check_writable};
pub use cleanup::{Aborted, abort, publish_on_abort, record_written, take_written};
pub use output::{Output, Ready, WriteError};
pub use per_process::PerProcess;
pub use publish::{PublishError, publish, publish_record};
pub use read::{Portion, ReadError, read, read_inside, read_stream};
pub use stale::remove_all_stale;
pub use stream::{check_output, is_standard_output, look_at_output};
pub use target::{Identity, TargetError, directory, identity};
pub use visible::{visible, visible_json, visible_lines};
