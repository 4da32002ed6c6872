//! Output to standard output, standard error, and files that are written completely or not at all.

use std::borrow::Cow;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use std::path::{Path, PathBuf};

pub(crate) use lightmesh::request::files::json;
pub(crate) use lightmesh::request::files::{OutputError, Outputs, publish, ready};
use lightmesh_files::{check_output, visible, visible_json, visible_lines};
use serde::Serialize;

use crate::color;

/// How long the last line may wait for someone to read standard error. On a busy machine, a thread alone may wait for tenths of a second
/// until it runs.
const PATIENCE: Duration = Duration::from_secs(1);
/// Removes a progress bar from the current line of a terminal.
const CLEAR_LINE: &str = "\r\x1b[2K";

/// Prints lines to standard output. Whatever names in them contain, it does not control the terminal; names that must not begin new lines
/// are made [visible] before.
pub(crate) fn print(text: &str) -> Result<(), OutputError> {
    write_stdout(&visible_lines(text))
}

/// Prints indented JSON to standard output.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), OutputError> {
    write_stdout(&visible_json(&json(value)))
}

/// Prints paths to standard output, a line each: on a terminal made visible, else to the byte, for other programs.
pub(crate) fn print_paths(paths: &[PathBuf]) -> Result<(), OutputError> {
    if io::stdout().is_terminal() {
        return print(&paths.iter().map(|path| format!("{}\n", visible(&path.to_string_lossy()))).collect::<String>());
    }
    let line = |path: &PathBuf| [path.as_os_str().as_encoded_bytes(), b"\n"].concat();
    write_bytes(&paths.iter().flat_map(line).collect::<Vec<u8>>())
}

/// A closed pipe is not an error.
fn write_stdout(text: &str) -> Result<(), OutputError> {
    write_bytes(text.as_bytes())
}

fn write_bytes(bytes: &[u8]) -> Result<(), OutputError> {
    check_output().map_err(OutputError::Stdout)?;
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(OutputError::Stdout(error)),
        _ => Ok(()),
    }
}

/// Prints a line to standard error: names in it neither control the terminal nor begin new lines. If that fails, there is nowhere left
/// to report it.
pub(crate) fn complain(text: &str) {
    let mut stderr = io::stderr().lock();
    let _ = writeln!(stderr, "{}", color::painted(visible(text), &stderr));
}

/// Prints one line of JSON to standard error.
pub(crate) fn complain_json(value: &impl Serialize) {
    // Strings and finite numbers can always be represented in JSON.
    if let Ok(line) = serde_json::to_string(value) {
        let _ = writeln!(io::stderr().lock(), "{}", visible_json(&line));
    }
}

/// Prints the last line to standard error, and lets no thread print after it. Does not wait long if nobody reads.
pub(crate) fn conclude(text: &str) {
    let clear = if io::stderr().is_terminal() { CLEAR_LINE } else { "" };
    let line = format!("{clear}{}\n", color::painted(visible(text), &io::stderr()));
    let (sender, printed) = mpsc::channel();
    let print = move || {
        let mut stderr = io::stderr().lock();
        let _ = stderr.write_all(line.as_bytes());
        let _ = sender.send(());
        // Keeps the lock until the process exits.
        loop {
            thread::park();
        }
    };
    if thread::Builder::new().spawn(print).is_ok() {
        let _ = printed.recv_timeout(PATIENCE);
    }
}

/// Checks that a file could be written to `path`, without touching an existing one.
pub(crate) fn check_writable(path: &Path) -> Result<(), OutputError> {
    Ok(lightmesh_files::check_writable(path)?)
}

/// Whether what the parser of the command line says is shown in colours.
pub(crate) fn is_usage_colored(message: &clap::Error) -> bool {
    let is_wanted = if message.use_stderr() { color::on(&io::stderr()) } else { color::on(&io::stdout()) };
    is_wanted && quotes_are_visible()
}

/// Prints what the parser says: help, or an error that quotes arguments. Without colours, nothing in it controls the
/// terminal.
pub(crate) fn print_usage(message: &clap::Error, is_colored: bool) {
    let text = message.render().ansi().to_string();
    let text = if is_colored { Cow::Borrowed(text.as_str()) } else { visible_lines(&text) };
    // If even this cannot be printed, there is nowhere left to report it.
    let _ = if message.use_stderr() {
        io::stderr().lock().write_all(text.as_bytes())
    } else {
        io::stdout().lock().write_all(text.as_bytes())
    };
}

/// Whether nothing that the parser may quote, arguments and variables, could be taken for a colour, or control a
/// terminal otherwise.
fn quotes_are_visible() -> bool {
    let variables = std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("LIGHTMESH_"));
    let quoted = std::env::args_os().chain(variables.map(|(_, value)| value));
    quoted.into_iter().all(|text| matches!(visible(&text.to_string_lossy()), Cow::Borrowed(_)))
}
