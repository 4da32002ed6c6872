//! Grid files, of `lightmesh grid`.
//!
//! A file is a header, the flat form, and for each stored triangle its position in the list that the grid was built from; the
//! triangles themselves come from the scene. All numbers are little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `LM GRID` and a zero byte |
//! | 4 | version of the format |
//! | 4 | number of triangles that the grid was built from |
//! | 8 | hash of these triangles |
//! | 8 | number of integers of the flat form |
//! | 8 | number of triangle references |
//! | 4 each | the integers, then the references |
//! | 8 | hash of everything before |
//!
//! A file is accepted only if every byte of it is as expected: it belongs to these triangles, has the length that its header
//! says and the right hash, and each offset is the one that building would have written. So no file can make a walk fail.

mod fault;

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use glam::UVec3;
use lightmesh_files::Output;
use lightmesh_scene::Bounds;
use xxhash_rust::xxh3::{Xxh3, xxh3_64};

use super::build;
use super::cells::Grid;
use super::hash::geometry_hash;
use crate::accel::{AlphaMask, Triangle};
pub use fault::{GridFault, GridFileError, GridSaveError};

const MAGIC: [u8; 8] = *b"LM GRID\0";
const VERSION: u32 = 1;
/// Bytes of the header.
pub const HEADER: usize = 40;
/// Bytes of the trailer.
pub const TRAILER: usize = 8;

impl Grid {
    /// Writes the grid to a file, whole or not at all.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), GridSaveError> {
        let path = path.as_ref();
        let file = Output::to(path)?;
        self.write(file).map_err(|reason| GridSaveError::Write { path: path.into(), reason })
    }

    fn write(&self, mut file: Output) -> io::Result<()> {
        let mut output = Hashed { inner: BufWriter::new(&mut file), hash: Xxh3::new() };
        output.write(&MAGIC)?;
        output.write(&VERSION.to_le_bytes())?;
        output.write(&self.built_from.to_le_bytes())?;
        output.write(&self.geometry.to_le_bytes())?;
        output.write(&(self.cells.len() as u64).to_le_bytes())?;
        output.write(&(self.sources.len() as u64).to_le_bytes())?;
        for number in self.cells.iter() {
            output.write(&number.to_le_bytes())?;
        }
        for source in self.sources.iter() {
            output.write(&source.to_le_bytes())?;
        }
        let hash = output.hash.digest();
        output.inner.write_all(&hash.to_le_bytes())?;
        output.inner.flush()?;
        drop(output);
        file.commit()
    }

    /// Reads a grid that was saved for the same list of triangles.
    ///
    /// # Errors
    ///
    /// If the file cannot be read, is of another kind or version, belongs to other triangles, or differs in any byte from what was saved.
    pub fn load(path: impl AsRef<Path>, triangles: &[Triangle]) -> Result<Grid, GridFileError> {
        let path = path.as_ref();
        read(path, triangles).map_err(|fault| GridFileError { path: path.into(), fault })
    }
}

/// A writer that hashes everything written.
struct Hashed<W> {
    inner: W,
    hash: Xxh3,
}

impl<W: Write> Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.inner.write_all(bytes)
    }
}

