//! Rays to the samples of a light through a BVH, one after another. Whether a triangle hides a sample is decided as for a row of samples,
//! with the bits of [`Sights::hide`](super::occlusion::Sights::hide). The twin on CUDA devices is sample_ray.cuh.

use std::cell::Cell;

use fearless_simd::Simd;
use glam::Vec3;
use lightmesh_layout::constants::{BEYOND, LEAST_SLOPE, SHADOW_MARGIN};
use lightmesh_layout::scene::SampleRows;

use super::sight::Sight;
use crate::accel::{Bvh, Coverage, Triangle, Visitor};
use crate::surface::SurfacePoint;

/// By how much a sample must miss a triangle's edge to need no exact test, 2^-18 of the largest product: more than both are rounded.
const SAMPLE_MARGIN: f32 = 1.0 / (1u32 << 18) as f32;

/// The rays of surface points to a light.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SampleRays {
    /// The triangle that hid the last sample.
    last: Option<Triangle>,
    /// How many may still be cast.
    pub(crate) most: u32,
    /// How many have been cast.
    pub(crate) cast: u32,
    /// Numbers of nodes and triangles that were tested.
    pub(crate) nodes: u32,
    pub(crate) triangles: u32,
}

impl SampleRays {
    /// Casts rays to the samples `bits` of a word, and returns those that arrive, or had none. `scale` is that of the light.
    #[inline(always)]
    pub(crate) fn cast<S: Simd>(
        &mut self,
        simd: S,
        (bvh, scale): (&Bvh, f32),
        (point, sight): (&SurfacePoint, &Sight),
        (set, word): (&SampleRows, usize),
        bits: u32,
    ) -> u32 {
        let size = sight.center.abs() + sight.along.abs() + sight.across.abs();
        let slack = SHADOW_MARGIN * size.max_element() / scale;
        let mut arrive = bits;
        let first = if word == 0 { 0 } else { set.ends[word - 1] as usize };
        for row in first..set.ends[word] as usize {
            let mut rest = bits & ((1 << set.count[row]) - 1) << set.place[row];
            while rest != 0 && self.most != 0 {
                let bit = rest.trailing_zeros();
                let mut ray = SampleRay::new(bvh.coverage(), (point, sight, size), (set, row), bit - set.place[row]);
                if self.last.is_none_or(|last| ray.triangle(&last)) {
                    bvh.visit_segment(simd, (point.origin, ray.target / scale), slack, &mut ray);
                }
                if ray.blocker.is_some() {
                    arrive &= !(1 << bit);
                    self.last = ray.blocker;
                }
                self.cast += 1;
                self.nodes += ray.nodes.get();
                self.triangles += ray.triangles;
                rest &= rest - 1;
                self.most -= 1;
            }
        }
        arrive
    }
}

/// A ray to one sample.
struct SampleRay<'a> {
    coverage: &'a Coverage,
    point: &'a SurfacePoint,
    sight: &'a Sight,
    /// The sample as seen from the point, scaled, and no less than any sample's coordinates.
    target: Vec3,
    size: Vec3,
    /// The row of samples: y, density, number of samples, and the place of x = 0.
    y: f32,
    density: f32,
    count: f32,
    offset: f32,
    /// The sample's place in it.
    place: f32,
    /// A triangle that hides it.
    blocker: Option<Triangle>,
    nodes: Cell<u32>,
    triangles: u32,
}

