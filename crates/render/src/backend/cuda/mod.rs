//! A CUDA device: every stage as kernels, nothing of it on the host.
//!
//! The stages' launches lie beside their CPU twins (`stages/<stage>/cuda.rs` and `kernel.cu`). Here is what they share: the copy of
//! the scene ([`scene`]), launches cut into pieces that no watchdog minds ([`pieces`]), counters, clocks, and the plan of memory.

mod film;
mod materials;
mod memory;
mod mesh;
mod pieces;
mod scan;
mod scene;
mod trait_impl;

use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bytemuck::Pod;
pub(crate) use lightmesh_layout::constants::BLOCK;
use lightmesh_layout::geometry::{Counters, Hit, ListedRay, Rays, Tally, Vec3};

use crate::cuda::{Buffer, Kernel, Launch, Pool, Runtime};
use crate::job::Job;
use crate::{RenderError, Stage, accel};

pub use film::DeviceFilm;
use mesh::DeviceTemplate;
pub(crate) use mesh::sampling;
use pieces::Rates;
pub(crate) use pieces::{Work, slices_of_rays};
pub(crate) use scene::{DeviceScene, kernel_of};

/// Threads of a warp.
pub(crate) const WARP: u32 = 32;

/// A launch of one block of `threads` threads for each unit of a piece of work.
pub(crate) fn blocks_for(piece: &Range<u64>, threads: u32) -> Launch {
    Launch { blocks: (piece.end - piece.start) as u32, threads, shared: 0 }
}

/// A launch of one warp for each unit of a piece of work, `warps` to a block, with `words` 32-bit words of shared memory a warp.
pub(crate) fn warps_for(piece: &Range<u64>, warps: u32, words: u32) -> Launch {
    let blocks = ((piece.end - piece.start) as u32).div_ceil(warps);
    Launch { blocks, threads: warps * WARP, shared: warps * 4 * words }
}

/// A CUDA device, or what stands in for one.
pub struct Cuda<R: Runtime> {
    pool: Pool<R>,
    rates: Rates<R>,
    /// Stages whose time is not read yet.
    spans: Mutex<Vec<Span<R>>>,
    counters: Mutex<Option<Arc<Buffer<R, Counters>>>>,
    /// The template that the device holds.
    template: Mutex<Option<DeviceTemplate<R>>>,
}

/// A stage, and the moments of the queue between which it ran.
type Span<R> = (Stage, <R as Runtime>::Mark, <R as Runtime>::Mark);

/// Rays on a device.
pub struct DeviceRays<R: Runtime> {
    pub(crate) record: Rays,
    /// Holds the list that the record points to.
    pub(crate) list: Option<Buffer<R, ListedRay>>,
}

/// Hits on a device, one a ray.
pub struct DeviceHits<R: Runtime> {
    pub(crate) hits: Buffer<R, Hit>,
}

impl<R: Runtime> DeviceHits<R> {
    /// Reads the hits in the order of the rays: for a camera, y · width + x of the band.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] where the device fails.
    pub fn read(&self) -> Result<Vec<accel::Hit>, RenderError> {
        Ok(bytemuck::cast_vec(self.hits.read()?))
    }
}

/// What object points see of each light, on a device.
pub struct DeviceVisibility<R: Runtime> {
    /// By light, then ray.
    pub(crate) share: Buffer<R, f32>,
    /// Light points used by each ray.
    pub(crate) used: Option<Buffer<R, u32>>,
    /// Light that reaches the eye by each ray, where it was shaded sample by sample.
    pub(crate) direct: Option<Buffer<R, Vec3>>,
}

impl<R: Runtime> Cuda<R> {
    /// A backend on a device.
    pub fn new(runtime: Arc<R>) -> Cuda<R> {
        Cuda {
            pool: Pool::new(runtime),
            rates: Rates::default(),
            spans: Mutex::default(),
            counters: Mutex::default(),
            template: Mutex::default(),
        }
    }

