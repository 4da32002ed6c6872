//! A process that renders for others and stays warm: its devices are awake, and the scene that was rendered last is read and has its structure.
//!
//! ```text
//! render --server PATH:  Job ─▶ Call ─▶ serve --socket PATH:
//!                               ◀─ Begun ─┘
//!    standard output and error ─▶ Job ─▶ run
//!                   exit code ◀─ Exit ◀───┘
//! ```
//!
//! 1. Client and server meet at a Unix socket that only their user can open. A call is one line of JSON, and so is its answer.
//! 2. Calls are answered one after the other. When a call begins, its client hands over the descriptors of its standard output and error: before, a client
//!    that leaves would leave them open. The server works in its folder. So what it prints and writes is what the client would.
//! 3. A client that shall end closes its side, and waits until the server has ended the work. One that dies does the same.
//! 4. Devices, memory and programs such as ffmpeg are those of the server.

mod error;

#[cfg(unix)]
mod call;
#[cfg(unix)]
mod client;
#[cfg(not(unix))]
mod elsewhere;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod socket;
#[cfg(unix)]
mod streams;

#[cfg(unix)]
pub(crate) use client::{render, start, stop};
#[cfg(not(unix))]
pub(crate) use elsewhere::{render, serve, start, stop};
pub(crate) use error::ServerError;
#[cfg(unix)]
pub(crate) use serve::serve;
