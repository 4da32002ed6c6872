//! What clients do: they have a server render, or end, or begin in the background.

use std::env;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::net::Shutdown;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use lightmesh::request::files::{OutputError, is_standard};
use lightmesh_files::check_output;

use super::ServerError;
use super::call::{Answer, Asked, Call, Rendering, VERSION};
use super::socket::{connect, send};
use crate::failure::Failure;
use crate::job::Job;
use crate::{color, interrupt};

/// How long a server may take to begin again.
const PATIENCE: Duration = Duration::from_secs(3);
/// How often a client looks whether it shall end.
const LOOK: Duration = Duration::from_millis(50);
/// The last bytes of a log, which are quoted if a server does not begin.
const QUOTED: usize = 500;

/// Has the server at `path` do a job; returns the exit code.
pub(crate) fn render(path: &Path, job: &Job) -> Result<u8, Failure> {
    if is_standard(&job.order.scene) {
        return Err(ServerError::StandardInput.into());
    }
    // The server would write to what stands for a closed one.
    if job.order.files.paths().any(is_standard) {
        check_output().map_err(OutputError::Stdout)?;
    }
    let stream = patiently(path).map_err(|reason| ServerError::None { path: path.to_owned(), reason })?;
    let folder = env::current_dir().map_err(|reason| ServerError::Connection { path: path.to_owned(), reason })?;
    let asked = Asked::Render(Box::new(Rendering::new(job, folder, color::when())));
    let (code, requested) = interrupt::elsewhere(|| -> Result<_, Failure> {
        let code = call(path, &stream, asked)?;
        Ok((code, interrupt::code()))
    })?;
    // The server has said what is written.
    requested.map_or(Ok(code), |code| interrupt::exit(code))
}

/// Connects to a server. One that has run out of memory begins again.
fn patiently(path: &Path) -> io::Result<UnixStream> {
    let begin = Instant::now();
    loop {
        match connect(path) {
            Err(error) if error.kind() == ErrorKind::ConnectionRefused && begin.elapsed() < PATIENCE => {
                thread::sleep(LOOK)
            }
            connected => return connected,
        }
    }
}

/// Has the server at `path` end, and waits until it has.
pub(crate) fn stop(path: &Path) -> Result<(), Failure> {
    let stream = connect(path).map_err(|reason| ServerError::None { path: path.to_owned(), reason })?;
    call(path, &stream, Asked::Stop)?;
    Ok(())
}

/// Makes a call, and waits for the answer.
fn call(path: &Path, stream: &UnixStream, asked: Asked) -> Result<u8, ServerError> {
    let wrong = |reason| ServerError::Connection { path: path.to_owned(), reason };
    let line = serde_json::to_vec(&Call::new(asked)).map_err(|error| wrong(io::Error::other(error)))?;
    send(stream, &line, &[io::stdout().as_fd(), io::stderr().as_fd()]).map_err(wrong)?;
    let answer = wait(stream).map_err(wrong)?;
    match serde_json::from_slice(&answer) {
        Ok(Answer::Exit(code)) => Ok(code),
        Ok(Answer::Version(server)) => {
            Err(ServerError::Version { path: path.to_owned(), server, client: VERSION.to_owned() })
        }
        Err(_) => Err(ServerError::Ended { path: path.to_owned() }),
    }
}

/// Waits for a line, and closes this side if the program shall end. What is received is empty if the server has ended.
fn wait(mut stream: &UnixStream) -> io::Result<Vec<u8>> {
    stream.set_read_timeout(Some(LOOK))?;
    let (mut answer, mut is_closed) = (Vec::new(), false);
    let mut piece = [0; 256];
    loop {
        match stream.read(&mut piece) {
            Ok(0) => return Ok(answer),
            Ok(count) => answer.extend(&piece[..count]),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if error.kind() == ErrorKind::ConnectionReset => return Ok(Vec::new()),
            Err(error) => return Err(error),
        }
        if answer.last() == Some(&b'\n') {
            return Ok(answer);
        }
        if interrupt::requested() && !is_closed {
            is_closed = true;
            stream.shutdown(Shutdown::Write)?;
        }
    }
}

/// Starts a server, and returns when it listens at `path`. What it prints goes to the `log`.
pub(crate) fn start(path: &Path, idle: Duration, log: Option<&Path>) -> Result<(), Failure> {
    let open = |log: &Path| File::create(log).map_err(ServerError::Start);
    let streams = match log.map(open).transpose()? {
        Some(log) => [log.try_clone().map_err(ServerError::Start)?.into(), log.into()],
        None => [Stdio::null(), Stdio::null()],
    };
    let [output, error] = streams;
    let mut server =
        server(path, idle).stdin(Stdio::null()).stdout(output).stderr(error).spawn().map_err(ServerError::Start)?;
    Ok(wait_for(&mut server, path, log)?)
}

/// The command of a server. The program is called as this one was: it may be a script of another one.
pub(super) fn server(path: &Path, idle: Duration) -> Command {
    let mut arguments = env::args_os();
    let mut command = Command::new(arguments.next().unwrap_or_else(|| "lightmesh".into()));
    command.args(arguments.take_while(|argument| argument != "serve"));
    command.arg("serve").arg("--socket").arg(path).arg("--idle").arg(idle.as_secs_f64().to_string());
    command
}

/// Waits until a server listens, or has ended.
fn wait_for(server: &mut Child, path: &Path, log: Option<&Path>) -> Result<(), ServerError> {
    while connect(path).is_err() {
        if let Some(status) = server.try_wait().map_err(ServerError::Start)? {
            let said = log.and_then(|log| fs::read(log).ok()).unwrap_or_default();
            let said = String::from_utf8_lossy(&said[said.len().saturating_sub(QUOTED)..]).trim().to_owned();
            let log = match said.as_str() {
                "" => "; start it without --background to see why".to_owned(),
                said => format!(": {said}"),
            };
            return Err(ServerError::Background { status: status.to_string(), log });
        }
        thread::sleep(LOOK);
    }
    Ok(())
}
