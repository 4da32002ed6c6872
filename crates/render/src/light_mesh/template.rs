//! Formula (6): which light points can lie in the interpolation half-ball of some point of a cell.
//!
//! The order of the points is ours to choose. They follow the Z-order curve (Morton 1966), so that each run of eight, a SIMD
//! vector, is a compact cluster: what misses the cluster's box misses all eight.

use glam::{IVec3, Vec3};

/// The light points that lie within r of *some* point of a cell, as offsets from the cell. Bit k of an object point's mask
/// speaks of `offsets()[k]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    radius: f32,
    offsets: Vec<IVec3>,
    clusters: Vec<Cluster>,
}

/// The box around eight consecutive points of a template, in steps from the cell's lowest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Its middle.
    pub center: Vec3,
    /// Half its edges.
    pub half: Vec3,
}

/// A radius for which there is no template.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "interpolation radius R = {radius} is not between {least} and {most} steps: below, half-balls are empty; above, masks take kilobytes a pixel. 2.1 is a good choice",
    least = Template::MIN_RADIUS,
    most = Template::MAX_RADIUS
)]
pub struct TemplateError {
    /// What was asked for.
    pub radius: f32,
}

impl Template {
    /// Smallest radius in steps.
    pub const MIN_RADIUS: f32 = 0.5;
    /// Largest radius in steps: 20 000 light points.
    pub const MAX_RADIUS: f32 = 16.0;

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
        let plane = |z: i32| side.clone().flat_map(move |y| (1 - reach..=reach).map(move |x| IVec3::new(x, y, z)));
        let mut offsets: Vec<IVec3> = side.clone().flat_map(plane).filter(inside).collect();
        offsets.sort_unstable_by_key(|offset| z_order(*offset + reach - 1));
        let clusters = offsets.chunks(Cluster::POINTS).map(Cluster::around).collect();
        Ok(Template { radius, offsets, clusters })
    }

    /// R = r/h.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// Offsets from the cell, in Z-order.
    pub fn offsets(&self) -> &[IVec3] {
        &self.offsets
    }

    /// The boxes around each eight offsets.
    pub fn clusters(&self) -> &[Cluster] {
        &self.clusters
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
        self.radius.ceil() as i32
    }
}

impl Cluster {
    /// Points of a cluster; the last one may have fewer.
    pub const POINTS: usize = 8;

    fn around(offsets: &[IVec3]) -> Cluster {
        let min = offsets.iter().copied().fold(IVec3::MAX, IVec3::min).as_vec3();
        let max = offsets.iter().copied().fold(IVec3::MIN, IVec3::max).as_vec3();
        Cluster { center: 0.5 * (min + max), half: 0.5 * (max - min) }
    }
}

/// The bits of the three components (none negative, six bits each) interleaved.
fn z_order(index: IVec3) -> u32 {
    let spread = |value: i32| (0..6).map(|bit| (value as u32 >> bit & 1) << (3 * bit)).sum::<u32>();
    spread(index.x) | spread(index.y) << 1 | spread(index.z) << 2
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
    fn clusters_hold_their_points_and_are_compact() {
        let template = Template::new(3.1).unwrap();
        for (points, cluster) in template.offsets().chunks(8).zip(template.clusters()) {
            for point in points {
                assert!((point.as_vec3() - cluster.center).abs().cmple(cluster.half).all());
            }
        }
        let volume = |cluster: &Cluster| (2.0 * cluster.half + 1.0).element_product();
        let mean = template.clusters().iter().map(volume).sum::<f32>() / template.clusters().len() as f32;
        assert!(mean < 16.0, "rows of eight would take 8, cubes too; this order takes {mean}");
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
