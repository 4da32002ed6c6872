//! What clients do: they have a server render, or end, or begin in the background.

use std::env;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::net::Shutdown;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf, absolute};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use lightmesh::request::files::{OutputError, is_standard};
use lightmesh_files::check_output;
use rustix::fs::Mode;
use rustix::process::umask;

use super::ServerError;
use super::call::{Answer, Asked, Call, Rendering, VERSION};
use super::socket::{connect, send};
use crate::failure::Failure;
use crate::job::Job;
use crate::{color, interrupt, output};

/// How long a server may take to begin again.
const PATIENCE: Duration = Duration::from_secs(3);
/// How often a client looks whether it shall end.
const LOOK: Duration = Duration::from_millis(50);
/// The last bytes of a log, which are quoted if a server does not begin.
const QUOTED: usize = 500;

/// Has the server at `path` do a job; returns the exit code.
pub(crate) fn render(path: &Path, job: &Job) -> Result<u8, Failure> {
    let order = &job.order;
    // What is wrong with the settings themselves is said here, in the words of flags.
    order.request.check()?;
    if is_standard(&order.scene) || is_own(&order.scene) {
        return Err(ServerError::StandardInput.into());
    }
    if let Some(path) = order.files.paths().find(|path| is_own(path)) {
        return Err(ServerError::Descriptor { path: path.to_owned() }.into());
    }
    // The server would write to what stands for a closed one.
    if order.files.paths().any(is_standard) {
        check_output().map_err(OutputError::Stdout)?;
    }
    let stream = patiently(path).map_err(|reason| ServerError::None { path: path.to_owned(), reason })?;
    let folder = env::current_dir().map_err(|reason| ServerError::Connection { path: path.to_owned(), reason })?;
    let umask = own_umask();
    let asked = Asked::Render(Box::new(Rendering::new(job, folder, color::when(), umask)));
    let (code, requested) = interrupt::elsewhere(|| -> Result<_, Failure> {
        let code = call(path, &stream, asked)?;
        Ok((code, interrupt::code()))
    })?;
    // The server has said what is written.
    requested.map_or(Ok(code), |code| interrupt::exit(code))
}

/// Whether a path is that of an open file of this process, such as the result of a command in a shell: the server has other ones.
fn is_own(path: &Path) -> bool {
    let folders = ["/dev/fd", "/proc/self/fd"];
    path == Path::new("/dev/stdin") || folders.iter().any(|folder| path.starts_with(folder))
}

/// What new files of this process may not be for others: it can only be read by being set.
fn own_umask() -> u32 {
    let own = umask(Mode::empty());
    umask(own);
    own.as_raw_mode()
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
    match connect(path) {
        Ok(stream) => Ok(call(path, &stream, Asked::Stop).map(|_| ())?),
        // Whoever ends what has begun need not know whether it lives.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::ConnectionRefused) => {
            output::complain(&format!("no server answers at {}: there is none to end", path.display()));
            Ok(())
        }
        Err(reason) => Err(ServerError::None { path: path.to_owned(), reason }.into()),
    }
}

/// Makes a call, and waits for the answer.
fn call(path: &Path, stream: &UnixStream, asked: Asked) -> Result<u8, ServerError> {
    let wrong = |reason| ServerError::Connection { path: path.to_owned(), reason };
    let line = serde_json::to_vec(&Call::new(asked)).map_err(|error| wrong(io::Error::other(error)))?;
    send(stream, &line, &[]).map_err(wrong)?;
    let (mut answers, mut has_begun) = (Answers { stream, rest: Vec::new(), is_closed: false }, false);
    loop {
        let answer = answers.next(has_begun).map_err(wrong)?;
        match serde_json::from_slice(&answer) {
            Ok(Answer::Begun) => {
                has_begun = true;
                send(stream, b"", &[io::stdout().as_fd(), io::stderr().as_fd()]).map_err(wrong)?;
            }
            Ok(Answer::Exit(code)) => return Ok(code),
            Ok(Answer::Version(server)) => {
                return Err(ServerError::Version { path: path.to_owned(), server, client: VERSION.to_owned() });
            }
            Err(_) => return Err(ServerError::Ended { path: path.to_owned() }),
        }
    }
}

/// What a server says, line by line.
struct Answers<'a> {
    stream: &'a UnixStream,
    rest: Vec<u8>,
    /// Whether this side is closed, which ends the work.
    is_closed: bool,
}

impl Answers<'_> {
    /// Waits for the next line; it is empty if the server has ended. If the program shall end, it does so at once before the work has begun, and has the
    /// server end it afterwards.
    fn next(&mut self, has_begun: bool) -> io::Result<Vec<u8>> {
        self.stream.set_read_timeout(Some(LOOK))?;
        let mut piece = [0; 256];
        loop {
            if let Some(end) = self.rest.iter().position(|&byte| byte == b'\n') {
                return Ok(self.rest.drain(..=end).collect());
            }
            match self.stream.read(&mut piece) {
                Ok(0) => return Ok(Vec::new()),
                Ok(count) => self.rest.extend(&piece[..count]),
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::ConnectionReset => return Ok(Vec::new()),
                Err(error) => return Err(error),
            }
            if interrupt::requested() && !self.is_closed {
                if !has_begun {
                    interrupt::leave_if_requested();
                }
                self.is_closed = true;
                self.stream.shutdown(Shutdown::Write)?;
            }
        }
    }
}

/// Starts a server, and returns when it listens at `path`. What it prints goes to the `log`.
pub(crate) fn start(path: &Path, idle: Duration, log: Option<&Path>) -> Result<(), Failure> {
    if connect(path).is_ok() {
        return Err(ServerError::Taken { path: path.to_owned() }.into());
    }
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

/// The command of a server.
pub(super) fn server(path: &Path, idle: Duration) -> Command {
    let mut arguments = env::args_os();
    let called = arguments.next().unwrap_or_else(|| "lightmesh".into());
    let mut socket = OsString::from("--socket=");
    socket.push(anywhere(path));
    let mut command = Command::new(program(Path::new(&called)));
    command.arg0(called).args(arguments.take_while(|argument| argument != "serve"));
    command.arg("serve").arg(socket).arg("--idle").arg(idle.as_secs_f64().to_string());
    command
}

/// This program, which was `called` so. A script's program is its interpreter as it was called: by this name it knows its packages.
fn program(called: &Path) -> PathBuf {
    let own = env::current_exe().unwrap_or_else(|_| called.to_owned());
    let is_interpreter = own.file_name().is_some_and(|name| name.to_string_lossy().starts_with("py"));
    match is_interpreter {
        // One without a folder is looked for in those of `PATH`.
        true if called.components().count() > 1 => anywhere(called),
        true => called.to_owned(),
        // The file itself, also if it was moved since.
        false if cfg!(target_os = "linux") => PathBuf::from("/proc/self/exe"),
        false => own,
    }
}

/// A path that holds in any folder.
fn anywhere(path: &Path) -> PathBuf {
    absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Whether a connection leads to a process, as far as the system tells. Another server may have been quicker.
fn leads_to(stream: &UnixStream, server: &Child) -> bool {
    #[cfg(target_os = "linux")]
    {
        let process = rustix::net::sockopt::socket_peercred(stream).map(|peer| peer.pid.as_raw_nonzero().get());
        process.is_ok_and(|process| process.unsigned_abs() == server.id())
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = (stream, server);
        true
    }
}

/// Waits until a server listens, or has ended.
fn wait_for(server: &mut Child, path: &Path, log: Option<&Path>) -> Result<(), ServerError> {
    while !connect(path).is_ok_and(|stream| leads_to(&stream, server)) {
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
