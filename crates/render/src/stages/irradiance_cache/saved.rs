//! Gathered light in the form in which it goes to files and to other devices: cells in ascending order, without the numbers that records and nodes
//! got in the order in which they were found. It is the same whoever gathered it, and in whatever order.
//!
//! Cells none of whose records has gathered anything are left out: which of them there are depends on how places are grouped. They are found
//! again when they are asked for. Of nodes, what arrives there is kept, and not what their rays hit.

use bytemuck::Pod;
use glam::Vec3;
use lightmesh_layout::constants::{CELL_INDEX_BITS, LEVEL_BIAS};
use lightmesh_layout::irradiance_cache::{
    Bins as StoredBins, CoarseLight as StoredCoarse, SurfaceLight as StoredLight,
};

pub(crate) use super::bounce::ORDERS;
use super::bounce::{Bounce, Node};
use super::cells::{CellKey, Cells, FINER, KIND, KIND_BITS, NAME_BITS, Record};
use super::coarse::CoarseLight;
use super::cpu::SurfaceLight;
use super::light::{Bins, Light};
use crate::surface::SurfacePoint;

/// What was gathered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedLight {
    /// Light that is gathered near by.
    pub fine: SavedCells<StoredLight>,
    /// Light that coarse records gather.
    pub coarse: SavedCells<StoredCoarse>,
    /// In the order of their names.
    pub nodes: Vec<SavedNode>,
}

/// Cells with their records, and what these gather.
#[derive(Clone, Debug)]
pub struct SavedCells<V> {
    /// In ascending order, each with the number of its records.
    pub cells: Vec<(CellKey, u32)>,
    /// Those of all cells, one after the other.
    pub records: Vec<SavedRecord>,
    /// Of those records that have a value, in their order.
    pub values: Vec<V>,
}

/// A record of a cell, which tells its level.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SavedRecord {
    /// Its kind of surface.
    pub kind: u8,
    /// Whether light was gathered there.
    pub has_value: bool,
    /// Where it lies, as it is stored.
    pub place: SavedPlace,
}

/// A point of the surfaces: position, where rays begin, and normal.
pub type SavedPlace = [[f32; 3]; 3];

/// What arrives at a record that rays of others hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SavedNode {
    /// Its cell, by how many levels that is smaller than what was asked at first, and its kind of surface.
    pub name: u64,
    /// All zeros if no such surface was found.
    pub place: SavedPlace,
    /// Whether something covers it.
    pub covered: bool,
    /// How many of the values are known.
    pub known: u8,
    /// Light after up to one, two, … reflections; zero where it is not known.
    pub values: [[f32; 3]; ORDERS],
}

/// Cells have smaller keys than this: no level has all seven bits.
pub(crate) const END_OF_CELLS: CellKey = 127 << (3 * CELL_INDEX_BITS);
/// Nodes have smaller names than this.
pub(crate) const END_OF_NAMES: u64 = END_OF_CELLS << NAME_BITS;

/// The level of a cell.
pub(super) fn level_of_key(key: CellKey) -> i32 {
    (key >> (3 * CELL_INDEX_BITS)) as i32 - LEVEL_BIAS
}

impl SavedLight {
    /// Number of records that gathered light.
    pub(crate) fn len(&self) -> u64 {
        (self.fine.values.len() + self.coarse.values.len()) as u64
    }

    /// Bytes in memory.
    pub(crate) fn memory(&self) -> u64 {
        self.fine.memory() + self.coarse.memory() + size_of_val(&self.nodes[..]) as u64
    }
}

impl<V> Default for SavedCells<V> {
    fn default() -> SavedCells<V> {
        SavedCells { cells: Vec::new(), records: Vec::new(), values: Vec::new() }
    }
}

impl<V: Pod> PartialEq for SavedCells<V> {
    /// To the bit.
    fn eq(&self, other: &SavedCells<V>) -> bool {
        let [bits, others] = [self, other].map(|cells| bytemuck::cast_slice::<V, u8>(&cells.values));
        self.cells == other.cells && self.records == other.records && bits == others
    }
}

impl<V> SavedCells<V> {
    fn memory(&self) -> u64 {
        (size_of_val(&self.cells[..]) + size_of_val(&self.records[..]) + size_of_val(&self.values[..])) as u64
    }

    /// Adds a cell that follows those before. It is left out if none of its records has a value.
    pub(super) fn add(&mut self, key: CellKey, records: impl Iterator<Item = (u64, SavedPlace, Option<V>)>) {
        let (first, valued) = (self.records.len(), self.values.len());
        for (seed, place, value) in records {
            self.records.push(SavedRecord { kind: (seed & KIND) as u8, has_value: value.is_some(), place });
            self.values.extend(value);
        }
        if self.values.len() == valued {
            self.records.truncate(first);
        } else {
            self.cells.push((key, (self.records.len() - first) as u32));
        }
    }

    /// Each record with the key of its cell.
    pub(super) fn records(&self) -> impl Iterator<Item = (CellKey, &SavedRecord)> {
        let keys = self.cells.iter().flat_map(|&(key, count)| (0..count).map(move |_| key));
        keys.zip(&self.records)
    }
}

impl SavedNode {
    /// The level of the smallest cells that it asks.
    pub(super) fn level(&self) -> i32 {
        level_of_key(self.cell()) + self.finer()
    }

    pub(super) fn kind(&self) -> u8 {
        (self.name & KIND) as u8
    }

    /// By how many levels its cell is smaller than what was asked at first.
    pub(super) fn finer(&self) -> i32 {
        (self.name >> KIND_BITS & FINER) as i32
    }

    pub(super) fn cell(&self) -> CellKey {
        self.name >> NAME_BITS
    }

    pub(super) fn seed(&self) -> u64 {
        seed_of(self.cell(), self.kind())
    }

