//! Gathered light of a device in the form of files ([`saved`](super::super::saved)), and back. Numbers are assigned anew, in the order of cells and
//! names.

use bytemuck::{Pod, Zeroable};
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::CELL_INDEX_BITS;
use lightmesh_layout::geometry::Vec3;
use lightmesh_layout::irradiance_cache::{Name, Node, Record};

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::coarse::DeviceCoarse;
use super::device::Device;
use super::fine::DeviceFine;
use super::names::DeviceNames;
use super::{DeviceSurfaceLight, Tables};
use crate::error::RenderError;
use crate::stages::irradiance_cache::cells::CellKey;
use crate::stages::irradiance_cache::saved::{
    SavedCells, SavedLight, SavedNode, SavedPlace, SavedRecord, level_of_key, seed_of,
};

impl<R: Runtime> DeviceSurfaceLight<R> {
    /// All that is known.
    pub(crate) fn saved(&self) -> Result<SavedLight, RenderError> {
        match &self.tables {
            Some(tables) => tables.saved(),
            None => Ok(self.saved.clone().unwrap_or_default()),
        }
    }

    /// What was saved: it is uploaded when it is asked for.
    pub(crate) fn restored(saved: SavedLight) -> DeviceSurfaceLight<R> {
        DeviceSurfaceLight { tables: None, saved: Some(saved) }
    }
}

impl<R: Runtime> Tables<R> {
    fn saved(&self) -> Result<SavedLight, RenderError> {
        Ok(SavedLight {
            fine: self.fine_cells.saved(&self.fine.fine)?,
            coarse: self.coarse_cells.saved(&self.coarse.coarse)?,
            nodes: self.bounce.saved()?,
        })
    }

    pub(super) fn restored(device: &Device<R>, saved: &SavedLight) -> Result<Tables<R>, RenderError> {
        let pool = device.cuda.pool();
        Ok(Tables {
            fine_cells: DeviceCells::restored(device, &saved.fine)?,
            fine: DeviceFine { fine: pool.upload("fine light", &saved.fine.values)? },
            coarse_cells: DeviceCells::restored(device, &saved.coarse)?,
            coarse: DeviceCoarse { coarse: pool.upload("coarse light", &saved.coarse.values)? },
            bounce: DeviceBounce::restored(device, &saved.nodes)?,
        })
    }
}

impl<R: Runtime> DeviceCells<R> {
    fn saved<V: Pod>(&self, values: &Buffer<R, V>) -> Result<SavedCells<V>, RenderError> {
        let names = self.names.read()?;
        let ranges = first_of(&self.ranges, names.len())?;
        let records = first_of(&self.records, self.record_number)?;
        let numbers = first_of(&self.values, self.record_number)?;
        let values = first_of(values, self.value_number)?;
        let mut cells: Vec<(CellKey, u64)> = names.iter().zip(ranges).map(|(name, range)| (name.key, range)).collect();
        cells.sort_unstable();
        let mut saved = SavedCells::default();
        for (key, range) in cells {
            let (first, count) = (range as u32 as usize, (range >> 32) as usize);
            let record = |number: usize| {
                // Numbers of values are stored increased by 1: 0 is none.
                let value = numbers[number].checked_sub(1).map(|value| values[value as usize]);
                (records[number].seed, place_of(&records[number]), value)
            };
            saved.add(key, (first..first + count).map(record));
        }
        Ok(saved)
    }

