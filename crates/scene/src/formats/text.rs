//! Text of scene files: bytes that need not be UTF-8, with any line endings.

use std::borrow::Cow;

use memchr::memchr;

use crate::build::quote::quote;

/// Number of bytes in which the characters of a quotation are found.
const QUOTED: usize = 256;

/// The text without a byte order mark, with line feeds as line endings: files with lone carriage returns, from old systems, are
/// converted.
pub fn with_line_feeds(bytes: &mut [u8]) -> &[u8] {
    if memchr(b'\n', bytes).is_none() {
        bytes.iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
    }
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The bytes decoded as UTF-8, or else as Latin-1, so that different names stay different.
pub fn decoded(bytes: &[u8]) -> Cow<'_, str> {
    match str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect::<String>().into(),
    }
}

/// A quotation from a file for a message.
pub fn quoted(bytes: &[u8]) -> String {
    quote(&decoded(&bytes[..bytes.len().min(QUOTED)]))
}

/// The first word of a line and the rest, both trimmed.
pub(super) fn split_word(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    (&line[..end], line[end..].trim_ascii_start())
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A number in decimal notation, or one of the words for infinity and NaN that `f64` accepts.
pub fn number(word: &[u8]) -> Option<f64> {
    str::from_utf8(word).ok()?.parse().ok()
}

/// A number as some programs write it: followed by the suffix of a C constant, or one of the words of C libraries for infinity and NaN.
pub fn odd_number(word: &[u8]) -> Option<f64> {
    if let [digits @ .., b'f' | b'F'] = word
        && digits.last().is_some_and(|&last| last.is_ascii_digit() || last == b'.')
    {
        return number(digits);
    }
    let word = word.to_ascii_lowercase();
    let unsigned = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(&word);
    let begins = |beginnings: &[&str]| beginnings.iter().any(|beginning| unsigned.starts_with(beginning.as_bytes()));
    if begins(&["nan(", "1.#ind", "1.#qnan", "1.#snan"]) {
        Some(f64::NAN)
    } else {
        begins(&["1.#inf"]).then_some(f64::INFINITY)
    }
}

/// The number of the line that contains byte `at`, counted from 1.
pub(super) fn line_of(text: &[u8], at: usize) -> usize {
    1 + text[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}
