//! How many rows of an image fit into the host's memory at once.

use lightmesh_memory::Short;

use crate::accel::{Hit, Ray};
use crate::error::RenderError;
use crate::footprint::Cone;
use crate::gathered::Gathering;
use crate::plan::Plan;

/// Memory reserved for everything that is not counted below: stacks, the segments in flight, allocator overhead.
const RESERVE: u64 = 32 << 20;

/// Parts of an image whose finished rows may be asked for at any time.
const PARTS: u32 = 32;
/// Fewer rows in a part would mostly repeat those around it.
const LEAST_ROWS: u32 = 8;

/// Most rows to render at once if the finished ones may be asked for at any time.
pub(crate) fn rows_in_parts(height: u32) -> u32 {
    height.div_ceil(PARTS).max(LEAST_ROWS)
}

/// Rejects an image that does not fit into the host's memory, before any of it is allocated.
pub(crate) fn check_picture(plan: &Plan) -> Result<(), RenderError> {
    fits(plan, "the image and its layers", plan.image_bytes())
}

/// Number of rows that can be rendered at once on the host, besides the image. Rejects an image that leaves no room for any.
///
/// The estimate is an upper bound per pixel, taken at the stage that holds most; see the sum.
pub(crate) fn rows_on_host(plan: &Plan) -> Result<u32, RenderError> {
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
        Some(left) => Err(RenderError::Memory { buffer, short: Short { needed, left, limit: plan.memory_limit } }),
        None => Ok(()),
    }
}

fn bytes_per_ray(plan: &Plan) -> u64 {
    // A ray with pixel, weight and cone, twice (mirrors make the next list from this one), and its hit and radiance.
    let ray = 2 * (size_of::<Ray>() as u64 + 4 + 12 + size_of::<Cone>() as u64) + size_of::<Hit>() as u64 + 12;
    ray + plan.footprint.host
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::antialiasing::Antialiasing;
    use crate::data::lights::LightGroups;
    use crate::settings::Filter;

    fn plan(size: [u32; 2], layers: Option<usize>, left: Option<u64>) -> Plan {
        let lights = LightGroups { lights: 3, at_once: 3 };
        Plan { layers, ..Plan::plain(size, lights, left) }
    }

    #[test]
    fn an_image_that_does_not_fit_is_refused_before_it_is_made() {
        let needed = |side, layers| match check_picture(&plan([side; 2], layers, Some(1 << 20))) {
            Err(RenderError::Memory { short: Short { needed, left: 0x10_0000, limit: Some(0x10_0000) }, .. }) => needed,
            found => panic!("{found:?}"),
        };
        assert_eq!(needed(60_000, None), 43_200_000_000);
        assert_eq!(needed(256, Some(3)), 65_536 * (12 + 32 + 12));
        assert!(check_picture(&plan([256; 2], None, Some(1 << 20))).is_ok());
        // Colours of three lights and of none; of objects and of materials a number and a rank, or six ranks and eight slots.
        let all = |antialiasing| Plan { antialiasing, compositing: true, ..plan([256; 2], Some(3), None) };
        let several = Antialiasing::new(16, Filter::Box, 0, 1);
        assert_eq!(all(None).film_bytes(), 12 + 32 + 12 + 48 + 2 * (4 + 8));
        assert_eq!(all(Some(several)).film_bytes(), 12 + 32 + 12 + 48 + 2 * (4 + 8 * (6 + 8)));
    }

    #[test]
    fn parts_are_small_but_not_tiny() {
        let parts = |height: u32| height.div_ceil(rows_in_parts(height));
        assert_eq!([1, 8, 9, 64, 256, 1024, 10_000].map(parts), [1, 1, 2, 8, 32, 32, 32]);
    }

    #[test]
    fn a_limit_splits_the_picture_and_none_does_not() {
        let rows = |left| rows_on_host(&plan([1000; 2], None, left));
        assert_eq!(rows(None).unwrap(), 1000);
        assert_eq!(rows(Some(u64::MAX)).unwrap(), 1000);
        let some = rows(Some(RESERVE + (32 << 20))).unwrap();
        assert!((1..1000).contains(&some), "{some}");
        let Err(RenderError::Memory { short, .. }) = rows(Some(RESERVE + 1)) else { panic!("no row fits") };
        assert_eq!(rows(Some(short.needed)).unwrap(), 1);
        assert!(rows(Some(short.needed - 1)).is_err());
    }
}
