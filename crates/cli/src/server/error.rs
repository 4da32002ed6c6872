//! Why a server cannot be had, or does not do what it is asked for.

use std::io;
use std::path::PathBuf;

/// Why a server cannot be had, or does not do what it is asked for.
#[derive(Debug, thiserror::Error)]
#[cfg_attr(not(unix), allow(dead_code, reason = "there are no servers"))]
pub(crate) enum ServerError {
    /// Nobody listens.
    #[error("no server answers at {} ({reason}); start one with `lightmesh serve --socket {}`", path.display(), path.display())]
    None { path: PathBuf, reason: io::Error },
    /// It has ended before it answered.
    #[error("the server at {} has not finished this; what it said is above, or in its log (lightmesh serve --log)", path.display())]
    Ended { path: PathBuf },
    /// The connection to it has failed.
    #[error("the server at {} cannot be talked to ({reason}); start another one", path.display())]
    Connection { path: PathBuf, reason: io::Error },
    /// It is another version.
    #[error("the server at {} is version {server} and this is version {client}; start it again", path.display())]
    Version { path: PathBuf, server: String, client: String },
    /// What only the process itself can read.
    #[error(
        "a scene on standard input is read once, and does not stay on a server; name a file, or leave out --server"
    )]
    StandardInput,
    /// What only the process itself can write.
    #[error("{} is open in this process alone, and a server cannot write to it; name a file, or leave out --server", path.display())]
    Descriptor { path: PathBuf },
    /// Another server listens.
    #[error("another server answers at {}; end it (--stop), or choose another socket", path.display())]
    Taken { path: PathBuf },
    /// There is something that is no socket.
    #[error("{} exists and is no socket; choose another name", path.display())]
    NoSocket { path: PathBuf },
    /// The socket cannot be made.
    #[error("cannot listen at {} ({reason}); choose a folder of a file system with sockets, such as that of temporary files", path.display())]
    Listen { path: PathBuf, reason: io::Error },
    /// The server in the background has not begun to listen.
    #[error("the server in the background has ended at once ({status}){log}")]
    Background { status: String, log: String },
    /// It cannot be started.
    #[error("cannot start a server in the background ({0}); start it without --background")]
    Start(io::Error),
    /// This system has no sockets of this kind.
    #[error("servers need a Unix system; render without --server (`lightmesh farm --no-server` makes jobs that do)")]
    #[cfg_attr(unix, allow(dead_code, reason = "there are servers"))]
    System,
}

impl ServerError {
    /// Whether the fault is the command line's, not the server's.
    pub(crate) fn is_of_usage(&self) -> bool {
        matches!(
            self,
            ServerError::StandardInput
                | ServerError::Descriptor { .. }
                | ServerError::Taken { .. }
                | ServerError::NoSocket { .. }
                | ServerError::System
        )
    }
}
