//! Formula (6): the light points that can lie in the interpolation half-ball of some point of a cell.

use std::ops::Range;

use glam::IVec3;
use lightmesh_layout::constants::MAX_REACH;

/// The light points that lie within r of *some* point of a cell, as offsets from the cell. Bit k of a surface point's mask
/// refers to `offsets()[k]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    radius: f32,
    reach: i32,
    offsets: Vec<IVec3>,
    /// The points of each line along x, by z and y starting at `1 − reach`: (first bit, its x, number of points).
    rows: Vec<(u16, i16, u16)>,
}

/// A radius for which there is no template.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "interpolation radius R = {radius} is not between {least} and {most} steps: below, half-balls are empty; above, masks take kilobytes per pixel. 2.1 is a good choice",
    least = Template::MIN_RADIUS,
    most = Template::MAX_RADIUS
)]
pub struct TemplateError {
    /// The requested radius.
    pub radius: f32,
}

impl Template {
    /// Smallest radius in steps.
    pub const MIN_RADIUS: f32 = 0.5;
    /// Largest radius in steps: 20 000 light points.
    pub const MAX_RADIUS: f32 = MAX_REACH as f32;

    /// The template of interpolation radius `radius` = r/h.
    pub fn new(radius: f32) -> Result<Template, TemplateError> {
        if !(Self::MIN_RADIUS..=Self::MAX_RADIUS).contains(&radius) {
            return Err(TemplateError { radius });
        }
        let reach = radius.ceil() as i32;
        let side = 1 - reach..=reach;
        // Distance of offset i from the cell's extent along one axis.
        let excess = |i: i32| 0.max(-i).max(i - 1);
        let inside = |offset: &IVec3| {
            let square: i32 = offset.to_array().iter().map(|&i| excess(i) * excess(i)).sum();
            f64::from(square) < f64::from(radius) * f64::from(radius)
        };
        let mut offsets = Vec::new();
        let mut rows = Vec::new();
        for z in side.clone() {
            for y in side.clone() {
                let first = offsets.len();
                offsets.extend(side.clone().map(|x| IVec3::new(x, y, z)).filter(inside));
                let x = offsets.get(first).map_or(0, |offset| offset.x);
                rows.push((first as u16, x as i16, (offsets.len() - first) as u16));
            }
        }
        Ok(Template { radius, reach, offsets, rows })
    }

    /// R = r/h.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Offsets from the cell, ascending in (z, y, x).
    pub fn offsets(&self) -> &[IVec3] {
        &self.offsets
    }

    /// The bits of the points with this `y` and `z` whose x lies in `low..=high`.
    #[inline(always)]
    pub fn row(&self, y: i32, z: i32, low: i32, high: i32) -> Range<usize> {
        let (side, least) = (2 * self.reach, 1 - self.reach);
        let (first, x, count) = self.rows[((z - least) * side + y - least) as usize];
        let (x, count) = (i32::from(x), i32::from(count));
        // If the row is empty or the range misses it, the result is empty.
        let from = (low - x).max(0);
        let to = (high + 1 - x).clamp(from, count.max(from));
        usize::from(first) + from as usize..usize::from(first) + to as usize
    }

    /// Number of light points.
    #[allow(clippy::len_without_is_empty, reason = "a template is never empty")]
    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// 32-bit words of a mask.
    pub fn words(&self) -> usize {
        self.offsets.len().div_ceil(32)
    }

    /// Largest component of an offset; the smallest is one less in the other direction.
    pub fn reach(&self) -> i32 {
        self.reach
    }
}