    /// Memory.
    pub(crate) fn pool(&self) -> &Pool<R> {
        &self.pool
    }

    /// Launches a kernel once.
    pub(crate) fn launch<A: Pod>(&self, kernel: Kernel, launch: Launch, arguments: &A) -> Result<(), RenderError> {
        let result = self.pool.runtime().launch(kernel, launch, bytemuck::bytes_of(arguments));
        result.map_err(|fault| self.pool.fault(fault))
    }

    /// A moment in the device's queue.
    fn mark(&self) -> Result<R::Mark, RenderError> {
        self.pool.runtime().mark().map_err(|fault| self.pool.fault(fault))
    }

    /// Where kernels count.
    pub(crate) fn tally(&self) -> Result<Tally, RenderError> {
        Ok(Tally { shards: self.counters()?.output() })
    }

    fn counters(&self) -> Result<Arc<Buffer<R, Counters>>, RenderError> {
        let mut counters = locked(&self.counters);
        if let Some(counters) = &*counters {
            return Ok(Arc::clone(counters));
        }
        let fresh = Arc::new(self.pool.zeros("counters", Tally::SHARDS)?);
        Ok(Arc::clone(counters.insert(fresh)))
    }

    /// Sets the counters to zero and forgets times that were not read: a band begins.
    fn begin_band(&self) -> Result<(), RenderError> {
        locked(&self.spans).clear();
        self.rates.forget_pending();
        self.counters()?.clear()
    }

    /// Reads counters and clocks: a band is done.
    fn end_band(&self, job: &Job) -> Result<(), RenderError> {
        add_counts(job, &self.counters()?.read()?);
        for (stage, from, to) in locked(&self.spans).drain(..) {
            let seconds = self.pool.runtime().seconds(&from, &to).map_err(|fault| self.pool.fault(fault))?;
            job.add_seconds(stage, seconds);
        }
        self.rates.settle(&self.pool)
    }
}

/// Adds what all shards counted.
fn add_counts(job: &Job, shards: &[Counters]) {
    use crate::job::Tally;
    let tally = &job.tally;
    let sum = |count: fn(&Counters) -> u64| shards.iter().map(count).sum::<u64>();
    let (half_ball, tested) = (sum(|shard| shard.half_ball), sum(|shard| shard.short_tests));
    Tally::add(&tally.object_points, sum(|shard| shard.object_points));
    Tally::add(&tally.half_ball, half_ball);
    Tally::add(&tally.used, sum(|shard| shard.used));
    Tally::add(&tally.short_tests, tested);
    Tally::add(&tally.short_tests_culled, half_ball - tested);
    Tally::add(&tally.fallbacks, sum(|shard| shard.fallbacks));
    Tally::add(&tally.shadow_rays, sum(|shard| shard.shadow_rays));
    Tally::add(&tally.hits, sum(|shard| shard.hits));
}

impl<R: Runtime> DeviceVisibility<R> {
    /// Reads the shares, by light, then ray.
    ///
    /// # Errors
    /// [`RenderError::DeviceFault`] where the device fails.
    pub fn read(&self) -> Result<Vec<f32>, RenderError> {
        self.share.read()
    }
}

impl<R: Runtime> DeviceRays<R> {
    /// Rays from the camera, not from mirrors.
    pub(crate) fn is_from_camera(&self) -> bool {
        self.list.is_none()
    }

    /// Number of rays.
    pub(crate) fn len(&self) -> usize {
        self.record.count as usize
    }

    /// Blocks of `edge`² threads that take one ray a thread: tiles of a camera's rows, runs of a list.
    pub(crate) fn blocks(&self, edge: u32) -> u64 {
        if !self.is_from_camera() {
            return u64::from(self.record.count.div_ceil(edge * edge));
        }
        let width = self.record.view.size[0];
        let rows = self.record.count / width;
        u64::from(width.div_ceil(edge)) * u64::from(rows.div_ceil(edge))
    }
}

pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
