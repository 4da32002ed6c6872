//! How many rows of an image fit into the host's memory at once.

use lightmesh_memory::OverBudget;
use lightmesh_trace::accel::{Hit, Ray};

use crate::error::RenderError;
use crate::footprint::Cone;
use crate::plan::Plan;
use crate::settings::SettingSet;
use crate::stages::irradiance_cache::Gathering;

/// Memory reserved for everything that is not counted below: stacks, the segments in flight, allocator overhead.
pub const RESERVE: u64 = 32 << 20;

/// Parts of an image whose finished rows may be asked for at any time.
const PARTS: u32 = 32;
/// Fewer rows in a part would mostly repeat those around it.
const MIN_ROWS: u32 = 8;

/// Most rows to render at once if the finished ones may be asked for at any time.
pub fn rows_in_parts(height: u32) -> u32 {
    height.div_ceil(PARTS).max(MIN_ROWS)
}

/// Rejects an image that does not fit into the host's memory, before any of it is allocated.
pub fn check_picture(plan: &Plan) -> Result<(), RenderError> {
    fits(plan, "the image and its layers", plan.image_bytes())
}

/// Number of rows that can be rendered at once on the host, besides the image. Rejects an image that leaves no room for any.
///
/// The estimate is an upper bound per pixel, taken at the stage that holds most; see the sum.
pub fn rows_on_host(plan: &Plan) -> Result<u32, RenderError> {
    let pixel = plan.rays_per_pixel() * bytes_per_ray(plan) + plan.sample_bytes() + plan.film_bytes();
    let row = u64::from(plan.size[0]) * pixel;
    // The rows around a band are rendered with it.
    let fixed = plan.image_bytes() + RESERVE + plan.reserved + plan.margin_rows() * row;
    fits(plan, "the image, and masks and visibility of one row", fixed + row)?;
    let fixed = fixed + plan.gathering.as_ref().map_or(0, Gathering::memory);
    fits(plan, "the image, one row of it, and what gathers light", fixed + row)?;
    let rows = plan.left.map_or(u64::MAX, |left| (left - fixed) / row);
    Ok(rows.min(u64::from(plan.size[1])) as u32)
}

fn fits(plan: &Plan, buffer: &'static str, needed: u64) -> Result<(), RenderError> {
    match plan.left.filter(|left| needed > *left) {
        Some(left) => Err(RenderError::Memory {
            buffer,
            short: OverBudget { needed, left, limit: plan.memory_limit },
            helps: SettingSet::default(),
        }),
        None => Ok(()),
    }
}

fn bytes_per_ray(plan: &Plan) -> u64 {
    // A ray with pixel, weight and cone, twice (mirrors make the next list from this one), and its hit and radiance.
    let ray = 2 * (size_of::<Ray>() as u64 + 4 + 12 + size_of::<Cone>() as u64) + size_of::<Hit>() as u64 + 12;
    ray + plan.bytes_per_ray.host
}
