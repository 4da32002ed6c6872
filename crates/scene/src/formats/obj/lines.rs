//! The lines of an OBJ file, checked one by one and handed to tobj in the form that it reads right.
//!
//! - Face indices are made absolute and checked against what has been read, so that an error names its line.
//! - tobj keeps one list of normals for a model and takes their number for that of its vertices: where faces with and without
//!   normals or texture coordinates follow each other, a new group is begun.
//! - Bytes that are not UTF-8 (comments in Latin-1), continued lines, one-dimensional texture coordinates and vertex colours
//!   are evened out.

use std::{
    collections::BTreeSet,
    io::{self, BufRead, Read},
    path::{Path, PathBuf},
};

use super::malformed;
use crate::LoadError;

/// Which indices the corners of a face have besides the position's.
type Attributes = [bool; 2];

/// A reader of checked lines; tobj asks for one line at a time.
pub(super) struct Lines<'a> {
    path: PathBuf,
    rest: &'a [u8],
    /// Lines taken from `rest` so far: the number of the last one.
    line: usize,
    text: String,
    checked: Vec<u8>,
    taken: usize,
    /// Positions, texture coordinates and normals so far.
    counts: [usize; 3],
    attributes: Option<Attributes>,
    failure: Option<LoadError>,
    points_and_lines: usize,
    unknown: Option<(usize, String)>,
    used_materials: BTreeSet<String>,
}

impl<'a> Lines<'a> {
    pub(super) fn new(path: &Path, bytes: &'a [u8]) -> Lines<'a> {
        Lines {
            path: path.to_owned(),
            rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes),
            line: 0,
            text: String::new(),
            checked: Vec::new(),
            taken: 0,
            counts: [0; 3],
            attributes: None,
            failure: None,
            points_and_lines: 0,
            unknown: None,
            used_materials: BTreeSet::new(),
        }
    }

    /// Why reading stopped: our own reason, or tobj's at the line that it saw last.
    pub(super) fn failure(self, error: tobj::LoadError) -> LoadError {
        let (path, line, text) = (self.path, self.line, self.text);
        self.failure.unwrap_or_else(|| {
            malformed(&path, line, format!("`{text}` cannot be read ({error})"), "correct the line or export again")
        })
    }

    /// What was left out, and materials that no library has.
    pub(super) fn warnings(&self, materials: &[tobj::Material]) -> Vec<String> {
        let path = self.path.display();
        let mut warnings = Vec::new();
        if self.points_and_lines > 0 {
            warnings.push(format!("{path}: {} points and lines were left out", self.points_and_lines));
        }
        if let Some((line, word)) = &self.unknown {
            warnings.push(format!("{path}:{line}: `{word}` and other lines of unknown meaning were left out"));
        }
        let missing: Vec<&str> = self.used_materials.iter().map(String::as_str).collect();
        let missing: Vec<&str> =
            missing.into_iter().filter(|name| !materials.iter().any(|material| material.name == *name)).collect();
        if !missing.is_empty() {
            warnings.push(format!("{path}: no library has the material {}; light grey is used", missing.join(", ")));
        }
        warnings
    }

