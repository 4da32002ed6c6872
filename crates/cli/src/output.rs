//! Output to standard output, standard error, and files that are written completely or not at all.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use lightmesh_files::{Replacement, TargetError, resolved, visible, visible_json, visible_lines};
use serde::Serialize;

/// Why output cannot be written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// The file cannot be created.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// Writing the file failed.
    #[error("cannot write {}: {reason}; nothing was written; check the free disk space", path.display())]
    Write { path: PathBuf, reason: io::Error },
    /// Two outputs are the same file.
    #[error("{first} and {second} are the same file, {}; give them different names", path.display())]
    SameFile { first: &'static str, second: &'static str, path: PathBuf },
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
    let _ = writeln!(io::stderr().lock(), "{}", visible(text));
}

/// Prints one line of JSON to standard error.
pub(crate) fn complain_json(value: &impl Serialize) {
    // Strings and finite numbers can always be represented in JSON.
    if let Ok(line) = serde_json::to_string(value) {
        let _ = writeln!(io::stderr().lock(), "{}", visible_json(&line));
    }
}

/// Prints what the parser of the command line says: help, or an error that quotes arguments.
pub(crate) fn print_usage(message: &clap::Error) {
    let text = message.render().to_string();
    let text = visible_lines(&text);
    // If even this cannot be printed, there is nowhere left to report it.
    let _ = if message.use_stderr() {
        io::stderr().lock().write_all(text.as_bytes())
    } else {
        io::stdout().lock().write_all(text.as_bytes())
    };
}

/// Checks that a file could be written to `path`, without touching an existing one.
pub(crate) fn check_writable(path: &Path) -> Result<(), OutputError> {
    Ok(lightmesh_files::check_writable(path)?)
}

/// Writes a file completely or not at all.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let failed = |reason| OutputError::Write { path: path.to_owned(), reason };
    let mut file = Replacement::of(path)?;
    file.write_all(bytes).map_err(failed)?;
    file.commit().map_err(failed)
}

/// Rejects paths to the same file. Each comes with the name by which the user knows it.
pub(crate) fn check_distinct(files: &[(&'static str, Option<&Path>)]) -> Result<(), OutputError> {
    let mut seen: Vec<(&str, PathBuf)> = Vec::new();
    for &(second, path) in files {
        let Some(path) = path else { continue };
        let place = resolved(path);
        if let Some(&(first, _)) = seen.iter().find(|(_, other)| *other == place) {
            return Err(OutputError::SameFile { first, second, path: path.to_owned() });
        }
        seen.push((second, place));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_has_many_names() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join(".").join("a"));
        let same = check_distinct(&[("-o", Some(&a)), ("--stats", None), ("--layers", Some(&b))]).unwrap_err();
        assert!(same.to_string().starts_with("-o and --layers are the same file, "), "{same}");
        check_distinct(&[("-o", Some(&a)), ("--layers", Some(&folder.path().join("b")))]).unwrap();
    }
}
