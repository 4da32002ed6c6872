//! Output to standard output, standard error, and files that are written completely or not at all.

use std::borrow::Cow;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use lightmesh_files::{
    Identity, PublishError, Ready, TargetError, WriteError, directory, identity, visible, visible_json, visible_lines,
};
use serde::Serialize;

use crate::color;
use crate::destination::is_standard;

/// How long the last line may wait for someone to read standard error. On a busy machine, a thread alone may wait for tenths of a second
/// until it runs.
const PATIENCE: Duration = Duration::from_secs(1);
/// Removes a progress bar from the current line of a terminal.
const CLEAR_LINE: &str = "\r\x1b[2K";

/// Why output cannot be written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// The file cannot be created.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing the file failed.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Complete files could not be renamed.
    #[error(transparent)]
    Publish(#[from] PublishError),
    /// An output is an input, or another output.
    #[error("{first} and {second} are the same file, {}; give them different names", path.display())]
    SameFile { first: &'static str, second: &'static str, path: PathBuf },
    /// Two outputs go to standard output.
    #[error("{first} and {second} both go to standard output; send one of them to a file")]
    Mixed { first: &'static str, second: &'static str },
    /// Bytes that are no text go to a terminal.
    #[error(
        "{flag} would write binary data to the terminal; redirect standard output to a file or a pipe, or name a file"
    )]
    Terminal { flag: &'static str },
    /// An input is in a folder whose files are written.
    #[error("{what}, {}, is in a folder that {flag} fills, {}; choose another name for {flag}", path.display(), folder.display())]
    InFolder { what: &'static str, path: PathBuf, flag: &'static str, folder: PathBuf },
    /// Standard output cannot be written.
    #[error("cannot write to standard output: {0}; check its destination")]
    Stdout(io::Error),
}

/// Prints lines to standard output. Whatever names in them contain, it does not control the terminal; names that must not begin new lines
/// are made [visible] before.
pub(crate) fn print(text: &str) -> Result<(), OutputError> {
    write_stdout(&visible_lines(text))
}

/// Prints indented JSON to standard output.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), OutputError> {
    write_stdout(&visible_json(&json(value)))
}

/// Indented JSON with a trailing newline.
pub(crate) fn json(value: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(value);
    text.expect("all keys are strings and serialization does no I/O") + "\n"
}

/// A closed pipe is not an error.
fn write_stdout(text: &str) -> Result<(), OutputError> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
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

/// Checks that a file could be written to `path`, without touching an existing one.
pub(crate) fn check_writable(path: &Path) -> Result<(), OutputError> {
    Ok(lightmesh_files::check_writable(path)?)
}

/// A complete file that appears when it is published.
pub(crate) fn ready(path: &Path, bytes: &[u8]) -> Result<Ready, OutputError> {
    Ok(Ready::with(path, bytes)?)
}

/// Lets all outputs of a run appear together.
pub(crate) fn publish(outputs: Vec<Ready>) -> Result<(), OutputError> {
    Ok(lightmesh_files::publish(outputs)?)
}

/// The outputs of a run, each with the name by which the user knows it. They overwrite neither inputs nor each other.
#[derive(Debug, Default)]
pub(crate) struct Outputs {
    files: Vec<(&'static str, Identity)>,
    /// All files in these may be written; the names are known later.
    folders: Vec<(&'static str, PathBuf)>,
}

impl Outputs {
    /// Checks that the files are different.
    pub(crate) fn new<'a>(
        files: impl IntoIterator<Item = (&'static str, Option<&'a Path>)>,
    ) -> Result<Outputs, OutputError> {
        let mut outputs = Outputs::default();
        for (flag, path) in files {
            let Some(path) = path else { continue };
            if let Some(first) = outputs.same_as(path) {
                return Err(OutputError::SameFile { first, second: flag, path: path.to_owned() });
            }
            outputs.files.extend(identity(path).map(|file| (flag, file)));
        }
        Ok(outputs)
    }

    /// The same with a folder for files of any names.
    pub(crate) fn with_folder(mut self, flag: &'static str, folder: PathBuf) -> Outputs {
        self.folders.push((flag, folder));
        self
    }

    /// Whether nothing is written.
    pub(crate) fn is_empty(&self) -> bool {
        self.files.is_empty() && self.folders.is_empty()
    }

    /// Checks that none of the files, which the user knows as `what`, is overwritten.
    pub(crate) fn keep<'a>(
        &self,
        what: &'static str,
        paths: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), OutputError> {
        for path in paths {
            if let Some(flag) = self.same_as(path) {
                return Err(OutputError::SameFile { first: what, second: flag, path: path.to_owned() });
            }
            let parent = identity(directory(path));
            if let Some((flag, folder)) = self.folders.iter().find(|(_, folder)| identity(folder) == parent) {
                let (path, folder) = (path.to_owned(), folder.clone());
                return Err(OutputError::InFolder { what, path, flag, folder });
            }
        }
        Ok(())
    }

    /// The output that is the same file.
    fn same_as(&self, path: &Path) -> Option<&'static str> {
        let file = identity(path)?;
        self.files.iter().find(|(_, output)| *output == file).map(|&(flag, _)| flag)
    }

    /// Checks that no file of a scene is overwritten.
    pub(crate) fn keep_scene(&self, scene: &lightmesh::Scene) -> Result<(), OutputError> {
        self.keep("a file of the scene", scene.files.iter().map(PathBuf::as_path))
    }
}

/// The file of a scene on the command line; standard input may come from one, too.
pub(crate) fn input(scene: &Path) -> Option<&Path> {
    if is_standard(scene) { cfg!(unix).then_some(Path::new("/dev/stdin")) } else { Some(scene) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join(".").join("a"));
        let same = Outputs::new([("-o", Some(&*a)), ("--stats", None), ("--layers", Some(&*b))]).unwrap_err();
        assert!(same.to_string().starts_with("-o and --layers are the same file, "), "{same}");
        let outputs = Outputs::new([("-o", Some(&*a)), ("--layers", Some(&folder.path().join("b")))]).unwrap();
        assert!(outputs.keep("the scene", [&*b]).is_err());
        outputs.keep("the scene", [&*folder.path().join("c")]).unwrap();
    }

    #[test]
    fn a_folder_that_is_filled_has_no_input() {
        let folder = tempfile::tempdir().unwrap();
        let outputs = Outputs::default().with_folder("--report", folder.path().to_owned());
        let within = outputs.keep("the scene", [&*folder.path().join(".").join("a.obj")]).unwrap_err();
        assert!(within.to_string().contains("is in a folder that --report fills"), "{within}");
        outputs.keep("the scene", [Path::new("a.obj")]).unwrap();
    }
}
