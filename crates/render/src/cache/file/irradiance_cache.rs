//! Gathered light in the content of a mesh file.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | hash of all that it depends on |
//! | | for fine cells, and for coarse ones: |
//! | 8 | number of cells |
//! | 1 to 10, 1 each | their keys, each as the difference from the one before, 7 bits in a byte; number of records |
//! | 1 each | the records, cell by cell: kind of surface, plus 16 if it has a value |
//! | 36 each | position, where rays begin, normal |
//! | 60 or 2112 each | values: the words of [`SurfaceLight`] or [`CoarseLight`] |
//! | 8 | number of nodes |
//! | 1 to 10, 1 each | their names, as the keys; how many values are known |
//! | 1, 36 each | 0 if no surface was found there, 2 if it is covered, else 1; if it was found, as of records |
//! | 12 each | of those: the values that are known |

use std::io::{self, Read, Write};

use bytemuck::Pod;
use glam::Vec3;
use lightmesh_layout::constants::SURFACE_KINDS;
use lightmesh_layout::irradiance_cache::{CoarseLight, SurfaceLight};

use super::super::SavedGathered;
use super::fault::MeshFault;
use super::input::Input;
use super::output::write_difference;
use crate::stages::irradiance_cache::saved::{
    END_OF_CELLS, END_OF_NAMES, ORDERS, SavedCells, SavedLight, SavedNode, SavedPlace, SavedRecord,
};

/// Added to the kind of a record that has a value.
const HAS_VALUE: u8 = 1 << 4;
/// More cells or nodes than this have no numbers.
const MOST: u64 = 1 << 28;
/// By how much the square of the length of a unit vector may differ from 1.
const ROUNDING: f32 = 1e-3;

pub(super) fn write(output: &mut impl Write, saved: &SavedGathered) -> io::Result<()> {
    let SavedLight { fine, coarse, nodes } = &saved.light;
    output.write_all(&saved.sources.to_le_bytes())?;
    write_cells(output, fine)?;
    write_cells(output, coarse)?;
    write_nodes(output, nodes)
}

fn write_cells<V: Pod>(output: &mut impl Write, saved: &SavedCells<V>) -> io::Result<()> {
    output.write_all(&(saved.cells.len() as u64).to_le_bytes())?;
    let mut before = 0;
    for &(key, count) in &saved.cells {
        write_difference(output, key - before)?;
        output.write_all(&[count as u8])?;
        before = key;
    }
    saved
        .records
        .iter()
        .try_for_each(|record| output.write_all(&[record.kind | if record.has_value { HAS_VALUE } else { 0 }]))?;
    saved.records.iter().try_for_each(|record| write_words(output, &record.place))?;
    saved.values.iter().try_for_each(|value| write_words(output, value))
}

fn write_nodes(output: &mut impl Write, nodes: &[SavedNode]) -> io::Result<()> {
    output.write_all(&(nodes.len() as u64).to_le_bytes())?;
    let mut before = 0;
    for node in nodes {
        write_difference(output, node.name - before)?;
        output.write_all(&[node.known])?;
        before = node.name;
    }
    nodes.iter().try_for_each(|node| {
        if !node.is_somewhere() {
            return output.write_all(&[0]);
        }
        output.write_all(&[1 + u8::from(node.covered)])?;
        write_words(output, &node.place)?;
        node.values[..node.known.into()].iter().try_for_each(|value| write_words(output, value))
    })
}

/// Writes a value that consists of words.
fn write_words<V: Pod>(output: &mut impl Write, value: &V) -> io::Result<()> {
    let words: &[u32] = bytemuck::cast_slice(std::slice::from_ref(value));
    words.iter().try_for_each(|word| output.write_all(&word.to_le_bytes()))
}

impl<R: Read> Input<R> {
    /// What surfaces of a geometry gathered.
    pub(super) fn gathered(&mut self, geometry: u64) -> Result<SavedGathered, MeshFault> {
        let sources = self.long()?;
        let fine = self.cells::<SurfaceLight>()?;
        let coarse = self.cells::<CoarseLight>()?;
        Ok(SavedGathered { geometry, sources, light: SavedLight { fine, coarse, nodes: self.nodes()? } })
    }

    fn cells<V: Pod>(&mut self) -> Result<SavedCells<V>, MeshFault> {
        let cells = self.keys(END_OF_CELLS, SURFACE_KINDS as u8)?;
        let count = cells.iter().map(|&(_, count)| u64::from(count)).sum();
        let kinds = self.numbers(count, |[kind]: [u8; 1]| kind)?;
        if kinds.iter().any(|kind| u32::from(kind & !HAS_VALUE) >= SURFACE_KINDS) {
            return Err(MeshFault::Damaged("it has a surface of no kind"));
        }
        let mut records = Vec::new();
        let mut count = 0;
        for kind in kinds {
            let has_value = kind & HAS_VALUE != 0;
            count += u64::from(has_value);
            let place = self.place()?;
            self.hold(&records, 1)?;
            records.push(SavedRecord { kind: kind & !HAS_VALUE, has_value, place });
        }
        let mut values = Vec::new();
        for _ in 0..count {
            self.hold(&values, 1)?;
            values.push(self.words()?);
        }
        Ok(SavedCells { cells, records, values })
    }

    fn nodes(&mut self) -> Result<Vec<SavedNode>, MeshFault> {
        let names = self.keys(END_OF_NAMES, ORDERS as u8)?;
        let mut nodes = Vec::new();
        for (name, known) in names {
            let [state] = self.bytes()?;
            let mut node = SavedNode { name, covered: state != 1, known: known as u8, ..SavedNode::default() };
            if state != 0 {
                node.place = self.place()?;
                for value in &mut node.values[..known as usize] {
                    *value = self.words()?;
                }
            }
            self.hold(&nodes, 1)?;
            nodes.push(node);
        }
        Ok(nodes)
    }

    /// Keys below `end` that ascend, each with a number from 1 to `most`.
    fn keys(&mut self, end: u64, most: u8) -> Result<Vec<(u64, u32)>, MeshFault> {
        let count = self.long()?;
        if count > MOST {
            return Err(MeshFault::Damaged("it has more cells than there can be"));
        }
        let mut keys: Vec<(u64, u32)> = Vec::new();
        for _ in 0..count {
            let difference = self.difference()?;
            let [number] = self.bytes()?;
            let key = match keys.last() {
                Some(_) if difference == 0 => None,
                before => before.map_or(0, |&(key, _)| key).checked_add(difference).filter(|&key| key < end),
            };
            let key = key.ok_or(MeshFault::Damaged("its cells are not in order"))?;
            if number == 0 || number > most {
                return Err(MeshFault::Damaged("a cell has more than it can have"));
            }
            self.hold(&keys, 1)?;
            keys.push((key, number.into()));
        }
        Ok(keys)
    }

    /// A point of the surfaces: rays can begin there.
    fn place(&mut self) -> Result<SavedPlace, MeshFault> {
        let place: SavedPlace = self.words()?;
        let is_finite = place.as_flattened().iter().all(|number| number.is_finite());
        if is_finite && (Vec3::from(place[2]).length_squared() - 1.0).abs() < ROUNDING {
            Ok(place)
        } else {
            Err(MeshFault::Damaged("it has surfaces that are nowhere"))
        }
    }

    /// A value that consists of words.
    fn words<V: Pod>(&mut self) -> Result<V, MeshFault> {
        let mut value = V::zeroed();
        let words: &mut [u32] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut value));
        for word in words {
            *word = self.int()?;
        }
        Ok(value)
    }
}
