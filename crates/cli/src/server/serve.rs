//! The server: it answers calls one after the other.

use std::io::{self, Read};
use std::net::Shutdown;
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use std::{env, thread};

use lightmesh::request::Warm;
use rustix::fs::Mode;
use rustix::process::umask;

use super::call::{Answer, Asked, Call, Form, Rendering, VERSION};
use super::socket::{STREAMS, Socket, receive, send};
use super::{ServerError, client, streams};
use crate::failure::{Failure, INTERRUPTED};
use crate::job::Job;
use crate::{color, interrupt, memory, output};

/// How long a client may take to say what it wants: others wait.
const PATIENCE: Duration = Duration::from_secs(5);

/// What is done with a connection.
enum Done {
    /// Nothing was asked for.
    Nothing,
    /// It was answered; what to say in the log.
    Answered(String),
    /// The server shall end.
    Stop,
}

/// Does a job with what is warm; returns the exit code.
type Work = dyn Fn(&Job, &mut Warm) -> u8;

/// Answers calls at a socket until it shall end, or there was none for so long. Jobs are done by `work`.
pub(crate) fn serve(path: &Path, idle: Duration, inherits: bool, work: &Work) -> Result<(), Failure> {
    let wrong = |reason| ServerError::Listen { path: path.to_owned(), reason };
    let socket = match inherits {
        true => Socket::inherit(path, io::stdin().as_fd().try_clone_to_owned().map_err(wrong)?),
        false => Socket::listen(path)?,
    };
    let mut again = client::server(path, idle);
    // Whatever folder a client works in.
    again.current_dir(env::current_dir().unwrap_or_else(|_| PathBuf::from("/")));
    // Those who wait stay connected.
    again.arg("--inherit").stdin(socket.listener().map_err(wrong)?);
    interrupt::begin_again(Box::new(move |reason| {
        streams::bring_back();
        // Standard error itself belongs to the last message.
        let say = |text: String| rustix::io::write(io::stderr().as_fd(), text.as_bytes());
        let _ = say(format!("{reason}; begins again\n"));
        let error = again.exec();
        let _ = say(format!("error: the server cannot begin again ({error}) and ends\n"));
    }));
    output::complain(&format!("serving at {}", path.display()));
    let mut warm = Warm::for_many();
    loop {
        let Some(stream) = socket.next(idle).map_err(wrong)? else {
            output::complain(&match socket.is_there() {
                true => format!("ends, since nothing was asked for in {} s (--idle)", idle.as_secs_f64()),
                false => "ends, since its socket was removed".to_owned(),
            });
            return Ok(());
        };
        match answer(&stream, work, &mut warm) {
            Ok(Done::Nothing) => {}
            Ok(Done::Answered(said)) => output::complain(&said),
            Ok(Done::Stop) => {
                drop(socket);
                // If nobody waits any more, it does not matter.
                let _ = reply(&stream, &Answer::Exit(0));
                return Ok(());
            }
            Err(error) => output::complain(&format!("a call could not be answered: {error}")),
        }
    }
}

fn answer(stream: &UnixStream, work: &Work, warm: &mut Warm) -> io::Result<Done> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let (line, _) = receive(stream)?;
    if line.is_empty() {
        return Ok(Done::Nothing);
    }
    let Form { version } = serde_json::from_slice(&line)?;
    if version != VERSION {
        reply(stream, &Answer::Version(VERSION.to_owned()))?;
        return Ok(Done::Answered(format!("a client of version {version} was refused")));
    }
    let Call { asked: Asked::Render(rendering), .. } = serde_json::from_slice(&line)? else { return Ok(Done::Stop) };
    reply(stream, &Answer::Begun)?;
    let (_, descriptors) = receive(stream)?;
    stream.set_read_timeout(None)?;
    let descriptors = <[OwnedFd; STREAMS]>::try_from(descriptors)
        .map_err(|_| io::Error::other("it came without standard output and error"))?;
    let (begin, what) = (Instant::now(), described(&rendering));
    let code = done(stream, *rendering, descriptors, |job| work(job, warm))?;
    // A client that has died hears nothing.
    let _ = reply(stream, &Answer::Exit(code));
    Ok(Done::Answered(format!("{what}: exit code {code} after {:.3} s", begin.elapsed().as_secs_f64())))
}

fn reply(stream: &UnixStream, answer: &Answer) -> io::Result<()> {
    send(stream, &serde_json::to_vec(answer)?, &[])
}

/// What is rendered, for the log.
fn described(rendering: &Rendering) -> String {
    let scene = rendering.scene.to_string_lossy().into_owned();
    match &rendering.request.frames {
        Some(frames) => format!("{scene}, frames {frames}"),
        None => scene,
    }
}

/// Has a job done as its client would; returns the exit code.
fn done(
    stream: &UnixStream,
    rendering: Rendering,
    descriptors: [OwnedFd; STREAMS],
    work: impl FnOnce(&Job) -> u8,
) -> io::Result<u8> {
    let own_folder = env::current_dir();
    env::set_current_dir(&rendering.folder)?;
    interrupt::clear();
    let replaced = streams::replace(descriptors)?;
    let usual = (color::when(), umask(Mode::from_raw_mode(rendering.umask)));
    color::set(rendering.color);
    let job = rendering.into_job();
    memory::limit(Some(job.order.request.memory_limit));
    let is_done = AtomicBool::new(false);
    let code = thread::scope(|scope| {
        // Ends when the client closes its side, or this one is closed.
        scope.spawn(|| {
            let mut rest = [0; 16];
            while { stream }.read(&mut rest).is_ok_and(|count| count > 0) {}
            if !is_done.load(Ordering::SeqCst) {
                interrupt::request(INTERRUPTED);
            }
        });
        let code = work(&job);
        is_done.store(true, Ordering::SeqCst);
        let _ = stream.shutdown(Shutdown::Read);
        code
    });
    memory::limit(None);
    let code = match interrupt::code() {
        Some(code) => {
            output::complain(&interrupt::ended());
            code
        }
        None => code,
    };
    color::set(usual.0);
    umask(usual.1);
    drop(replaced);
    interrupt::clear();
    // Who removes or unmounts the client's folder is not in the way of this process.
    let _ = own_folder.and_then(env::set_current_dir);
    Ok(code)
}
