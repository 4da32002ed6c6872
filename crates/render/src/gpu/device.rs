//! A CUDA device: memory, launches, counters and clocks.

use std::ops::Range;
use std::sync::{Arc, Mutex};

use bytemuck::Pod;
use lightmesh_kernels::{Buffer, Kernel, Launch, Pool, Runtime};
use lightmesh_layout::constants::WARP;
use lightmesh_layout::counters::Counters;
use lightmesh_layout::geometry::Tally;
use lightmesh_scene::Environment;

use super::rates::Rates;
use super::resident::{DeviceEnvironment, DeviceGeometry, DeviceTemplate, DeviceTextures, Resident};
use crate::error::RenderError;
use crate::prepared::PreparedGeometry;
use crate::render_context::RenderContext;
use crate::stage::Stage;
use crate::sync::locked;
use crate::textures::AllLevels;

/// A launch with one block of `threads` threads for each unit of a piece of work.
pub(crate) fn blocks_for(piece: &Range<u64>, threads: u32) -> Launch {
    Launch { blocks: (piece.end - piece.start) as u32, threads, shared: 0 }
}

/// A launch with one warp for each unit of a piece of work, `warps` per block, with `words` 32-bit words of shared memory per
/// warp.
pub(crate) fn warps_for(piece: &Range<u64>, warps: u32, words: u32) -> Launch {
    let blocks = ((piece.end - piece.start) as u32).div_ceil(warps);
    Launch { blocks, threads: warps * WARP, shared: warps * 4 * words }
}

/// A CUDA device, or a substitute for one.
pub struct Cuda<R: Runtime> {
    pub(super) pool: Pool<R>,
    pub(super) rates: Rates<R>,
    /// Stages whose time has not been read yet.
    spans: Mutex<Vec<Span<R>>>,
    counters: Mutex<Option<Arc<Buffer<R, Counters>>>>,
    /// The template that the device currently holds.
    pub(super) template: Mutex<Option<DeviceTemplate<R>>>,
    /// The geometry that the device currently holds.
    pub(super) resident: Mutex<Resident<PreparedGeometry, DeviceGeometry<R>>>,
    /// The textures that the device currently holds, by their smaller levels: geometries of which only places differ share these.
    pub(super) textures: Mutex<Resident<AllLevels, DeviceTextures<R>>>,
    /// The environments that the device currently holds.
    pub(super) environments: Mutex<Resident<Environment, DeviceEnvironment<R>>>,
}

/// A stage, and the points in the queue between which it ran.
type Span<R> = (Stage, <R as Runtime>::Mark, <R as Runtime>::Mark);

impl<R: Runtime> Cuda<R> {
    /// A backend on a device.
    pub fn new(runtime: Arc<R>) -> Cuda<R> {
        Cuda {
            pool: Pool::new(runtime),
            rates: Rates::default(),
            spans: Mutex::default(),
            counters: Mutex::default(),
            template: Mutex::default(),
            resident: Mutex::default(),
            textures: Mutex::default(),
            environments: Mutex::default(),
        }
    }

    /// The memory pool.
    pub(crate) fn pool(&self) -> &Pool<R> {
        &self.pool
    }

    /// Launches a kernel once.
    pub(crate) fn launch<A: Pod>(&self, kernel: Kernel, launch: Launch, arguments: &A) -> Result<(), RenderError> {
        let result = self.pool.runtime().launch(kernel, launch, bytemuck::bytes_of(arguments));
        result.map_err(|fault| self.pool.fault(fault).into())
    }

    /// A point in the device's queue.
    pub(super) fn mark(&self) -> Result<R::Mark, RenderError> {
        self.pool.runtime().mark().map_err(|fault| self.pool.fault(fault).into())
    }

    /// The counters that kernels add to.
    pub(crate) fn tally(&self) -> Result<Tally, RenderError> {
        Ok(Tally { shards: self.counters()?.output() })
    }

    fn counters(&self) -> Result<Arc<Buffer<R, Counters>>, RenderError> {
        let mut counters = locked(&self.counters);
        if let Some(counters) = &*counters {
            return Ok(Arc::clone(counters));
        }
        let fresh = Arc::new(self.pool.zeros("counters", Tally::SHARDS as usize)?);
        Ok(Arc::clone(counters.insert(fresh)))
    }

    /// Clears the counters and discards times that were not read, at the start of a band.
    pub(crate) fn begin_band(&self) -> Result<(), RenderError> {
        locked(&self.spans).clear();
        self.rates.forget_pending();
        Ok(self.counters()?.clear()?)
    }

    /// Runs a stage between two marks of the device's clock; the time is read when the band is finished.
    pub(crate) fn on_device_clock<T>(
        &self,
        stage: Stage,
        work: impl FnOnce() -> Result<T, RenderError>,
    ) -> Result<T, RenderError> {
        let from = self.mark()?;
        let result = work()?;
        let to = self.mark()?;
        locked(&self.spans).push((stage, from, to));
        Ok(result)
    }

    /// Reads counters and clocks at the end of a band.
    pub(crate) fn end_band(&self, context: &RenderContext) -> Result<(), RenderError> {
        let counted = sum_of(&self.counters()?.read()?);
        // Kernels count the tests that they perform; the rest was decided without a test.
        let short_tests_culled = counted.half_ball - counted.short_tests;
        context.tally.add_all(&Counters { short_tests_culled, ..counted });
        for (stage, from, to) in locked(&self.spans).drain(..) {
            let seconds = self.pool.runtime().seconds(&from, &to).map_err(|fault| self.pool.fault(fault))?;
            context.add_seconds(stage, seconds);
        }
        self.rates.settle(&self.pool)
    }
}

/// The sum over all shards.
fn sum_of(shards: &[Counters]) -> Counters {
    let mut sums: Counters = bytemuck::Zeroable::zeroed();
    let words = bytemuck::cast_slice_mut::<Counters, u64>(std::slice::from_mut(&mut sums));
    for shard in shards {
        for (sum, count) in words.iter_mut().zip(bytemuck::cast_slice::<Counters, u64>(std::slice::from_ref(shard))) {
            *sum += count;
        }
    }
    sums
}
