//! The flags of `lightmesh serve`.

use std::path::PathBuf;

use clap::Args;

use crate::budget::Budget;

/// Render for others, with a scene that stays read and devices that stay awake
///
/// `lightmesh render … --server PATH` has the server render: the image is the same, and so is what is printed. Only the
/// same user can do so. The server keeps the scene that was rendered last with its acceleration structure, and reads it
/// again when a file of it changes. It answers one call after the other.
#[derive(Debug, Args)]
pub(crate) struct ServeArgs {
    /// Listen at this Unix socket
    #[arg(long, value_name = "PATH")]
    pub(crate) socket: PathBuf,

    /// Go on in the background, and return as soon as the server listens
    #[arg(long, conflicts_with = "stop")]
    pub(crate) background: bool,

    /// Write what a server in the background says to this file [default: nowhere]
    #[arg(long, value_name = "FILE", requires = "background")]
    pub(crate) log: Option<PathBuf>,

    /// End when nothing was asked for in this time: seconds, or a number with s, m or h
    #[arg(long, value_name = "TIME", default_value = "15m")]
    pub(crate) idle: Budget,

    /// End the server at this socket, after what it is doing; if there is none, that is all
    #[arg(long)]
    pub(crate) stop: bool,

    /// Go on listening at standard input, as the process did that became this one.
    #[arg(long, hide = true)]
    pub(crate) inherit: bool,
}
