//! How many rows of an image fit into the host's memory at once.

use crate::accel::{Hit, Ray};
use crate::error::RenderError;
use crate::memory;
use crate::plan::Plan;
use crate::prepared::PreparedScene;

/// Memory reserved for everything that is not counted below: stacks, the segments in flight, allocator overhead.
const RESERVE: u64 = 64 << 20;

/// Rejects an image that does not fit into the host's memory, before any of it is allocated.
pub(crate) fn check_picture(plan: &Plan) -> Result<(), RenderError> {
    fits(plan, memory::available())
}

fn fits(plan: &Plan, available: Option<u64>) -> Result<(), RenderError> {
    let needed = plan.pixels() * plan.film_bytes();
    match available.filter(|available| needed > *available) {
        Some(limit) => Err(RenderError::Memory { buffer: "the image and its layers", needed, limit }),
        None => Ok(()),
    }
}

/// Number of rows that can be rendered at once on the host.
pub(crate) fn rows_on_host(scene: &PreparedScene, plan: &Plan) -> Result<u32, RenderError> {
    let picture = plan.pixels() * plan.film_bytes();
    match plan.memory_limit {
        // The limit applies to the process: what it already holds counts.
        Some(limit) => rows_per_band(plan, scene.geometry.memory() as u64 + plan.kept + picture, Some(limit)),
        None => rows_per_band(plan, picture, memory::available().map(|bytes| bytes - bytes / 8)),
    }
}

/// Number of rows that fit under `limit` bytes in addition to the `resident` bytes of scene and image.
///
/// The estimate is an upper bound per pixel, taken at the stage that holds most; see the sum.
fn rows_per_band(plan: &Plan, resident: u64, limit: Option<u64>) -> Result<u32, RenderError> {
    let size = plan.size;
    let Some(limit) = limit else { return Ok(size[1]) };
    let row = u64::from(size[0]) * (bytes_per_ray(plan) + plan.film_bytes());
    let free = limit.saturating_sub(resident).saturating_sub(RESERVE);
    match free / row {
        0 => Err(RenderError::Memory {
            buffer: "the scene, the image, and masks and visibility of one row",
            needed: row + resident + RESERVE,
            limit,
        }),
        rows => Ok(rows.min(u64::from(size[1])) as u32),
    }
}

fn bytes_per_ray(plan: &Plan) -> u64 {
    // A ray with pixel and weight, twice (mirrors make the next list from this one), and its hit and radiance.
    let ray = 2 * (size_of::<Ray>() as u64 + 4 + 12) + size_of::<Hit>() as u64 + 12;
    ray + plan.footprint.host
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::lights::LightGroups;
    use crate::plan::Footprint;

    #[test]
    fn an_image_that_does_not_fit_is_refused_before_it_is_made() {
        let lights = LightGroups { lights: 3, at_once: 3 };
        let plan = |side, layers| Plan {
            size: [side; 2],
            bounces: 0,
            layers,
            lights,
            memory_limit: None,
            kept: 0,
            footprint: Footprint::default(),
        };
        let needed = |side, layers| match fits(&plan(side, layers), Some(1 << 20)) {
            Err(RenderError::Memory { needed, limit, .. }) if limit == 1 << 20 => needed,
            found => panic!("{found:?}"),
        };
        assert_eq!(needed(60_000, None), 43_200_000_000);
        assert_eq!(needed(256, Some(3)), 65_536 * (12 + 32 + 12));
        assert!(fits(&plan(256, None), Some(1 << 20)).is_ok());
    }

    #[test]
    fn a_limit_splits_the_picture_and_none_does_not() {
        let footprint = Footprint::default();
        let lights = LightGroups { lights: 3, at_once: 3 };
        let plan =
            Plan { size: [1000, 1000], bounces: 0, layers: None, lights, memory_limit: None, kept: 0, footprint };
        let rows = |limit| rows_per_band(&plan, 0, limit);
        assert_eq!(rows(None).unwrap(), 1000);
        assert_eq!(rows(Some(u64::MAX)).unwrap(), 1000);
        let some = rows(Some(RESERVE + (20 << 20))).unwrap();
        assert!((1..1000).contains(&some), "{some}");
        assert!(matches!(rows(Some(RESERVE + 1)), Err(RenderError::Memory { .. })));
    }
}
