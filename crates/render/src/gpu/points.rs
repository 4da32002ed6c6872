//! The used light points of an image on a device.

use std::sync::Arc;

use lightmesh_kernels::{Buffer, Runtime};
use lightmesh_layout::mesh::{BrickTable, UsedPoints};

use crate::error::RenderError;
use crate::light_mesh::BrickKey;

/// The used light points of an image on a device.
pub struct DevicePoints<R: Runtime> {
    pub(crate) keys: Arc<Buffer<R, u64>>,
    pub(crate) used: Buffer<R, u64>,
    pub(crate) rank: Buffer<R, u32>,
    pub(crate) points: Buffer<R, u64>,
    /// The slot of each brick of the window around each bundle's cell that has used points.
    pub(crate) slots: Arc<Buffer<R, u32>>,
    /// S_total.
    pub(crate) count: usize,
}

impl<R: Runtime> DevicePoints<R> {
    /// Number of slots of the table.
    pub(crate) fn capacity(&self) -> usize {
        self.keys.len()
    }

    /// The record with all addresses.
    pub(crate) fn record(&self) -> UsedPoints {
        UsedPoints {
            table: BrickTable { keys: self.keys.output(), capacity: self.keys.len() as u32, spare: 0 },
            used: self.used.input(),
            rank: self.rank.input(),
            points: self.points.input(),
        }
    }

    /// Reads the bricks that contain used points: slot, key and used points of each.
    pub fn read_bricks(&self) -> Result<Vec<(usize, BrickKey, u64)>, RenderError> {
        let (keys, used) = (self.keys.read()?, self.used.read()?);
        let slots = keys.into_iter().zip(used).enumerate();
        Ok(slots.filter(|(_, (key, _))| *key != 0).map(|(slot, (key, used))| (slot, key - 1, used)).collect())
    }

    /// Reads the rank of the first used point of each slot.
    pub fn read_ranks(&self) -> Result<Vec<u32>, RenderError> {
        Ok(self.rank.read()?)
    }
}