impl<'a> SampleRay<'a> {
    #[inline(always)]
    fn new(
        coverage: &'a Coverage,
        (point, sight, size): (&'a SurfacePoint, &'a Sight, Vec3),
        (set, row): (&SampleRows, usize),
        place: u32,
    ) -> SampleRay<'a> {
        let (y, density, offset, place) = (set.y[row], set.density[row], sight.offset(set, row), place as f32);
        let target = sight.scaled_sample(set, row, place, offset);
        let count = set.count[row] as f32;
        let nodes = Cell::new(0);
        SampleRay {
            coverage,
            point,
            sight,
            target,
            size,
            y,
            density,
            count,
            offset,
            place,
            blocker: None,
            nodes,
            triangles: 0,
        }
    }

    /// Whether a triangle hides the sample.
    #[inline(always)]
    fn is_hidden_by(&self, [a, b, c]: [Vec3; 3]) -> bool {
        let edges = [c - b, a - c, b - a];
        let (a, b, c) = (a - self.point.origin, b - self.point.origin, c - self.point.origin);
        let n = self.point.normal;
        if !(fused_dot(n, a) > 0.0 || fused_dot(n, b) > 0.0 || fused_dot(n, c) > 0.0) {
            return false;
        }
        let plane = fused_cross(edges[1], edges[2]);
        let volume = fused_dot(plane, a);
        if volume == 0.0 || volume.is_nan() {
            return false;
        }
        let outer = volume > 0.0;
        let mut bounds = RowBounds { y: self.y, low: f32::NAN, high: f32::NAN };
        let sides = [(b + c, edges[0]), (c + a, edges[1]), (a + b, edges[2])];
        let mut normals = [Vec3::ZERO; 3];
        for (normal, (sum, edge)) in normals.iter_mut().zip(sides) {
            *normal = fused_cross(sum, edge);
            // The function at the sample, which lies outside of the row's bounds if this is further from zero than both are rounded.
            let f = fused_dot(*normal, self.target);
            if (if outer { f } else { -f }) < -SAMPLE_MARGIN * fused_dot(normal.abs(), self.size) {
                return false;
            }
        }
        for normal in normals {
            bounds.cut(self.linear(normal), outer);
        }
        let [start, x, y] = self.linear(plane);
        bounds.cut([(-volume).mul_add(self.sight.end, start), x, y], outer);
        let first = bounds.low.mul_add(self.density, self.offset).max(0.0).min(self.count).ceil();
        let end = bounds.high.mul_add(self.density, self.offset + 1.0).max(0.0).min(self.count).floor();
        first <= self.place && self.place < end
    }

    /// The function n · d on the emitter: in its middle, and how it rises along x and y.
    #[inline(always)]
    fn linear(&self, n: Vec3) -> [f32; 3] {
        [fused_dot(n, self.sight.center), fused_dot(n, self.sight.along), fused_dot(n, self.sight.across)]
    }
}

impl Visitor for SampleRay<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.triangles += 1;
        let hidden =
            self.is_hidden_by(triangle.corners()) && self.coverage.stops(triangle, self.point.origin, self.target);
        if !hidden {
            return true;
        }
        self.blocker = Some(*triangle);
        false
    }

    /// A walk asks once at each node.
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.nodes.set(self.nodes.get() + 1);
        1.0
    }
}

/// Bounds of x on the row at y; NaN before there are any.
struct RowBounds {
    y: f32,
    low: f32,
    high: f32,
}

impl RowBounds {
    /// Cuts off where a function is negative, or positive if not `outer`.
    #[inline(always)]
    fn cut(&mut self, [start, x, y]: [f32; 3], outer: bool) {
        let slope = if x.abs() < LEAST_SLOPE { LEAST_SLOPE.copysign(x) } else { x };
        let inverse = -1.0 / slope;
        let (start, step) = (start * inverse, y * inverse);
        let low = (slope > 0.0) == outer;
        self.low = self.low.max(step.mul_add(self.y, if low { start } else { -BEYOND }));
        self.high = self.high.min(step.mul_add(self.y, if low { BEYOND } else { start }));
    }
}

/// As that of [eight lanes](crate::simd::fused_dot).
#[inline(always)]
fn fused_dot(a: Vec3, b: Vec3) -> f32 {
    a.z.mul_add(b.z, a.y.mul_add(b.y, a.x * b.x))
}

/// As that of [eight lanes](crate::simd::fused_cross).
#[inline(always)]
fn fused_cross(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.y.mul_add(b.z, -(a.z * b.y)), a.z.mul_add(b.x, -(a.x * b.z)), a.x.mul_add(b.y, -(a.y * b.x)))
}

#[cfg(test)]
mod tests {
    use fearless_simd::prelude::*;
    use fearless_simd::{Level, f32x8, u32x8};

    use super::*;
    use crate::accel::Accelerator;
    use crate::job::Sampling;
    use crate::shadow::Aim;
    use crate::shadow::cuts::Cuts;
    use crate::shadow::occlusion::Sights;
    use crate::shadow::rows::Rows;
    use crate::simd::{LANES, dispatch, splat};

    /// Numbers in [−1, 1).
    struct Random(u64);

