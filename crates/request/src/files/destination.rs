//! Where an output goes: to a file, or to standard output, which is written as `-`.

use std::fmt;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};

use lightmesh_files::{Output, Ready, TargetError, check_output, identity, is_standard_output};

use crate::error::OutputError;
use crate::words::Name;

/// What stands for standard input and output on the command line. A file of this name is `./-`.
const STANDARD: &str = "-";
/// Another name of standard output.
const DEVICE: &str = "/dev/stdout";

/// Whether a path on the command line stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// Where an output goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// Standard output.
    Stdout,
    /// A file, a pipe or a device.
    File(PathBuf),
}

impl Destination {
    /// As typed.
    pub fn new(path: &Path) -> Destination {
        if is_standard(path) { Destination::Stdout } else { Destination::File(path.to_owned()) }
    }

    /// Its path, unless it is standard output.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Destination::Stdout => None,
            Destination::File(path) => Some(path),
        }
    }

    /// Checks that it could be written, without touching what is there.
    pub fn check_writable(&self) -> Result<(), TargetError> {
        self.file().map_or(Ok(()), lightmesh_files::check_writable)
    }

    /// Checks that bytes do not go to a terminal, where nobody can read them, nor nowhere. `output` is what sends them.
    pub fn check_binary(&self, output: Name) -> Result<(), OutputError> {
        if self.is_stdout() {
            check_output().map_err(OutputError::Stdout)?;
        }
        if self.is_stdout() && io::stdout().is_terminal() { Err(OutputError::Terminal { output }) } else { Ok(()) }
    }

    /// Whether what is written goes where standard output goes, by whatever name.
    pub fn is_stdout(&self) -> bool {
        match self {
            Destination::Stdout => true,
            // What several outputs send to a device such as /dev/null is not mixed up.
            Destination::File(path) => {
                path == Path::new(DEVICE) || is_standard_output(path) && identity(path).is_some()
            }
        }
    }

    /// An output that appears when it is published.
    pub fn open(&self) -> Result<Output, TargetError> {
        self.file().map_or_else(|| Ok(Output::to_stdout()), Output::to)
    }

    /// A complete output that appears when it is published.
    pub fn ready(&self, bytes: &[u8]) -> Result<Ready, OutputError> {
        Ok(self.open()?.filled(bytes)?)
    }
}

impl fmt::Display for Destination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Destination::Stdout => f.write_str("standard output"),
            Destination::File(path) => path.display().fmt(f),
        }
    }
}

/// Checks that at most one output goes to standard output.
pub fn check_one_on_stdout<'a>(
    outputs: impl IntoIterator<Item = (Name, Option<&'a Destination>)>,
) -> Result<(), OutputError> {
    let on_stdout = |(_, output): &(_, Option<&Destination>)| output.is_some_and(Destination::is_stdout);
    let mut outputs = outputs.into_iter().filter(on_stdout).map(|(flag, _)| flag);
    match (outputs.next(), outputs.next()) {
        (Some(first), Some(second)) => Err(OutputError::Mixed { first, second }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dash_is_standard_output_and_a_file_can_still_have_that_name() {
        assert_eq!(Destination::new(Path::new("-")), Destination::Stdout);
        assert_eq!(Destination::new(Path::new("./-")).file(), Some(Path::new("./-")));
        assert_eq!(Destination::new(Path::new("-")).to_string(), "standard output");
    }

    #[test]
    fn only_one_output_goes_to_standard_output() {
        let [dash, device, file] = ["-", "/dev/stdout", "a.png"].map(|name| Destination::new(Path::new(name)));
        let check =
            |outputs: [&Destination; 2]| check_one_on_stdout(["-o", "--stats"].into_iter().zip(outputs.map(Some)));
        assert!(check([&dash, &file]).is_ok() && check([&file, &file]).is_ok() && check([&file, &dash]).is_ok());
        assert!(check([&dash, &dash]).is_err());
        let message = check([&dash, &device]).unwrap_err().to_string();
        assert_eq!(message, "-o and --stats both go to standard output; send one of them to a file");
    }
}
