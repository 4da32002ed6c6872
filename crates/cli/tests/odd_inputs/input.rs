//! An odd input.

use std::fs;
use std::path::Path;

/// The expected outcome of opening it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Expected {
    /// A scene.
    Opens,
    /// Exit code 2.
    Refused,
    /// Either: where exactly a file is truncated does not matter.
    Either,
}

/// How the program is given the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum As {
    Scene,
    /// A saved grid of `room.toml`.
    Grid,
}

/// Files in a separate folder, and the expected outcome.
pub(crate) struct Input {
    /// Format and oddity.
    pub(crate) name: String,
    /// The file passed to the program.
    pub(crate) opened: String,
    pub(crate) opened_as: As,
    /// Creates the files in the folder.
    pub(crate) make: Box<dyn Fn(&Path) + Send>,
    pub(crate) expected: Expected,
    /// The file that an error must name.
    pub(crate) culprit: String,
    /// The system does not support the test.
    pub(crate) ignored: bool,
}

impl Input {
    /// A file `input.FORMAT` with these bytes.
    pub(crate) fn new(format: &str, oddity: impl ToString, bytes: impl AsRef<[u8]>, expected: Expected) -> Input {
        let (opened, bytes) = (format!("input.{format}"), bytes.as_ref().to_vec());
        let file = opened.clone();
        Input::made(format, oddity, &opened, expected, move |folder| fs::write(folder.join(&file), &bytes).unwrap())
    }

    /// Whatever `make` creates in the folder, opened as `opened`.
    pub(crate) fn made(
        format: &str,
        oddity: impl ToString,
        opened: &str,
        expected: Expected,
        make: impl Fn(&Path) + Send + 'static,
    ) -> Input {
        Input {
            name: format!("{format}: {}", oddity.to_string()),
            opened: opened.to_owned(),
            opened_as: if format == "grid" { As::Grid } else { As::Scene },
            make: Box::new(make),
            expected,
            culprit: opened.to_owned(),
            ignored: false,
        }
    }

    /// With another file next to it.
    pub(crate) fn beside(mut self, name: &str, bytes: impl AsRef<[u8]>) -> Input {
        let (name, bytes) = (name.to_owned(), bytes.as_ref().to_vec());
        let make = self.make;
        self.make = Box::new(move |folder| {
            make(folder);
            fs::write(folder.join(&name), &bytes).unwrap();
        });
        self
    }

    /// Errors name another file.
    pub(crate) fn blaming(self, culprit: &str) -> Input {
        Input { culprit: culprit.to_owned(), ..self }
    }
}

/// The file truncated after 1, 2, 4 … bytes.
pub(crate) fn cut(format: &str, what: &str, whole: &[u8]) -> Vec<Input> {
    lengths(whole)
        .map(|length| Input::new(format, format!("{what} cut after {length}"), &whole[..length], Expected::Either))
        .collect()
}

/// The powers of two below a file's length.
pub(crate) fn lengths(whole: &[u8]) -> impl Iterator<Item = usize> + use<> {
    let length = whole.len();
    (0..usize::BITS).map(|power| 1 << power).take_while(move |&cut| cut < length)
}

/// The bytes, overwritten from `at` on.
pub(crate) fn patched(bytes: &[u8], at: usize, patch: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at..at + patch.len()].copy_from_slice(patch);
    bytes
}

/// The text in UTF-16, as Windows editors write it.
pub(crate) fn utf_16(text: &str) -> Vec<u8> {
    let units = std::iter::once('\u{feff}').chain(text.chars()).collect::<String>();
    units.encode_utf16().flat_map(u16::to_le_bytes).collect()
}
