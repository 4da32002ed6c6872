//! Copies within a device's memory, and buffers that grow.

use bytemuck::Pod;
use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::constants::BLOCK;
use lightmesh_layout::stages::Copy;
use lightmesh_layout::{In, Out};

use super::device::{Cuda, blocks_for};
use crate::error::RenderError;

const COPY: Kernel = Kernel { module: "copy", name: "copy_words" };

impl<R: Runtime> Cuda<R> {
    /// Copies the first `count` values of a buffer to another one.
    pub(crate) fn copy<T: Pod>(&self, from: &Buffer<R, T>, to: &Buffer<R, T>, count: usize) -> Result<(), RenderError> {
        const { assert!(size_of::<T>().is_multiple_of(size_of::<u32>()), "whole words") };
        debug_assert!(count <= from.len() && count <= to.len());
        let words = (count * size_of::<T>() / size_of::<u32>()) as u64;
        let (from, to) = (In::to(from.input().address()), Out::to(to.output().address()));
        match words.div_ceil(u64::from(BLOCK)) {
            0 => Ok(()),
            blocks => self.launch(COPY, blocks_for(&(0..blocks), BLOCK), &Copy { from, to, count: words }),
        }
    }

    /// Makes room for `len` values, of which the first `used` stay and the new ones are zero. It at least doubles, if at all.
    pub(crate) fn extend<T: Pod>(
        &self,
        buffer: &mut Buffer<R, T>,
        what: &'static str,
        used: usize,
        len: usize,
    ) -> Result<(), RenderError> {
        if len <= buffer.len() {
            return Ok(());
        }
        let larger = self.pool().zeros(what, len.max(2 * buffer.len()))?;
        self.copy(buffer, &larger, used)?;
        *buffer = larger;
        Ok(())
    }
}
