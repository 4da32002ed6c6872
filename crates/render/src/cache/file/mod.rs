//! Saved light points and gathered light: what light points see of each light, and what surfaces gather, for later runs and for other
//! devices.
//!
//! A file is a header, compressed content (deflate, RFC 1951), and a trailer. All numbers are little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `LM MESH` and a zero byte |
//! | 4 | version of the format |
//! | 4 | number of triangles of the scene |
//! | 8 | hash of its geometry: triangles, and where they are cut out |
//! | … | the [content](content), compressed |
//! | 8 | bytes of the content before compression |
//! | 8 | hash of everything before (XXH3) |
//!
//! A file is accepted only if it belongs to the geometry and its hash is right. Light points at other places than an image's are found out
//! with the first image ([`MeshFault::OtherStep`]), as are other sources of gathered light ([`MeshFault::OtherSources`]); a light other than
//! the file's makes only its own values stale. What a file says of its size is never believed: memory is taken as content appears, and within
//! the budget. A hash is no signature: a file that someone forges with care yields wrong light, but nothing worse.

mod content;
mod fault;
mod frame;
mod input;
mod irradiance_cache;
mod output;
mod pack;

use std::io::{self, BufWriter, Write};
use std::path::Path;

use lightmesh_files::{Output, Portion, ReadError, read};
use lightmesh_memory::Budget;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use self::frame::VERSION;
use super::Content;
use crate::prepared::PreparedScene;
pub use fault::{MeshFault, MeshFileError, MeshSaveError};
pub use frame::{HEADER, MAGIC, TRAILER};

/// What a saved mesh holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct SavedMesh {
    /// Values of light points: light points times lights.
    pub values: u64,
    /// Records that gathered light.
    pub records: u64,
    /// Bytes of the file.
    pub bytes: u64,
}

/// Writes what there is of a scene's geometry. `None` if that is nothing, and no file is written.
pub(super) fn save(path: &Path, scene: &PreparedScene, content: Content) -> Result<Option<SavedMesh>, MeshSaveError> {
    let content = content.only_of(scene);
    if content.is_empty() {
        return Ok(None);
    }
    Ok(Some(SavedMesh { values: content.len(), records: content.records(), bytes: write(path, scene, &content)? }))
}

/// Writes what is known of a scene's geometry, whole or not at all.
pub fn write(path: &Path, scene: &PreparedScene, content: &Content) -> Result<u64, MeshSaveError> {
    let file = Output::to(path)?;
    write_to(file, scene, content).map_err(|reason| MeshSaveError::Write { path: path.into(), reason })
}

fn write_to(mut file: Output, scene: &PreparedScene, content: &Content) -> io::Result<u64> {
    let mut output = Hashed { inner: BufWriter::new(&mut file), hash: Xxh3::new(), bytes: 0 };
    output.write_all(&MAGIC)?;
    output.write_all(&VERSION.to_le_bytes())?;
    output.write_all(&(scene.geometry.triangles.stored().len() as u32).to_le_bytes())?;
    output.write_all(&scene.geometry.hash().to_le_bytes())?;
    let length = write_packed(&mut output, content)?;
    output.write_all(&length.to_le_bytes())?;
    let hash = output.hash.digest();
    output.write_all(&hash.to_le_bytes())?;
    output.flush()?;
    let bytes = output.bytes;
    drop(output);
    file.commit()?;
    Ok(bytes)
}

/// Returns how many bytes there were before compression.
fn write_packed(output: &mut impl Write, content: &Content) -> io::Result<u64> {
    let mut counted = Hashed { inner: pack::encoder(output)?, hash: Xxh3::new(), bytes: 0 };
    content::write(&mut counted, content)?;
    pack::finish(counted.inner)?;
    Ok(counted.bytes)
}

/// A writer that hashes and counts everything written.
struct Hashed<W> {
    inner: W,
    hash: Xxh3,
    bytes: u64,
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.hash.update(&bytes[..count]);
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Reads what was saved of a scene's geometry.
pub fn load(path: &Path, scene: &PreparedScene, budget: Budget) -> Result<Content, MeshFileError> {
    let portion = |wanted| Portion { wanted, budget };
    let bytes = |wanted| read(path, portion(wanted)).map_err(unread);
    // What is no mesh is not read.
    let loaded = bytes(HEADER as u64).and_then(|head| Header::parse(&head)).and_then(|_| bytes(u64::MAX));
    loaded.and_then(|bytes| decode(&bytes, scene, budget)).map_err(|fault| MeshFileError { path: path.into(), fault })
}

fn unread(error: ReadError) -> MeshFault {
    match error {
        ReadError::Memory(short) => MeshFault::Memory(short),
        other => MeshFault::Read(other),
    }
}

/// Decodes all bytes of a file.
pub fn decode(bytes: &[u8], scene: &PreparedScene, budget: Budget) -> Result<Content, MeshFault> {
    // 1. Is it what was saved for this geometry?
    let header = Header::parse(bytes)?;
    let Some((content, hash)) = bytes.split_last_chunk::<8>() else { return Err(MeshFault::Damaged(CUT_OFF)) };
    if bytes.len() < HEADER + TRAILER {
        return Err(MeshFault::Damaged(CUT_OFF));
    }
    if xxh3_64(content).to_le_bytes() != *hash {
        return Err(MeshFault::Damaged("its hash is wrong, or it is cut off"));
    }
    let triangles = scene.geometry.triangles.stored().len();
    if header.triangles as usize != triangles || header.geometry != scene.geometry.hash() {
        return Err(MeshFault::OtherGeometry { found: header.triangles, expected: triangles });
    }

    // 2. Its content.
    let (packed, length) = content[HEADER..].split_at(content.len() - HEADER - 8);
    let length = length.try_into().map_or(0, u64::from_le_bytes);
    let geometries: Vec<u64> = scene.geometry.all_parts().iter().map(|geometry| geometry.hash()).collect();
    content::read(packed, length, budget, &geometries)
}

const CUT_OFF: &str = "it is cut off";

struct Header {
    triangles: u32,
    geometry: u64,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<Header, MeshFault> {
        let rest = bytes.strip_prefix(&MAGIC).ok_or(MeshFault::NotAMesh)?;
        let cut_off = || MeshFault::Damaged(CUT_OFF);
        let (version, rest) = rest.split_first_chunk().ok_or_else(cut_off)?;
        let found = u32::from_le_bytes(*version);
        if found != VERSION {
            return Err(MeshFault::Version { found });
        }
        let (triangles, rest) = rest.split_first_chunk().ok_or_else(cut_off)?;
        let geometry = rest.first_chunk().ok_or_else(cut_off)?;
        Ok(Header { triangles: u32::from_le_bytes(*triangles), geometry: u64::from_le_bytes(*geometry) })
    }
}
