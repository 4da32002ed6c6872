//! From the bytes of a file to its document and its binary chunk (glTF 2.0, section 4).

use std::{cell::OnceCell, path::Path};

use serde::Deserialize;

use super::{
    document::{Asset, Document},
    integers::as_integers,
};
use crate::LoadError;
use crate::build::error::Place;
use crate::build::quote::{abridged, quote};
use crate::build::warnings::Warnings;

const MAGIC: &[u8] = b"glTF";
/// Magic, version, length.
const HEADER: usize = 12;
/// Length and kind of a chunk.
const CHUNK_HEADER: usize = 8;
/// How errors about floats begin, which quote them.
const FLOAT: &str = "invalid type: floating point `";
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The parts of a file, borrowed from its bytes.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    pub(super) bin: Option<&'a [u8]>,
    /// A GLB file, whose JSON has no lines to refer to.
    binary: bool,
    /// The JSON with whole numbers as integers, if it cannot be read otherwise.
    mended: OnceCell<Vec<u8>>,
}

impl<'a> Container<'a> {
    /// Splits a GLB file; anything else is JSON.
    pub(super) fn split(path: &Path, bytes: &'a [u8]) -> Result<Container<'a>, LoadError> {
        if !bytes.starts_with(MAGIC) {
            return Ok(Container { json: trim(bytes), bin: None, binary: false, mended: OnceCell::new() });
        }
        let damaged = |problem: String| malformed(path, format!("the binary container {problem}"));
        let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
            return Err(damaged(format!("ends after {} bytes", bytes.len())));
        };
        if version != 2 {
            return Err(old(path, &version.to_string()));
        }
        let whole = bytes.get(..length as usize).ok_or_else(|| {
            damaged(format!("states a length of {length} bytes, but the file has {}: it is truncated", bytes.len()))
        })?;
        let (kind, json, rest) = chunk(whole.get(HEADER..).unwrap_or_default()).ok_or_else(|| {
            damaged(format!("states a length of {length} bytes, which is too short for its JSON chunk"))
        })?;
        if kind != b"JSON" {
            return Err(damaged("does not begin with a JSON chunk".to_owned()));
        }
        // Chunks of other types may follow, and are ignored.
        let bin = if rest.len() < CHUNK_HEADER {
            None
        } else {
            let (kind, bin, _) = chunk(rest).ok_or_else(|| {
                damaged(format!("states a length of {length} bytes, which is too short for its second chunk"))
            })?;
            (kind == b"BIN\0").then_some(bin)
        };
        Ok(Container { json: trim(json), bin, binary: true, mended: OnceCell::new() })
    }

    /// Reads the JSON. Warns of numbers that are not written as glTF requires.
    pub(super) fn parse(&self, path: &Path, warnings: &mut Warnings) -> Result<Document<'_>, LoadError> {
        let document =
            serde_json::from_slice::<Document>(self.json).or_else(|error| self.parse_mended(path, error, warnings));
        // A file of another version differs in its basic structure: report that, and not where the difference first shows.
        match document {
            Ok(document) => {
                check_version(path, &document.asset)?;
                if document.asset.version.is_number {
                    let version = &document.asset.version.text;
                    warnings
                        .push(format!("{}: its version is a number, not a text: read as `{version}`", path.display()));
                }
                Ok(document)
            }
            Err(error) => {
                if let Ok(AssetAlone { asset: Some(asset) }) = serde_json::from_slice(self.json) {
                    check_version(path, &asset)?;
                }
                Err(self.syntax(path, &error))
            }
        }
    }

    /// Reads the JSON once more, if the error is a float instead of an integer, with all whole numbers as integers.
    fn parse_mended(
        &self,
        path: &Path,
        error: serde_json::Error,
        warnings: &mut Warnings,
    ) -> serde_json::Result<Document<'_>> {
        let message = error.to_string();
        let Some(found) = message.strip_prefix(FLOAT).and_then(|rest| rest.split('`').next()) else {
            return Err(error);
        };
        let document = serde_json::from_slice(self.mended.get_or_init(|| as_integers(self.json)))?;
        let place = Place { path: path.to_owned(), line: self.line(&error) };
        warnings
            .push(format!("{place}: integers are written as floats, {} is the first: read as integers", quote(found)));
        Ok(document)
    }

    /// Line and column of an error.
    fn line(&self, error: &serde_json::Error) -> Option<(usize, usize)> {
        (!self.binary).then_some((error.line(), error.column()))
    }

    fn syntax(&self, path: &Path, error: &serde_json::Error) -> LoadError {
        let problem = if self.json.is_empty() {
            "the file contains no JSON".to_owned()
        } else {
            format!("the JSON cannot be read as glTF ({})", abridged(&error.to_string()))
        };
        LoadError::Syntax {
            place: Place { path: path.to_owned(), line: self.line(error) }.into(),
            problem,
            remedy: "export the file again".to_owned(),
        }
    }
}

#[derive(Deserialize)]
struct AssetAlone {
    asset: Option<Asset>,
}

fn check_version(path: &Path, asset: &Asset) -> Result<(), LoadError> {
    let major = |version: &str| version.split('.').next().and_then(|major| major.trim().parse::<u32>().ok());
    if major(&asset.version.text) != Some(2) {
        return Err(old(path, &asset.version.text));
    }
    match &asset.min_version {
        Some(least) if least.text != "2.0" => Err(old(path, &least.text)),
        _ => Ok(()),
    }
}

fn old(path: &Path, version: &str) -> LoadError {
    LoadError::Malformed {
        place: Place::file(path).into(),
        problem: format!("the file has glTF version `{}`", quote(version)),
        remedy: "export it as glTF 2.0".to_owned(),
    }
}

/// Type and data of the first chunk, and the bytes after it.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let length = word(bytes, 0)? as usize;
    let (header, rest) = bytes.split_at_checked(CHUNK_HEADER)?;
    let (data, rest) = rest.split_at_checked(length)?;
    Some((&header[4..], data, rest))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|&bytes| u32::from_le_bytes(bytes))
}

/// Without the byte order mark that some editors write, and without the zeros that some exporters use as padding.
fn trim(json: &[u8]) -> &[u8] {
    let json = json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(json);
    let end = json.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    json[..end].trim_ascii()
}

/// The error for a file that contradicts itself.
pub(super) fn malformed(path: &Path, problem: String) -> LoadError {
    LoadError::Malformed { place: Place::file(path).into(), problem, remedy: "export the file again".to_owned() }
}