fn read(path: &Path, triangles: &[Triangle]) -> Result<Grid, GridFault> {
    // 1. The header, before anything is allocated.
    let status = std::fs::metadata(path).map_err(GridFault::Read)?;
    if !status.is_file() {
        // Opening a pipe would wait for someone to write to it.
        return Err(GridFault::Read(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file")));
    }
    let file = File::open(path).map_err(GridFault::Read)?;
    let length = status.len();
    let mut input = BufReader::new(file);
    let mut head = Vec::with_capacity(HEADER);
    input.by_ref().take(HEADER as u64).read_to_end(&mut head).map_err(GridFault::Read)?;
    let header = Header::parse(&head)?;
    let expected = header.file_length();
    if u128::from(length) != expected {
        return Err(GridFault::Length { found: length, expected });
    }

    // 2. The rest. The buffer grows with the data that is actually there.
    let mut bytes = head;
    input.take(length - HEADER as u64).read_to_end(&mut bytes).map_err(GridFault::Read)?;
    if bytes.len() as u64 != length {
        return Err(GridFault::Length { found: bytes.len() as u64, expected });
    }
    decode(&header, &bytes, triangles)
}

/// Decodes a grid from all bytes of a file, whose number is the one in the header.
pub fn decode(header: &Header, bytes: &[u8], triangles: &[Triangle]) -> Result<Grid, GridFault> {
    // 3. Is it what was saved for these triangles?
    let geometry = geometry_hash(triangles);
    if header.built_from as usize != triangles.len() || header.geometry != geometry {
        return Err(GridFault::OtherGeometry { found: header.built_from, expected: triangles.len() });
    }
    let (content, hash) = bytes.split_at(bytes.len() - TRAILER);
    if xxh3_64(content).to_le_bytes() != hash {
        return Err(GridFault::Corrupted("its hash is wrong"));
    }
    let (cells, sources) = content[HEADER..].split_at(4 * header.cells as usize);
    let cells: Vec<i32> = words(cells).map(i32::from_le_bytes).collect();
    let sources: Vec<u32> = words(sources).map(u32::from_le_bytes).collect();

    // 4. Every number, and the grid.
    Check { cells: &cells, cell: 0, references: 0 }.run(sources.len())?;
    if sources.iter().any(|&source| triangles.get(source as usize).is_none_or(|triangle| !triangle.is_usable())) {
        return Err(GridFault::Corrupted("it refers to a triangle that does not exist"));
    }
    let usable = triangles.iter().filter(|triangle| triangle.is_usable());
    let bounds = Bounds::around(usable.flat_map(Triangle::corners));
    let dims = UVec3::new(cells[0] as u32, cells[1] as u32, cells[2] as u32);
    let (lattice, ray_clamp, margin) =
        build::frame(&bounds, dims).map_err(|_| GridFault::Corrupted("its size is impossible"))?;
    Ok(Grid {
        triangles: sources.iter().map(|&source| triangles[source as usize]).collect(),
        lattice,
        margin,
        cells: cells.into(),
        sources: sources.into(),
        ray_clamp,
        geometry,
        built_from: header.built_from,
        overruns: 0.into(),
        alpha_mask: AlphaMask::default(),
    })
}

/// The header of a file.
pub struct Header {
    built_from: u32,
    geometry: u64,
    cells: u64,
    references: u64,
}

impl Header {
    /// The header at the beginning of a file.
    pub fn parse(bytes: &[u8]) -> Result<Header, GridFault> {
        let magic = bytes.get(..MAGIC.len()).ok_or(GridFault::NotAGrid)?;
        if magic != MAGIC {
            return Err(GridFault::NotAGrid);
        }
        let bytes: &[u8; HEADER] = bytes
            .try_into()
            .map_err(|_| GridFault::Length { found: bytes.len() as u64, expected: (HEADER + TRAILER) as u128 })?;
        let word = |at: usize| [0, 1, 2, 3].map(|byte| bytes[at + byte]);
        let long = |at: usize| [0, 1, 2, 3, 4, 5, 6, 7].map(|byte| bytes[at + byte]);
        let found = u32::from_le_bytes(word(8));
        if found != VERSION {
            return Err(GridFault::Version { found });
        }
        Ok(Header {
            built_from: u32::from_le_bytes(word(12)),
            geometry: u64::from_le_bytes(long(16)),
            cells: u64::from_le_bytes(long(24)),
            references: u64::from_le_bytes(long(32)),
        })
    }

    /// Bytes of the whole file.
    pub fn file_length(&self) -> u128 {
        (HEADER + TRAILER) as u128 + 4 * (u128::from(self.cells) + u128::from(self.references))
    }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = [u8; 4]> {
    bytes.as_chunks::<4>().0.iter().copied()
}

/// Reads the flat form as the builder writes it: cells and triangle references follow each other without gaps.
struct Check<'a> {
    cells: &'a [i32],
    /// Where the next cell must lie.
    cell: usize,
    /// Where the next cell's triangles must lie.
    references: usize,
}

impl Check<'_> {
    fn run(mut self, references: usize) -> Result<(), GridFault> {
        self.grid(true)?;
        if self.cell != self.cells.len() || self.references != references {
            return Err(GridFault::Corrupted("it holds more than its cells"));
        }
        Ok(())
    }

    fn grid(&mut self, outer: bool) -> Result<(), GridFault> {
        let dims = [self.number(0)?, self.number(1)?, self.number(2)?];
        if dims.iter().any(|&count| count < 1) {
            return Err(GridFault::Corrupted("a grid has no cells"));
        }
        let first = self.cell + 3;
        let count = dims.iter().map(|&count| count as u128).product::<u128>();
        let left = self.cells.len() - first;
        let count = usize::try_from(count).ok().filter(|&count| count <= left);
        let count = count.ok_or(GridFault::Corrupted("a grid is larger than the file"))?;
        self.cell = first + count;
        for &offset in &self.cells[first..first + count] {
            if offset == -1 {
                continue;
            }
            if usize::try_from(offset) != Ok(self.cell) {
                return Err(GridFault::Corrupted("a cell is not where it should be"));
            }
            let head = self.number(0)?;
            if head < 0 {
                self.leaf(head)?
            } else if outer {
                self.grid(false)?
            } else {
                return Err(GridFault::Corrupted("grids are nested too deep"));
            }
        }
        Ok(())
    }

    fn leaf(&mut self, head: i32) -> Result<(), GridFault> {
        if usize::try_from(self.number(1)?) != Ok(self.references) {
            return Err(GridFault::Corrupted("a cell's triangles are not where they should be"));
        }
        self.references += head.unsigned_abs() as usize;
        self.cell += 2;
        Ok(())
    }

    fn number(&self, ahead: usize) -> Result<i32, GridFault> {
        self.cells.get(self.cell + ahead).copied().ok_or(GridFault::Corrupted("a cell lies beyond the end"))
    }
}
