//! The memory plan: the size of every buffer, before the first is allocated.
//!
//! It gives the buffers per pixel at the stage that needs most, and how many rows fit into the memory that is free or allowed. The numbers of
//! light points and bundles are estimates there. If an image has more, an allocation fails or would exceed the limit; the band is then restarted
//! with half of its rows (`passes.rs`). At one row the error names buffer, size and free memory. Bands are bit-identical to the whole
//! image. If memory is short although the plan fits, cached light points are dropped first (`backend/run.rs`).

use lightmesh_kernels::Runtime;
use lightmesh_layout::geometry::{Cone, Hit, ListedRay, Vec3};
use lightmesh_layout::mesh::Bundle;

use super::device::Cuda;
use crate::error::RenderError;
use crate::plan::Plan;
use crate::settings::SettingSet;
use crate::stages::irradiance_cache::cuda;

/// Expected number of surface points per bundle: a cell's points fill warps of 32, and cells are cut at the borders of tiles.
const POINTS_PER_BUNDLE: u64 = 8;
/// One part in this many of the free memory is left to others.
const RESERVE: u64 = 16;

impl<R: Runtime> Cuda<R> {
    /// Number of rows that fit into free memory, or under the limit, in addition to the scene.
    ///
    /// The estimate of light points and bundles is an expectation. If an image has more, allocation fails and the band is
    /// restarted with half of its rows.
    pub(crate) fn rows_that_fit(&self, plan: &Plan) -> Result<u32, RenderError> {
        let fixed = plan.reserved + if plan.gathering.is_some() { cuda::memory_at_once() } else { 0 };
        let free = self.memory_left().map(|free| free.saturating_sub(fixed));
        let Some(free) = free else { return Ok(plan.size[1]) };
        let row = u64::from(plan.size[0]) * bytes_per_pixel(plan);
        match free / row {
            rows if rows <= plan.margin_rows() => Err(RenderError::DeviceMemory {
                device: self.pool.runtime().name(),
                buffer: "one row of the image",
                needed: row * (plan.margin_rows() + 1),
                free: Some(free),
                helps: SettingSet::default(),
            }),
            rows => Ok((rows - plan.margin_rows()).min(u64::from(plan.size[1])) as u32),
        }
    }
}

impl<R: Runtime> Cuda<R> {
    /// Bytes that may still be allocated, but for a reserve; `None` if that is not known.
    pub(crate) fn memory_left(&self) -> Option<u64> {
        let free = self.pool.runtime().free_memory().map(|free| free - free / RESERVE);
        let allowed = self.pool.left();
        free.map_or(allowed, |free| Some(allowed.map_or(free, |allowed| free.min(allowed))))
    }
}

/// Bytes per pixel when memory use is highest.
fn bytes_per_pixel(plan: &Plan) -> u64 {
    // With more than one group of lights, mirror rays have sums of their own; all rays may if lights are told apart.
    let sum = if plan.lights.iter().len() > 1 || plan.compositing { size_of::<Vec3>() as u64 } else { 0 };
    let several = plan.antialiasing.is_some();
    let listed = if plan.bounces > 0 || several { 2 * size_of::<ListedRay>() as u64 } else { 0 };
    // Mirror rays with textures to be filtered.
    let cones = if plan.bounces > 0 && several { 2 * size_of::<Cone>() as u64 } else { 0 };
    let sum = if several {
        size_of::<Vec3>() as u64
    } else if plan.bounces > 0 || plan.compositing {
        sum
    } else {
        0
    };
    let ray = listed + cones + sum + size_of::<Hit>() as u64 + plan.bytes_per_ray.device;
    plan.film_bytes() + plan.sample_bytes() + plan.rays_per_pixel() * ray
}

/// What the light mesh method adds per ray, for a template with masks of `words` words and `bricks` bricks around a cell.
pub(crate) fn bytes_of_light_mesh(words: usize, bricks: usize, lights: u64) -> u64 {
    // Members and bundles of tiles; bundles with their masks, and the used points and slots of the bricks around them.
    let grouping = 4 + size_of::<Bundle>() as u64;
    let bundles = (size_of::<Bundle>() + 32 * 4 * words + (8 + 4) * bricks) as u64 / POINTS_PER_BUNDLE;
    // Half a light point per pixel: its entry and share, and its part of a brick that is a quarter full.
    let points = (8 + 2 * lights + 2 * (8 + 8 + 4 + 8 * lights) / 16) / 2;
    // Shares, light points used, and the list of rays that fall back.
    grouping + bundles + points + 4 * lights + 4 + 4
}
