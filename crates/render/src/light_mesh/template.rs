//! Formula (6): the light points that can lie in the interpolation half-ball of some point of a cell.

use std::ops::Range;

use glam::IVec3;
use lightmesh_layout::constants::MOST_REACH;

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
    pub const MAX_RADIUS: f32 = MOST_REACH as f32;

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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn sizes_are_those_of_the_method() {
        let sizes = [
            (1.0, 8),
            (1.5, 56),
            (2.0, 64),
            (2.1, 88),
            (2.5, 160),
            (3.0, 184),
            (3.1, 232),
            (3.2, 280),
            (3.5, 312),
            (4.0, 408),
            (4.1, 432),
            (5.0, 720),
            (5.1, 888),
            (6.1, 1352),
        ];
        for (radius, size) in sizes {
            let template = Template::new(radius).unwrap();
            assert_eq!(template.len(), size, "R = {radius}");
            assert_eq!(template.words(), size.div_ceil(32), "R = {radius}");
        }
    }

    #[test]
    fn the_cube_s_symmetries_leave_it_alone() {
        let template = Template::new(3.1).unwrap();
        let set: BTreeSet<[i32; 3]> = template.offsets().iter().map(IVec3::to_array).collect();
        for &[x, y, z] in &set {
            // Mirror about the cell's centre (1/2) along x, and two exchanges of axes: together they generate all 48.
            assert!(set.contains(&[1 - x, y, z]) && set.contains(&[y, x, z]) && set.contains(&[y, z, x]));
        }
    }

    #[test]
    fn bits_ascend_in_z_y_x() {
        let template = Template::new(2.1).unwrap();
        assert!(template.offsets().is_sorted_by_key(|offset| (offset.z, offset.y, offset.x)));
    }

    #[test]
    fn rows_are_the_points_between_two_bounds() {
        for radius in [0.5, 1.5, 3.1, 4.0] {
            let template = Template::new(radius).unwrap();
            let reach = template.reach();
            let side = 1 - reach..=reach;
            for (y, z) in side.clone().flat_map(|y| side.clone().map(move |z| (y, z))) {
                for (low, high) in [(1 - reach, reach), (0, 0), (-1, 2), (2, 1), (-99, 99), (reach + 1, reach + 2)] {
                    let expected: Vec<usize> = (0..template.len())
                        .filter(|&bit| {
                            let offset = template.offsets()[bit];
                            offset.y == y && offset.z == z && (low..=high).contains(&offset.x)
                        })
                        .collect();
                    let row: Vec<usize> = template.row(y, z, low, high).collect();
                    assert_eq!(row, expected, "R = {radius}, y = {y}, z = {z}, {low}..={high}");
                }
            }
        }
    }

    #[test]
    fn the_reach_is_that_of_the_farthest_offset() {
        for radius in [1.0, 1.5, 2.1, 3.0, 3.1, 5.1] {
            let template = Template::new(radius).unwrap();
            let farthest = template.offsets().iter().map(|offset| offset.max_element()).max();
            assert_eq!(farthest, Some(template.reach()), "R = {radius}");
        }
    }

    #[test]
    fn radii_without_sense_are_refused() {
        for radius in [0.0, -1.0, 0.49, 16.1, f32::NAN, f32::INFINITY] {
            assert!(Template::new(radius).is_err(), "R = {radius}");
        }
    }
}
