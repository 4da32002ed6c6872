//! ASCII STL: `solid NAME`, facets of three `vertex` lines, `endsolid NAME`, repeated for each part.
//!
//! Whitespace, line endings and case are ignored, and `endsolid` may be missing. A facet with more than three corners is
//! triangulated like any polygon.

use std::path::Path;

use glam::DVec3;
use memchr::memchr;

use super::error::malformed;
use super::soup::{BEGINNING, Soup};
use crate::LoadError;
use crate::formats::notes::Notes;
use crate::formats::polygon::Cutter;
use crate::formats::text::{line_of, number, odd_number, quoted};

/// A facet's first keyword.
const FACET: &[u8] = b"facet";
/// Its other keywords.
const PARTS: [&[u8]; 6] = [b"normal", b"outer", b"loop", b"vertex", b"endloop", b"endfacet"];

/// Reads all solids.
pub(super) fn read(path: &Path, text: &[u8]) -> Result<Soup<DVec3>, LoadError> {
    let mut soup = Soup::default();
    let mut reader = Reader { path, text, at: 0 };
    let mut cutter = Cutter::default();
    let mut corners = Vec::new();
    let mut left_out = 0;
    let mut notes = Notes::default();
    while let Some(word) = reader.word() {
        if is(word, b"solid") || is(word, b"endsolid") {
            reader.skip_name();
        } else if is(word, FACET) {
            reader.facet(&mut corners)?;
            left_out += usize::from(corners.len() < 3);
            if soup.positions.len() + corners.len() > u32::MAX as usize {
                return Err(LoadError::TooLarge { path: path.to_owned() });
            }
            let first = soup.positions.len() as u32;
            soup.positions.extend(&corners);
            cutter.cut(&corners, |triangle| soup.triangles.push(triangle.map(|corner| first + corner as u32)));
        } else if PARTS.iter().any(|part| is(word, part)) {
            return Err(reader.refuse(format!("`{}` found where a facet was expected", quoted(word))));
        } else {
            notes.add("is not a facet; its line is ignored", || (reader.line(), quoted(word)));
            reader.skip_line();
        }
    }
    let short = (left_out > 0).then(|| format!("{left_out} facets with fewer than three corners were ignored"));
    let counted = short.into_iter().chain(cutter.warning()).map(|warning| format!("{}: {warning}", path.display()));
    soup.warnings = notes.warnings(path).chain(counted).collect();
    Ok(soup)
}

fn is(word: &[u8], name: &[u8]) -> bool {
    word.eq_ignore_ascii_case(name)
}

struct Reader<'a> {
    path: &'a Path,
    text: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn word(&mut self) -> Option<&'a [u8]> {
        let rest = &self.text[self.at..];
        let begin = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let length = rest[begin..].iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len() - begin);
        self.at += begin + length;
        Some(&rest[begin..begin + length])
    }

    /// Skips a solid's name, which may be several words: the rest of the line, unless a facet begins there.
    fn skip_name(&mut self) {
        let rest = &self.text[self.at..];
        let line = &rest[..memchr(b'\n', rest).unwrap_or(rest.len())];
        let beginning = line[..line.len().min(BEGINNING)].to_ascii_lowercase();
        let facet = memchr::memmem::find_iter(&beginning, FACET).find(|&at| {
            let parted = at > 0 && beginning[at - 1].is_ascii_whitespace();
            parted && beginning[at + FACET.len()..].trim_ascii_start().starts_with(b"normal")
        });
        self.at += facet.unwrap_or(line.len());
    }

    fn skip_line(&mut self) {
        let rest = &self.text[self.at..];
        self.at += memchr(b'\n', rest).unwrap_or(rest.len());
    }

    /// The corners of a facet, whose first keyword has been read.
    fn facet(&mut self, corners: &mut Vec<DVec3>) -> Result<(), LoadError> {
        corners.clear();
        let mut in_normal = false;
        loop {
            let Some(word) = self.word() else {
                return Err(self.refuse("the file ends within a facet".to_owned()));
            };
            if is(word, b"endfacet") {
                return Ok(());
            } else if is(word, b"vertex") {
                corners.push(self.vector()?);
                in_normal = false;
            } else if is(word, b"normal") {
                in_normal = true;
            } else if [&b"outer"[..], b"loop", b"endloop"].iter().any(|name| is(word, name)) {
                in_normal = false;
            } else if !in_normal {
                // The numbers of a normal may be anything: they are not used.
                return Err(self.refuse(format!("`{}` is not a valid keyword in a facet", quoted(word))));
            }
        }
    }

    fn vector(&mut self) -> Result<DVec3, LoadError> {
        let mut vector = DVec3::ZERO;
        for axis in 0..3 {
            let word = self.word().unwrap_or_default();
            vector[axis] = number(word)
                .or_else(|| odd_number(word))
                .ok_or_else(|| self.refuse(format!("`{}` found where a coordinate was expected", quoted(word))))?;
        }
        Ok(vector)
    }

    /// The error for the word that was read last.
    fn refuse(&self, problem: String) -> LoadError {
        malformed(self.path, Some(self.line()), problem)
    }

    /// The line of the word that was read last.
    fn line(&self) -> usize {
        line_of(self.text, self.at.saturating_sub(1))
    }
}