    impl Random {
        fn signed(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) as f32 / (1u64 << 23) as f32 - 1.0
        }

        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.signed(), self.signed(), self.signed())
        }
    }

    fn soup(random: &mut Random, size: f32) -> Vec<[Vec3; 3]> {
        (0..60)
            .map(|_| {
                let middle = Vec3::Y + random.vector();
                [0; 3].map(|_| middle + size * random.vector())
            })
            .collect()
    }

    /// Squares that share corners, each two triangles.
    fn sheet(random: &mut Random) -> Vec<[Vec3; 3]> {
        const SIDE: usize = 12;
        let corners: Vec<Vec3> = (0..=SIDE * (SIDE + 1) + SIDE)
            .map(|k| {
                let [x, z] = [k % (SIDE + 1), k / (SIDE + 1)].map(|k| k as f32 / SIDE as f32 - 0.5);
                Vec3::new(x, 1.0 + 0.05 * random.signed(), z)
            })
            .collect();
        let square = |k: usize| {
            let [a, b, c, d] = [k, k + 1, k + SIDE + 1, k + SIDE + 2].map(|k| corners[k]);
            [[a, b, d], [a, d, c]]
        };
        (0..SIDE * (SIDE + 1)).filter(|k| k % (SIDE + 1) < SIDE).flat_map(square).collect()
    }

    /// The samples of a word that rows, and rays, find hidden.
    #[inline(always)]
    fn hidden<S: Simd>(
        simd: S,
        bvh: &Bvh,
        triangles: &[Triangle],
        (point, sight): (&SurfacePoint, &Sight),
        set: &SampleRows,
    ) -> Vec<[u32; 2]> {
        let sights = Sights::splat(simd, point, sight);
        let mut offsets = [f32x8::splat(simd, 0.0); 20];
        for (row, offset) in offsets.iter_mut().enumerate().take(set.rows as usize) {
            *offset = f32x8::splat(simd, sight.offset(set, row));
        }
        let mut seen = set.full.map(|full| u32x8::splat(simd, full));
        for triangle in triangles {
            let corners = triangle.corners().map(|corner| splat(simd, corner));
            sights.hide(simd, (corners, Cuts::splat(bvh.coverage(), triangle.cut())), (set, &offsets), 0xff, &mut seen);
        }
        let mut rays = SampleRays::default();
        let words = seen.iter().enumerate().take(set.words as usize);
        words
            .map(|(word, &seen)| {
                rays.most = u32::MAX;
                let arrive = rays.cast(simd, (bvh, 1.0), (point, sight), (set, word), set.full[word]);
                [<[u32; LANES]>::from(seen)[0], arrive].map(|seen| set.full[word] & !seen)
            })
            .collect()
    }

    #[test]
    fn rays_have_the_bits_of_rows() {
        let mut random = Random(7);
        let mut counts = [0; 2];
        for samples in [1, 16, 64, 225] {
            let rows = Rows::of(&Aim::Extent(Sampling { samples, seed: 0, spread: true }));
            for trial in 0..60 {
                let corners = match trial % 4 {
                    0 => sheet(&mut random),
                    kind => soup(&mut random, [0.02, 0.2, 1.0][kind - 1]),
                };
                let triangles: Vec<Triangle> =
                    corners.into_iter().zip(0..).map(|(corners, index)| Triangle::new(corners, index)).collect();
                let bvh = Bvh::new(&triangles);
                assert_eq!(bvh.name(), "bvh");
                let origin = 0.1 * random.vector();
                let point =
                    SurfacePoint { position: origin, origin, normal: (Vec3::Y + 0.9 * random.vector()).normalize() };
                let center = Vec3::Y * 3.0 + random.vector();
                let sight = Sight {
                    center,
                    along: random.vector(),
                    across: random.vector(),
                    end: 1.0 / (1.0 - 1e-6),
                    shift: 0.5 + 0.5 * random.signed(),
                    inside: 1.0,
                    choice: 0,
                };
                for set in [&rows.disc[0], &rows.rectangle[0]] {
                    let found = dispatch!(Level::new(), simd => hidden(simd, &bvh, &triangles, (&point, &sight), set));
                    counts[1] += set.count.iter().sum::<u32>();
                    for [rows, rays] in found {
                        assert_eq!(rows, rays, "{samples} samples, trial {trial}");
                        counts[0] += rows.count_ones();
                    }
                }
            }
        }
        assert!(counts[0] > 1000 && counts[0] < counts[1], "{counts:?} are hidden");
    }
}
