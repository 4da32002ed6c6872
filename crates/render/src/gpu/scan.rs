//! Exclusive prefix sums on the device.

use lightmesh_kernels::{Buffer, Kernel, Runtime};
use lightmesh_layout::constants::{BLOCK, VALUES_OF_THREAD};
use lightmesh_layout::stages::Scan;

use super::device::{Cuda, blocks_for};
use crate::error::RenderError;

/// Number of values that one block scans.
const VALUES: usize = (BLOCK * VALUES_OF_THREAD) as usize;

impl<R: Runtime> Cuda<R> {
    /// Replaces each value by the sum of all before it.
    pub(crate) fn scan(&self, values: &Buffer<R, u32>) -> Result<(), RenderError> {
        let blocks = values.len().div_ceil(VALUES);
        if blocks == 0 {
            return Ok(());
        }
        let sums = self.pool.room("sums of a scan", blocks)?;
        let arguments = Scan { values: values.output(), sums: sums.output(), count: values.len() as u64 };
        let launch = blocks_for(&(0..blocks as u64), BLOCK);
        self.launch(Kernel { module: "scan", name: "scan_blocks" }, launch, &arguments)?;
        if blocks > 1 {
            self.scan(&sums)?;
            self.launch(Kernel { module: "scan", name: "add_offsets" }, launch, &arguments)?;
        }
        Ok(())
    }

    /// The same for values with one extra element at the end, whose content is ignored: it receives the sum of all, which is
    /// returned. Waits for the device.
    pub(crate) fn scan_total(&self, values: &Buffer<R, u32>) -> Result<usize, RenderError> {
        self.scan_totals([values]).map(|[total]| total)
    }

    /// The same for several buffers: the device is waited for once.
    pub(crate) fn scan_totals<const N: usize>(&self, all: [&Buffer<R, u32>; N]) -> Result<[usize; N], RenderError> {
        for values in all {
            values.clear_last()?;
            self.scan(values)?;
        }
        let mut totals = [0; N];
        for (values, place) in all.into_iter().zip(&mut totals) {
            let mut total = [0];
            values.read_into(values.len() - 1, &mut total)?;
            *place = total[0] as usize;
        }
        Ok(totals)
    }
}
