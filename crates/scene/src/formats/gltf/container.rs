//! From the bytes of a file to its document and its binary chunk (glTF 2.0, section 4).

use std::path::Path;

use serde::Deserialize;

use super::document::{Asset, Document};
use crate::{
    LoadError,
    error::Place,
    quote::{abridged, quote},
};

const MAGIC: &[u8] = b"glTF";
/// Magic, version, length.
const HEADER: usize = 12;
/// Length and kind of a chunk.
const CHUNK_HEADER: usize = 8;
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The parts of a file, borrowed from its bytes.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    pub(super) bin: Option<&'a [u8]>,
    /// A GLB file, whose JSON has no lines to refer to.
    binary: bool,
}

impl<'a> Container<'a> {
    /// Splits a GLB file; anything else is JSON.
    pub(super) fn split(path: &Path, bytes: &'a [u8]) -> Result<Container<'a>, LoadError> {
        if !bytes.starts_with(MAGIC) {
            return Ok(Container { json: trim(bytes), bin: None, binary: false });
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
        Ok(Container { json: trim(json), bin, binary: true })
    }

    /// Reads the JSON.
    pub(super) fn parse(&self, path: &Path) -> Result<Document<'a>, LoadError> {
        let document = serde_json::from_slice::<Document>(self.json);
        // A file of another version differs in its basic structure: report that, and not where the difference first shows.
        match document {
            Ok(document) => {
                check_version(path, &document.asset)?;
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

    fn syntax(&self, path: &Path, error: &serde_json::Error) -> LoadError {
        let problem = if self.json.is_empty() {
            "the file contains no JSON".to_owned()
        } else {
            format!("the JSON cannot be read as glTF ({})", abridged(&error.to_string()))
        };
        let line = (!self.binary).then_some((error.line(), error.column()));
        LoadError::Syntax {
            place: Place { path: path.to_owned(), line }.into(),
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
    if major(&asset.version) != Some(2) {
        return Err(old(path, &asset.version));
    }
    match &asset.min_version {
        Some(least) if least != "2.0" => Err(old(path, least)),
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
