//! `manifest.json` beside the frames of a film: what they are made of, and which are finished, so that `resume` goes on exactly.
//!
//! ```text
//! {"lightmesh_films": 3, "xxh3": "5c…", "films": {"film.####.png": {
//!   "program": "0.1.0", "scene": "9f…", "settings": {"seed": "0", …},
//!   "chosen": {"exposure": 1.5, "step": 0.02},
//!   "frames": {"1": [{"file": "film.0001.png", "bytes": 4711, "xxh3": "3a…"}], …}}}}
//! ```
//!
//! 1. A folder has one file for all its films, each under the name of its output. Runs that render parts of one film add to it in turn.
//! 2. It is written before the first frame and after frames are finished, each time as a whole, and names a frame only if all files of the
//!    frame are there. A frame that it does not name is rendered again: at worst those that were finished since it was last written.
//! 3. What is chosen for the film, exposure and step, holds for all frames. It is recorded with the first of them.
//!
//! Checksums are of 128 bits, XXH3: they detect damage and edits, not forgery. The first is that of the films as they are recorded, so that no edit
//! of the file itself makes frames that do not belong together. There is no manifest for a scene on standard input, which
//! cannot be read again, nor for a movie, which is one file.

mod record;
mod scene;
mod settings;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use lightmesh_files::{Ready, directory, publish_record};
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3;

use crate::error::ManifestError;
use crate::files::json;
use crate::order::Order;
pub(crate) use record::{Manifest, records_of};

/// The name of the file.
const NAME: &str = "manifest.json";
/// The form of the file.
const VERSION: u32 = 3;
/// Bytes that are read at once for a checksum.
const PIECE: usize = 1 << 20;

/// The content of the file.
#[derive(Debug, Serialize, Deserialize)]
struct Folder {
    lightmesh_films: u32,
    /// The checksum of `films`.
    xxh3: String,
    /// By the name of the output.
    films: BTreeMap<String, Record>,
}

/// The part of the content that tells the form of the rest.
#[derive(Debug, Deserialize)]
struct Form {
    lightmesh_films: u32,
}

/// What is recorded of a film.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// The version of the program.
    program: String,
    /// The checksum of the scene.
    scene: String,
    /// By name.
    settings: BTreeMap<String, String>,
    /// None before the first frame is finished.
    chosen: Option<Chosen>,
    /// The files of finished frames.
    frames: BTreeMap<u32, Vec<FileRecord>>,
}

/// What was chosen for all frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// In stops, if it is automatic.
    pub exposure: Option<f32>,
    /// In scene units, if it is automatic and the mode has one.
    pub step: Option<f32>,
}

/// What is recorded of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Its name in the folder, or its path.
    file: String,
    bytes: u64,
    xxh3: String,
}

impl Record {
    /// Whether frames of both can be in one film.
    fn is_of_same(&self, other: &Record) -> bool {
        let same = |a: &Record, b: &Record| (&a.program, &a.scene, &a.settings) == (&b.program, &b.scene, &b.settings);
        same(self, other) && self.chosen.is_none_or(|chosen| other.chosen.is_none_or(|other| other == chosen))
    }
}

/// The manifest of the output's folder, and the name of the film in it.
fn place(order: &Order) -> (PathBuf, String) {
    let name = order.files.picture().file_name().unwrap_or_default().to_string_lossy().into_owned();
    (directory(order.files.picture()).join(NAME), name)
}

/// What is known of the film that is to be resumed: its program and its settings are those of `order`, its scene is not yet known. `None` if it
/// was not begun.
///
/// # Errors
/// [`ManifestError`] if the frames would not be those of one film.
pub(crate) fn known(order: &Order) -> Result<Option<Record>, ManifestError> {
    if order.is_from_stdin() {
        return Err(ManifestError::StandardInput);
    }
    let (path, film) = place(order);
    let Some(record) = read(&path)?.and_then(|mut folder| folder.films.remove(&film)) else { return Ok(None) };
    let is = env!("CARGO_PKG_VERSION");
    if record.program != is {
        return Err(ManifestError::Program { path, film, was: record.program, is });
    }
    if let Some((setting, was, is)) = settings::difference(&record.settings, &settings::of(&order.request)) {
        return Err(ManifestError::Settings { path, film, setting, was, is });
    }
    Ok(Some(record))
}

/// `None` if there is none.
fn read(path: &Path) -> Result<Option<Folder>, ManifestError> {
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(reason) => return Err(ManifestError::Read { path: path.to_owned(), reason }),
    };
    let foreign = |reason| ManifestError::Foreign { path: path.to_owned(), reason };
    // Of another form, nothing else may be as it is known here.
    let Form { lightmesh_films: form } = serde_json::from_slice(&bytes).map_err(|error| foreign(error.to_string()))?;
    if form != VERSION {
        return Err(foreign(format!("its form is {form}, and {VERSION} is known")));
    }
    let folder: Folder = serde_json::from_slice(&bytes).map_err(|error| foreign(error.to_string()))?;
    if folder.xxh3 != folder.checksum() {
        return Err(ManifestError::Damaged { path: path.to_owned() });
    }
    Ok(Some(folder))
}

/// Returns its seal: the checksum that the file begins with.
fn write(path: &Path, mut folder: Folder) -> Result<String, ManifestError> {
    folder.xxh3 = folder.checksum();
    publish_record(Ready::with(path, json(&folder).as_bytes())?)?;
    Ok(folder.xxh3)
}

/// Checks that a manifest can be written: that none of another kind is there, nor a damaged one.
pub(crate) fn check(order: &Order) -> Result<(), ManifestError> {
    read(&place(order).0).map(drop)
}

/// The seal of the manifest in a folder, if there is one that is whole.
pub(crate) fn seal_in(folder: &Path) -> Option<String> {
    read(&folder.join(NAME)).ok()?.map(|folder| folder.xxh3)
}

/// Size and checksum of a file.
pub(crate) fn checksum_of(path: &Path) -> Result<(u64, String), ManifestError> {
    let mut hash = Xxh3::new();
    let bytes = digest(path, &mut hash)?;
    Ok((bytes, hex(&hash)))
}

impl Default for Folder {
    fn default() -> Folder {
        Folder { lightmesh_films: VERSION, xxh3: String::new(), films: BTreeMap::new() }
    }
}

impl Folder {
    /// The checksum of the films, by what is recorded of them and not by how it is typed.
    fn checksum(&self) -> String {
        let mut hash = Xxh3::new();
        hash.update(json(&self.films).as_bytes());
        hex(&hash)
    }
}

/// Reads a file to its end; returns its size.
fn digest(path: &Path, hash: &mut Xxh3) -> Result<u64, ManifestError> {
    let failed = |reason| ManifestError::Checksum { path: path.to_owned(), reason };
    let mut file = File::open(path).map_err(failed)?;
    let (mut piece, mut size) = (vec![0; PIECE], 0);
    loop {
        match file.read(&mut piece).map_err(failed)? {
            0 => return Ok(size),
            count => {
                hash.update(&piece[..count]);
                size += count as u64;
            }
        }
    }
}

fn hex(hash: &Xxh3) -> String {
    format!("{:032x}", hash.digest128())
}