    fn restored<V>(device: &Device<R>, saved: &SavedCells<V>) -> Result<DeviceCells<R>, RenderError> {
        let (pool, new) = (device.cuda.pool(), DeviceCells::new(device.cuda)?);
        let name = |&(key, _): &(CellKey, u32)| name_of(key, key, 0, 0);
        let mut first = 0;
        let range = |&(_, count): &(CellKey, u32)| {
            let range = u64::from(count) << 32 | first;
            first += u64::from(count);
            range
        };
        let ranges: Vec<u64> = saved.cells.iter().map(range).collect();
        let record = |(key, record): (CellKey, &SavedRecord)| {
            record_at(record.place, level_of_key(key), seed_of(key, record.kind))
        };
        let records: Vec<Record> = saved.records().map(record).collect();
        let is_valued = |(_, record): &(u32, &SavedRecord)| record.has_value;
        let owners: Vec<u32> = (0..).zip(&saved.records).filter(is_valued).map(|(number, _)| number).collect();
        let mut values = vec![0; records.len()];
        (1..).zip(&owners).for_each(|(value, &record)| values[record as usize] = value);
        new.record_count.write(&[records.len() as u32])?;
        new.value_count.write(&[owners.len() as u32])?;
        Ok(DeviceCells {
            names: DeviceNames::restored(device, saved.cells.iter().map(name).collect())?,
            ranges: pool.upload("ranges of records", &ranges)?,
            records: pool.upload("records", &records)?,
            values: pool.upload("values of records", &values)?,
            owners: pool.upload("records of values", &owners)?,
            record_number: records.len(),
            value_number: owners.len(),
            ..new
        })
    }
}

impl<R: Runtime> DeviceBounce<R> {
    fn saved(&self) -> Result<Vec<SavedNode>, RenderError> {
        let names = self.names.read()?;
        let nodes = first_of(&self.nodes, names.len())?;
        let records = first_of(&self.records, names.len())?;
        let node = |((name, node), record): ((&Name, &Node), &Record)| SavedNode {
            name: name.key,
            place: place_of(record),
            covered: node.covered != 0,
            known: node.known as u8,
            values: node.values.map(array_of),
        };
        let all = names.iter().zip(&nodes).zip(&records).map(node);
        let mut saved: Vec<SavedNode> = all.filter(|node| node.known > 0).collect();
        saved.sort_unstable_by_key(|node| node.name);
        Ok(saved)
    }

    /// If more of nodes is asked, their rays are cast again.
    fn restored(device: &Device<R>, saved: &[SavedNode]) -> Result<DeviceBounce<R>, RenderError> {
        let (pool, new) = (device.cuda.pool(), DeviceBounce::new(device.cuda)?);
        let node = |node: &SavedNode| {
            let (values, known) = (node.values.map(Vec3::from), node.known.into());
            Node { values, known, wanted: known, covered: node.covered.into(), ..Node::zeroed() }
        };
        let record = |node: &SavedNode| record_at(node.place, node.level(), node.seed());
        let name = |node: &SavedNode| name_of(node.name, node.cell(), node.kind().into(), node.finer() as u32);
        Ok(DeviceBounce {
            names: DeviceNames::restored(device, saved.iter().map(name).collect())?,
            nodes: pool.upload("nodes", &saved.iter().map(node).collect::<Vec<Node>>())?,
            records: pool.upload("records of nodes", &saved.iter().map(record).collect::<Vec<Record>>())?,
            listed: pool.room("listed nodes", saved.len())?,
            unlinked: pool.room("nodes without links", saved.len())?,
            ..new
        })
    }
}

/// The first `count` values.
fn first_of<R: Runtime, T: Pod>(buffer: &Buffer<R, T>, count: usize) -> Result<Vec<T>, RenderError> {
    let mut values = vec![T::zeroed(); count];
    buffer.read_into(0, &mut values)?;
    Ok(values)
}

/// A name with the index of its cell along each axis.
fn name_of(key: u64, cell: CellKey, kind: u32, finer: u32) -> Name {
    let unused = i32::BITS - CELL_INDEX_BITS;
    // The highest bit of an index is its sign.
    let axis = |axis: u32| ((cell >> (axis * CELL_INDEX_BITS)) as i32) << unused >> unused;
    Name { key, cell: [axis(0), axis(1), axis(2)], level: level_of_key(cell), kind, finer }
}

fn record_at([position, origin, normal]: SavedPlace, level: i32, seed: u64) -> Record {
    Record { position: position.into(), level, origin: origin.into(), normal: normal.into(), seed }
}

fn place_of(record: &Record) -> SavedPlace {
    [record.position, record.origin, record.normal].map(array_of)
}

fn array_of(vector: Vec3) -> [f32; 3] {
    [vector.x, vector.y, vector.z]
}