    /// Whether a surface was found.
    pub(crate) fn is_somewhere(&self) -> bool {
        self.place != SavedPlace::default()
    }
}

/// The seed of a record.
pub(super) fn seed_of(key: CellKey, kind: u8) -> u64 {
    key << KIND_BITS | u64::from(kind)
}

impl SurfaceLight {
    /// All that is known.
    pub(crate) fn saved(&self) -> SavedLight {
        SavedLight {
            fine: self.fine_cells.saved(|record| Some(StoredLight::from(self.fine.get(record)?.as_ref()?))),
            coarse: self.coarse_cells.saved(|record| Some(StoredCoarse::from(&**self.coarse.get(record)?.as_ref()?))),
            nodes: self.bounce.saved(),
        }
    }

    /// What was saved.
    pub(crate) fn restored(saved: SavedLight) -> SurfaceLight {
        let SavedLight { fine, coarse, nodes } = saved;
        SurfaceLight {
            fine_cells: Cells::restored(&fine),
            coarse_cells: Cells::restored(&coarse),
            fine: by_record(&fine, |light| Light::from(light)),
            coarse: by_record(&coarse, |coarse| Box::new(CoarseLight::from(coarse))),
            bounce: Bounce::restored(&nodes),
        }
    }
}

/// The values of records.
fn by_record<V, T>(saved: &SavedCells<V>, restored: impl Fn(&V) -> T) -> Vec<Option<T>> {
    let mut values = saved.values.iter().map(restored);
    saved.records.iter().map(|record| if record.has_value { values.next() } else { None }).collect()
}

impl Cells {
    fn saved<V>(&self, value: impl Fn(usize) -> Option<V>) -> SavedCells<V> {
        let mut keys: Vec<CellKey> = self.ranges.keys().copied().collect();
        keys.sort_unstable();
        let mut saved = SavedCells::default();
        for key in keys {
            let record = |number: u32| {
                let record = &self.records[number as usize];
                (record.seed, place_of(&record.point), value(number as usize))
            };
            saved.add(key, self.of(key).map(record));
        }
        saved
    }

    fn restored<V>(saved: &SavedCells<V>) -> Cells {
        let mut first = 0;
        let range = |&(key, count): &(CellKey, u32)| {
            let range = (first, count);
            first += count;
            (key, range)
        };
        let record = |(key, record): (CellKey, &SavedRecord)| Record {
            point: point_at(record.place),
            level: level_of_key(key),
            seed: seed_of(key, record.kind),
        };
        Cells { ranges: saved.cells.iter().map(range).collect(), records: saved.records().map(record).collect() }
    }
}

impl Bounce {
    fn saved(&self) -> Vec<SavedNode> {
        let node = |(&name, &number): (&u64, &u32)| {
            let node = &self.nodes[number as usize];
            let values = node.values.map(|value| value.to_array());
            SavedNode {
                name,
                place: place_of(&node.record.point),
                covered: node.covered,
                known: node.known as u8,
                values,
            }
        };
        let mut nodes: Vec<SavedNode> = self.numbers.iter().map(node).filter(|node| node.known > 0).collect();
        nodes.sort_unstable_by_key(|node| node.name);
        nodes
    }

    /// If more of nodes is asked, their rays are cast again.
    fn restored(saved: &[SavedNode]) -> Bounce {
        let node = |node: &SavedNode| {
            let record = Record { point: point_at(node.place), level: node.level(), seed: node.seed() };
            Node::new(record, node.covered, node.known.into(), node.values.map(Vec3::from))
        };
        let numbers = saved.iter().zip(0..).map(|(node, number)| (node.name, number));
        Bounce::with_nodes(numbers, saved.iter().map(node).collect())
    }
}

fn place_of(point: &SurfacePoint) -> SavedPlace {
    [point.position, point.origin, point.normal].map(|vector| vector.to_array())
}

fn point_at(place: SavedPlace) -> SurfacePoint {
    let [position, origin, normal] = place.map(Vec3::from);
    SurfacePoint { position, origin, normal }
}

impl From<&Light> for StoredLight {
    fn from(light: &Light) -> StoredLight {
        let vector = |vector: Vec3| vector.to_array().into();
        StoredLight { mean: vector(light.mean), tilt: light.tilt.map(vector), most: vector(light.most) }
    }
}

impl From<&StoredLight> for Light {
    fn from(light: &StoredLight) -> Light {
        Light { mean: vector_of(light.mean), tilt: light.tilt.map(vector_of), most: vector_of(light.most) }
    }
}

impl From<&Bins> for StoredBins {
    fn from(bins: &Bins) -> StoredBins {
        StoredBins { sums: bins.sums.map(|sum| sum.to_array().into()), counts: bins.counts }
    }
}

impl From<&StoredBins> for Bins {
    fn from(bins: &StoredBins) -> Bins {
        Bins { sums: bins.sums.map(vector_of), counts: bins.counts }
    }
}

impl From<&CoarseLight> for StoredCoarse {
    fn from(coarse: &CoarseLight) -> StoredCoarse {
        let (all, beyond) = ((&coarse.all).into(), (&coarse.beyond).into());
        StoredCoarse { light: (&coarse.light).into(), all, beyond, has_near: coarse.has_near.into() }
    }
}

impl From<&StoredCoarse> for CoarseLight {
    fn from(coarse: &StoredCoarse) -> CoarseLight {
        let (all, beyond) = ((&coarse.all).into(), (&coarse.beyond).into());
        CoarseLight { light: (&coarse.light).into(), all, beyond, has_near: coarse.has_near != 0 }
    }
}

fn vector_of(vector: lightmesh_layout::geometry::Vec3) -> Vec3 {
    Vec3::new(vector.x, vector.y, vector.z)
}
