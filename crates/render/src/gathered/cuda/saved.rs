//! Gathered light of a device in the form of files ([`saved`](super::super::saved)), and back. Numbers are assigned anew, in the order of cells and
//! names.

use bytemuck::{Pod, Zeroable};
use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::constants::CELL_INDEX_BITS;
use lightmesh_layout::gathered::{Name, Node, Site};
use lightmesh_layout::geometry::Vec3;

use super::bounce::DeviceBounce;
use super::cells::DeviceCells;
use super::device::Device;
use super::far::DeviceFar;
use super::fine::DeviceFine;
use super::names::DeviceNames;
use super::{DeviceSurfaceLight, Kept};
use crate::error::RenderError;
use crate::gathered::cells::CellKey;
use crate::gathered::saved::{SavedCells, SavedLight, SavedNode, SavedPlace, SavedSite, level_of_key, seed_of};

impl<R: Runtime> DeviceSurfaceLight<R> {
    /// All that is known.
    pub(crate) fn saved(&self) -> Result<SavedLight, RenderError> {
        match &self.kept {
            Some(kept) => kept.saved(),
            None => Ok(self.saved.clone().unwrap_or_default()),
        }
    }

    /// What was saved: it is uploaded when it is asked for.
    pub(crate) fn restored(saved: SavedLight) -> DeviceSurfaceLight<R> {
        DeviceSurfaceLight { kept: None, saved: Some(saved) }
    }
}

impl<R: Runtime> Kept<R> {
    fn saved(&self) -> Result<SavedLight, RenderError> {
        Ok(SavedLight {
            fine: self.fine_cells.saved(&self.fine.fine)?,
            far: self.far_cells.saved(&self.far.far)?,
            nodes: self.bounce.saved()?,
        })
    }

    pub(super) fn restored(device: &Device<R>, saved: &SavedLight) -> Result<Kept<R>, RenderError> {
        let pool = device.cuda.pool();
        Ok(Kept {
            fine_cells: DeviceCells::restored(device, &saved.fine)?,
            fine: DeviceFine { fine: pool.upload("fine light", &saved.fine.values)? },
            far_cells: DeviceCells::restored(device, &saved.far)?,
            far: DeviceFar { far: pool.upload("far light", &saved.far.values)? },
            bounce: DeviceBounce::restored(device, &saved.nodes)?,
        })
    }
}

impl<R: Runtime> DeviceCells<R> {
    fn saved<V: Pod>(&self, values: &Buffer<R, V>) -> Result<SavedCells<V>, RenderError> {
        let names = self.names.read()?;
        let ranges = first_of(&self.ranges, names.len())?;
        let sites = first_of(&self.sites, self.site_number)?;
        let numbers = first_of(&self.values, self.site_number)?;
        let values = first_of(values, self.value_number)?;
        let mut cells: Vec<(CellKey, u64)> = names.iter().zip(ranges).map(|(name, range)| (name.key, range)).collect();
        cells.sort_unstable();
        let mut saved = SavedCells::default();
        for (key, range) in cells {
            let (first, count) = (range as u32 as usize, (range >> 32) as usize);
            let site = |number: usize| {
                // Numbers of values are stored increased by 1: 0 is none.
                let value = numbers[number].checked_sub(1).map(|value| values[value as usize]);
                (sites[number].seed, place_of(&sites[number]), value)
            };
            saved.add(key, (first..first + count).map(site));
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
        let site = |(key, site): (CellKey, &SavedSite)| site_at(site.place, level_of_key(key), seed_of(key, site.kind));
        let sites: Vec<Site> = saved.sites().map(site).collect();
        let is_valued = |(_, site): &(u32, &SavedSite)| site.has_value;
        let owners: Vec<u32> = (0..).zip(&saved.sites).filter(is_valued).map(|(number, _)| number).collect();
        let mut values = vec![0; sites.len()];
        (1..).zip(&owners).for_each(|(value, &site)| values[site as usize] = value);
        new.site_count.write(&[sites.len() as u32])?;
        new.value_count.write(&[owners.len() as u32])?;
        Ok(DeviceCells {
            names: DeviceNames::restored(device, saved.cells.iter().map(name).collect())?,
            ranges: pool.upload("ranges of sites", &ranges)?,
            sites: pool.upload("sites", &sites)?,
            values: pool.upload("values of sites", &values)?,
            owners: pool.upload("sites of values", &owners)?,
            site_number: sites.len(),
            value_number: owners.len(),
            ..new
        })
    }
}

impl<R: Runtime> DeviceBounce<R> {
    fn saved(&self) -> Result<Vec<SavedNode>, RenderError> {
        let names = self.names.read()?;
        let nodes = first_of(&self.nodes, names.len())?;
        let sites = first_of(&self.sites, names.len())?;
        let node = |((name, node), site): ((&Name, &Node), &Site)| SavedNode {
            name: name.key,
            place: place_of(site),
            covered: node.covered != 0,
            known: node.known as u8,
            values: node.values.map(array_of),
        };
        let all = names.iter().zip(&nodes).zip(&sites).map(node);
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
        let site = |node: &SavedNode| site_at(node.place, node.level(), node.seed());
        let name = |node: &SavedNode| name_of(node.name, node.cell(), node.kind().into(), node.finer() as u32);
        Ok(DeviceBounce {
            names: DeviceNames::restored(device, saved.iter().map(name).collect())?,
            nodes: pool.upload("nodes", &saved.iter().map(node).collect::<Vec<Node>>())?,
            sites: pool.upload("sites of nodes", &saved.iter().map(site).collect::<Vec<Site>>())?,
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

fn site_at([position, origin, normal]: SavedPlace, level: i32, seed: u64) -> Site {
    Site { position: position.into(), level, origin: origin.into(), normal: normal.into(), seed }
}

fn place_of(site: &Site) -> SavedPlace {
    [site.position, site.origin, site.normal].map(array_of)
}

fn array_of(vector: Vec3) -> [f32; 3] {
    [vector.x, vector.y, vector.z]
}