    /// Takes one line, with those that continue it, into `self.text`; false at the end.
    fn take_line(&mut self) -> bool {
        self.text.clear();
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&byte| byte == b'\n').unwrap_or(self.rest.len());
            let (line, rest) = self.rest.split_at(end);
            self.rest = rest.get(1..).unwrap_or_default();
            self.line += 1;
            self.text.push_str(String::from_utf8_lossy(line).trim());
            if !self.text.ends_with('\\') {
                return true;
            }
            self.text.pop();
            self.text.push(' ');
        }
        !self.text.is_empty()
    }

    /// Writes the checked form of `self.text` to `self.checked`.
    fn check_line(&mut self) -> Result<(), LoadError> {
        let text = std::mem::take(&mut self.text);
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((&text, ""));
        let result = match word {
            "v" => self.numbers(0, word, rest, 3),
            "vt" => self.numbers(1, word, rest, 2),
            "vn" => self.numbers(2, word, rest, 3),
            "f" | "fo" => self.face(rest),
            "l" | "p" => {
                self.points_and_lines += 1;
                Ok(())
            }
            "usemtl" => {
                self.used_materials.insert(rest.trim().to_owned());
                self.emit(&["usemtl ", rest.trim()])
            }
            "mtllib" => self.emit(&["mtllib ", rest.trim()]),
            "g" | "o" => self.emit(&["g ", rest]),
            "" | "s" | "mg" | "lod" | "bevel" | "c_interp" | "d_interp" => Ok(()),
            comment if comment.starts_with('#') => Ok(()),
            unknown => {
                self.unknown.get_or_insert_with(|| (self.line, unknown.chars().take(20).collect()));
                Ok(())
            }
        };
        self.text = text;
        result
    }

    fn emit(&mut self, words: &[&str]) -> Result<(), LoadError> {
        words.iter().for_each(|word| self.checked.extend(word.as_bytes()));
        self.checked.push(b'\n');
        Ok(())
    }

    /// A position, texture coordinate or normal: `count` numbers, and of a position's further ones only the weight.
    fn numbers(&mut self, kind: usize, word: &str, rest: &str, count: usize) -> Result<(), LoadError> {
        self.counts[kind] += 1;
        let words: Vec<&str> = rest.split_whitespace().collect();
        match words.len() {
            1 if word == "vt" => self.emit(&["vt ", words[0], " 0"]),
            4 if word == "v" => self.emit(&["v ", rest]),
            given if given < count => {
                let problem = format!("`{word} {rest}` has fewer than {count} numbers");
                Err(malformed(&self.path, self.line, problem, "correct the line or export again"))
            }
            _ => self.emit(&[word, " ", &words[..count].join(" ")]),
        }
    }

    fn face(&mut self, rest: &str) -> Result<(), LoadError> {
        let corners = rest.split_whitespace().map(|corner| self.corner(corner)).collect::<Result<Vec<_>, _>>()?;
        if corners.len() < 3 {
            self.points_and_lines += 1;
            return Ok(());
        }
        // A corner without normal makes the whole face flat.
        let attributes = [1, 2].map(|kind| corners.iter().all(|corner| corner[kind].is_some()));
        if self.attributes.replace(attributes).is_some_and(|before| before != attributes) {
            self.emit(&["g"])?;
        }
        let mut line = String::from("f");
        for [position, uv, normal] in corners {
            let text = |index: Option<usize>| index.map_or(String::new(), |index| index.to_string());
            let corner = match attributes {
                [false, false] => text(position),
                [true, false] => text(position) + "/" + &text(uv),
                [false, true] => text(position) + "//" + &text(normal),
                [true, true] => text(position) + "/" + &text(uv) + "/" + &text(normal),
            };
            line = line + " " + &corner;
        }
        self.emit(&[&line])
    }

    /// The indices of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1 from the file's beginning.
    fn corner(&self, corner: &str) -> Result<[Option<usize>; 3], LoadError> {
        const NAMES: [&str; 3] = ["position", "texture coordinate", "normal"];
        let refuse = |problem: String| {
            let remedy = "indices count from 1, or from −1 backwards; correct the face or export again";
            malformed(&self.path, self.line, problem, remedy)
        };
        let mut indices = [None; 3];
        for (kind, word) in corner.split('/').enumerate() {
            let Some(index) = indices.get_mut(kind) else {
                return Err(refuse(format!("the face's corner `{corner}` has more than three indices")));
            };
            if word.is_empty() && kind > 0 {
                continue;
            }
            let number: i64 =
                word.parse().map_err(|_| refuse(format!("the face's corner `{corner}` is not made of indices")))?;
            let count = self.counts[kind] as i64;
            let absolute = if number < 0 { count.saturating_add(number).saturating_add(1) } else { number };
            if !(1..=count).contains(&absolute) {
                let problem = format!("the face's corner `{corner}` asks for {} {number} of {count}", NAMES[kind]);
                return Err(refuse(problem));
            }
            *index = Some(absolute as usize);
        }
        Ok(indices)
    }
}

impl BufRead for Lines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.checked.len() {
            self.checked.clear();
            self.taken = 0;
            while self.checked.is_empty() && self.take_line() {
                if let Err(failure) = self.check_line() {
                    self.failure = Some(failure);
                    return Err(io::ErrorKind::InvalidData.into());
                }
            }
        }
        Ok(&self.checked[self.taken..])
    }

    fn consume(&mut self, amount: usize) {
        self.taken += amount;
    }
}

impl Read for Lines<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let amount = self.fill_buf()?.read(buffer)?;
        self.consume(amount);
        Ok(amount)
    }
}
