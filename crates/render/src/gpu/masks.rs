//! Masks of formula (2) on a device, transposed.

use lightmesh_kernels::{Buffer, Runtime};

use super::cells::DeviceCells;
use crate::error::RenderError;

/// The masks of all surface points on a device, transposed: 32 · words words for each bundle.
pub struct DeviceMasks<R: Runtime> {
    pub(crate) masks: Buffer<R, u32>,
    pub(crate) words: usize,
}

impl<R: Runtime> DeviceMasks<R> {
    /// Reads the masks: the cell and the mask of each ray that has a surface point, ordered by ray.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] if the device fails.
    pub fn read(&self, cells: &DeviceCells<R>) -> Result<Vec<(u32, u64, Vec<u32>)>, RenderError> {
        let (members, bundles, masks) = (cells.members.read()?, cells.bundles.read()?, self.masks.read()?);
        let mut found = Vec::new();
        for (bundle, columns) in bundles.iter().zip(masks.chunks_exact(32 * self.words)) {
            for lane in 0..bundle.count {
                let bit = |k: usize| columns[k] >> lane & 1;
                let word = |word: usize| (0..32).map(|k| bit(32 * word + k) << k).sum();
                let mask = (0..self.words).map(word).collect();
                found.push((members[(bundle.first + lane) as usize], bundle.cell, mask));
            }
        }
        found.sort_unstable_by_key(|(ray, ..)| *ray);
        Ok(found)
    }
}
