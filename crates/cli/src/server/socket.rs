//! The socket at which clients and servers meet, and lines on it.

use std::fs;
use std::io::{self, ErrorKind, IoSlice, IoSliceMut, Read, Write};
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf, absolute};
use std::time::{Duration, Instant};

use lightmesh_files::directory;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::Mode;
use rustix::net::{
    RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, SendAncillaryBuffer, SendAncillaryMessage, SendFlags,
    recvmsg, sendmsg,
};
use rustix::process::umask;

use super::ServerError;
use crate::interrupt;

/// Longer names of sockets are not taken by every system (108 bytes on Linux, 104 elsewhere): what is beyond is reached from its own folder.
const LONGEST: usize = 100;
/// How often a server looks whether its socket is still there.
const LOOK: Duration = Duration::from_secs(5);
/// A line has so many bytes at most.
const MOST: usize = 16 << 20;
/// Descriptors that go with a call: standard output and error.
pub(super) const STREAMS: usize = 2;

/// A socket that somebody listens at. Its file ends with it, also if the process ends early.
pub(super) struct Socket {
    file: OwnFile,
    listener: UnixListener,
}

/// The file of a socket, which ends with it unless another one has taken its name.
#[derive(Clone)]
struct OwnFile {
    path: PathBuf,
    /// Device and number.
    identity: Option<(u64, u64)>,
}

impl OwnFile {
    fn at(path: PathBuf) -> OwnFile {
        let identity = fs::symlink_metadata(&path).ok().map(|status| (status.dev(), status.ino()));
        OwnFile { path, identity }
    }

    fn is_there(&self) -> bool {
        self.identity.is_some() && OwnFile::at(self.path.clone()).identity == self.identity
    }

    fn remove(&self) {
        if self.is_there() {
            // At worst, the next server removes it.
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl Socket {
    /// Goes on listening for a process that has become this one.
    pub(super) fn inherit(path: &Path, listener: OwnedFd) -> Socket {
        Socket::of(path.to_owned(), listener.into())
    }

    /// Listens at `path`, in place of a server that has died.
    pub(super) fn listen(path: &Path) -> Result<Socket, ServerError> {
        let path = absolute(path).unwrap_or_else(|_| path.to_owned());
        let wrong = |reason| ServerError::Listen { path: path.clone(), reason };
        if let Ok(status) = fs::symlink_metadata(&path) {
            if !status.file_type().is_socket() {
                return Err(ServerError::NoSocket { path });
            }
            if connect(&path).is_ok() {
                return Err(ServerError::Taken { path });
            }
            fs::remove_file(&path).map_err(wrong)?;
        }
        // From the beginning, nobody else can open it.
        let usual = umask(Mode::RWXG | Mode::RWXO);
        let listener = in_reach(&path, |path| UnixListener::bind(path));
        umask(usual);
        let listener = listener.map_err(wrong)?;
        Ok(Socket::of(path, listener))
    }

    fn of(path: PathBuf, listener: UnixListener) -> Socket {
        let file = OwnFile::at(path);
        let removed = file.clone();
        interrupt::at_end(Some(Box::new(move || removed.remove())));
        Socket { file, listener }
    }

    /// Where it listens, for a process that goes on.
    pub(super) fn listener(&self) -> io::Result<OwnedFd> {
        self.listener.as_fd().try_clone_to_owned()
    }

    /// Whether others still find it.
    pub(super) fn is_there(&self) -> bool {
        self.file.is_there()
    }

    /// The next client; `None` if there is none for so long, or nobody finds the socket any more.
    pub(super) fn next(&self, idle: Duration) -> io::Result<Option<UnixStream>> {
        let (begin, look) = (Instant::now(), Timespec::try_from(idle.min(LOOK)).map_err(io::Error::other)?);
        loop {
            match poll(&mut [PollFd::new(&self.listener, PollFlags::IN)], Some(&look)) {
                Ok(0) if begin.elapsed() >= idle || !self.is_there() => return Ok(None),
                Ok(0) => continue,
                Ok(_) => {}
                Err(rustix::io::Errno::INTR) => continue,
                Err(error) => return Err(error.into()),
            }
            match self.listener.accept() {
                Ok((stream, _)) => return Ok(Some(stream)),
                // The client has gone.
                Err(error) if matches!(error.kind(), ErrorKind::ConnectionAborted | ErrorKind::Interrupted) => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Socket {
    fn drop(&mut self) {
        interrupt::at_end(None);
        self.file.remove();
    }
}

/// Connects to a server.
pub(super) fn connect(path: &Path) -> io::Result<UnixStream> {
    in_reach(path, |path| UnixStream::connect(path))
}

/// Calls `use_of` with a name of `path` that is short enough. To be called while no other thread uses relative names.
fn in_reach<T>(path: &Path, use_of: impl FnOnce(&Path) -> io::Result<T>) -> io::Result<T> {
    match path.file_name() {
        Some(name) if path.as_os_str().as_bytes().len() > LONGEST => {
            let here = std::env::current_dir()?;
            std::env::set_current_dir(directory(path))?;
            let used = use_of(Path::new(name));
            std::env::set_current_dir(here)?;
            used
        }
        _ => use_of(path),
    }
}

/// Sends a line, and descriptors with it.
pub(super) fn send(mut stream: &UnixStream, line: &[u8], descriptors: &[BorrowedFd]) -> io::Result<()> {
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(STREAMS))];
    let mut control = SendAncillaryBuffer::new(&mut space);
    if !descriptors.is_empty() {
        control.push(SendAncillaryMessage::ScmRights(descriptors));
    }
    let line = [line, b"\n"].concat();
    let sent = loop {
        match sendmsg(stream, &[IoSlice::new(&line)], &mut control, SendFlags::empty()) {
            Err(rustix::io::Errno::INTR) => {}
            sent => break sent?,
        }
    };
    stream.write_all(&line[sent..])
}

/// Receives a line, and the descriptors with it. An empty one if the other side has closed.
pub(super) fn receive(mut stream: &UnixStream) -> io::Result<(Vec<u8>, Vec<OwnedFd>)> {
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(STREAMS))];
    let mut control = RecvAncillaryBuffer::new(&mut space);
    let (mut line, mut piece) = (Vec::new(), vec![0; 1 << 16]);
    let count = loop {
        match recvmsg(stream, &mut [IoSliceMut::new(&mut piece)], &mut control, RecvFlags::empty()) {
            Err(rustix::io::Errno::INTR) => {}
            received => break received?.bytes,
        }
    };
    let descriptors = control.drain().filter_map(|message| match message {
        RecvAncillaryMessage::ScmRights(descriptors) => Some(descriptors),
        _ => None,
    });
    let descriptors = descriptors.flatten().collect();
    line.extend(&piece[..count]);
    while !line.is_empty() && line.last() != Some(&b'\n') {
        match stream.read(&mut piece) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) if line.len() + count <= MOST => line.extend(&piece[..count]),
            Ok(_) => return Err(io::Error::other("it is too long")),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok((line, descriptors))
}
