//! Rays to the samples of a light through a BVH, one after another. Whether a triangle hides a sample is decided as for a row of samples,
//! with the bits of [`ProjectedLights::hide`](super::occlusion::ProjectedLights::hide). The twin on CUDA devices is sample_ray.cuh.

use std::cell::Cell;

use fearless_simd::Simd;
use glam::Vec3;
use lightmesh_layout::constants::{MIN_SLOPE, SHADOW_MARGIN, UNBOUNDED};
use lightmesh_layout::scene::SampleRows;
use lightmesh_trace::accel::{AlphaMask, Bvh, Triangle, Visitor};

use super::projected_light::ProjectedLight;
use crate::surface::SurfacePoint;

/// By how much a sample must miss a triangle's edge to need no exact test, 2^-18 of the largest product: more than both are rounded.
const SAMPLE_MARGIN: f32 = 1.0 / (1u32 << 18) as f32;

/// The rays of surface points to a light.
#[derive(Clone, Copy, Debug, Default)]
pub struct SampleRays {
    /// The triangle that hid the last sample.
    last: Option<Triangle>,
    /// How many may still be cast.
    pub most: u32,
    /// How many have been cast.
    pub(crate) cast: u32,
    /// Numbers of nodes and triangles that were tested.
    pub(crate) nodes: u32,
    pub(crate) triangles: u32,
}

impl SampleRays {
    /// Casts rays to the samples `bits` of a word, and returns those that arrive, or had none. `scale` is that of the light.
    #[inline(always)]
    pub fn cast<S: Simd>(
        &mut self,
        simd: S,
        (bvh, scale): (&Bvh, f32),
        (point, projected): (&SurfacePoint, &ProjectedLight),
        (set, word): (&SampleRows, usize),
        bits: u32,
    ) -> u32 {
        let size = projected.center.abs() + projected.along.abs() + projected.across.abs();
        let slack = SHADOW_MARGIN * size.max_element() / scale;
        let mut arrive = bits;
        let first = if word == 0 { 0 } else { set.ends[word - 1] as usize };
        for row in first..set.ends[word] as usize {
            let mut rest = bits & ((1 << set.count[row]) - 1) << set.place[row];
            while rest != 0 && self.most != 0 {
                let bit = rest.trailing_zeros();
                let mut ray =
                    SampleRay::new(bvh.alpha_mask(), (point, projected, size), (set, row), bit - set.place[row]);
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
    alpha_mask: &'a AlphaMask,
    point: &'a SurfacePoint,
    projected: &'a ProjectedLight,
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
        alpha_mask: &'a AlphaMask,
        (point, projected, size): (&'a SurfacePoint, &'a ProjectedLight, Vec3),
        (set, row): (&SampleRows, usize),
        place: u32,
    ) -> SampleRay<'a> {
        let (y, density, offset, place) = (set.y[row], set.density[row], projected.offset(set, row), place as f32);
        let target = projected.scaled_sample(set, row, place, offset);
        let count = set.count[row] as f32;
        let nodes = Cell::new(0);
        SampleRay {
            alpha_mask,
            point,
            projected,
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
        bounds.cut([(-volume).mul_add(self.projected.end, start), x, y], outer);
        let first = bounds.low.mul_add(self.density, self.offset).max(0.0).min(self.count).ceil();
        let end = bounds.high.mul_add(self.density, self.offset + 1.0).max(0.0).min(self.count).floor();
        first <= self.place && self.place < end
    }

    /// The function n · d on the emitter: in its middle, and how it rises along x and y.
    #[inline(always)]
    fn linear(&self, n: Vec3) -> [f32; 3] {
        [fused_dot(n, self.projected.center), fused_dot(n, self.projected.along), fused_dot(n, self.projected.across)]
    }
}

impl Visitor for SampleRay<'_> {
    #[inline(always)]
    fn triangle(&mut self, triangle: &Triangle) -> bool {
        self.triangles += 1;
        let hidden =
            self.is_hidden_by(triangle.corners()) && self.alpha_mask.stops(triangle, self.point.origin, self.target);
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
        let slope = if x.abs() < MIN_SLOPE { MIN_SLOPE.copysign(x) } else { x };
        let inverse = -1.0 / slope;
        let (start, step) = (start * inverse, y * inverse);
        let low = (slope > 0.0) == outer;
        self.low = self.low.max(step.mul_add(self.y, if low { start } else { -UNBOUNDED }));
        self.high = self.high.min(step.mul_add(self.y, if low { UNBOUNDED } else { start }));
    }
}

/// As that of [eight lanes](lightmesh_trace::simd::fused_dot).
#[inline(always)]
fn fused_dot(a: Vec3, b: Vec3) -> f32 {
    a.z.mul_add(b.z, a.y.mul_add(b.y, a.x * b.x))
}

/// As that of [eight lanes](lightmesh_trace::simd::fused_cross).
#[inline(always)]
fn fused_cross(a: Vec3, b: Vec3) -> Vec3 {
    Vec3::new(a.y.mul_add(b.z, -(a.z * b.y)), a.z.mul_add(b.x, -(a.x * b.z)), a.x.mul_add(b.y, -(a.y * b.x)))
}
