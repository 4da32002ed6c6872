//! Standard output and error of a client, in place of the server's own.

use std::io::{self, Write};
use std::os::fd::{AsFd, OwnedFd};
use std::sync::{Mutex, PoisonError};

use rustix::stdio::{dup2_stderr, dup2_stdout};

use super::socket::STREAMS;

/// The server's own standard output and error, while a client's are in their place.
static OWN: Mutex<Option<[OwnedFd; STREAMS]>> = Mutex::new(None);

/// A client's streams are in place of the server's own until this ends.
pub(super) struct Replaced;

/// From now on, what is printed goes where the client's does.
pub(super) fn replace([output, error]: [OwnedFd; STREAMS]) -> io::Result<Replaced> {
    let own = [io::stdout().as_fd().try_clone_to_owned()?, io::stderr().as_fd().try_clone_to_owned()?];
    *OWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(own);
    let replaced = Replaced;
    dup2_stdout(&output)?;
    dup2_stderr(&error)?;
    Ok(replaced)
}

/// Brings the server's own streams back.
pub(super) fn bring_back() {
    if let Some([output, error]) = OWN.lock().unwrap_or_else(PoisonError::into_inner).take() {
        let _ = dup2_stdout(output);
        let _ = dup2_stderr(error);
    }
}

impl Drop for Replaced {
    fn drop(&mut self) {
        // A client that reads no more has what it wanted.
        let _ = io::stdout().flush();
        bring_back();
    }
}
