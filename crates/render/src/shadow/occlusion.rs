//! Which samples of a light a triangle hides from a surface point: the one definition of visibility of lights with samples in rows. Twin:
//! `occlusion.cuh`.
//!
//! Seen from a point P, a triangle with corners a, b, c relative to P hides a sample at d if d lies on the inner side of the three planes
//! through P and an edge, and beyond the triangle's plane:
//!
//! ```text
//! ((b + c) × (c − b)) · d ≥ 0, and so on for the other edges;      N · d ≥ (N · a) end,   N = (b − a) × (c − a)
//! ```
//!
//! for a triangle whose plane has P on its negative side, else with all signs reversed. The four functions are linear in d, so that on a
//! row of samples each is zero at one x: the hidden samples of a row are those between the largest of the lower bounds and the
//! smallest of the upper ones. A row costs the same whatever its number of samples.
//!
//! * (b + c) × (c − b) is twice b × c, and its rounding errors are relative to the edge rather than to the distances of its ends. It only
//!   changes its sign if b and c change places. So triangles that share an edge have exactly the same bound there: no sample
//!   slips through between them.
//! * A triangle with no corner above the tangent plane hides nothing, nor one whose plane contains P.
//! * A triangle that is [cut out](lightmesh_trace::accel::alpha_mask) hides those of these samples whose ray meets a part of it that is there.
//! * Products are fused into sums ([`fused_dot`]): the results are the same wherever they are evaluated, with half the instructions.
//!
//! Lanes are surface points, triangles, or both: the functions do not care.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8, u32x8};
use glam::Vec3;
use lightmesh_layout::constants::{MAX_ROWS, MAX_WORDS, MIN_SLOPE, UNBOUNDED};
use lightmesh_layout::scene::SampleRows;
use lightmesh_trace::accel::Triangles;
use lightmesh_trace::simd::{Axes, LANES, difference, fused_cross, fused_dot, splat, sum};

use super::cuts::{Cuts, Lines, by_lane, keep_stopped, stopped_centers};
use super::projected_light::ProjectedLight;
use crate::surface::SurfacePoint;

/// Bits of samples, by word, in each lane.
pub(crate) type Bits<S> = [u32x8<S>; MAX_WORDS as usize];

/// Surface points and a light as each sees it, one in each lane.
#[derive(Clone, Copy)]
pub struct ProjectedLights<S: Simd> {
    origin: Axes<S>,
    normal: Axes<S>,
    center: Axes<S>,
    along: Axes<S>,
    across: Axes<S>,
    end: f32x8<S>,
}

/// The places of x = 0 in each row of samples, by lane.
pub(crate) type Offsets<S> = [f32x8<S>; MAX_ROWS as usize];

impl<S: Simd> ProjectedLights<S> {
    /// The same in all lanes.
    #[inline(always)]
    pub fn splat(simd: S, point: &SurfacePoint, projected: &ProjectedLight) -> ProjectedLights<S> {
        ProjectedLights {
            origin: splat(simd, point.origin),
            normal: splat(simd, point.normal),
            center: splat(simd, projected.center),
            along: splat(simd, projected.along),
            across: splat(simd, projected.across),
            end: f32x8::splat(simd, projected.end),
        }
    }

    /// One in each lane; lanes without one repeat the first.
    #[inline(always)]
    pub(crate) fn gather(simd: S, points: &[SurfacePoint], projected_lights: &[ProjectedLight]) -> ProjectedLights<S> {
        let mut numbers = [[0.0; LANES]; 16];
        for lane in 0..LANES {
            let from = if lane < points.len() { lane } else { 0 };
            let (point, projected) = (&points[from], &projected_lights[from]);
            let vectors = [point.origin, point.normal, projected.center, projected.along, projected.across];
            for (axes, vector) in numbers.chunks_exact_mut(3).zip(vectors) {
                (axes[0][lane], axes[1][lane], axes[2][lane]) = (vector.x, vector.y, vector.z);
            }
            numbers[15][lane] = projected.end;
        }
        let load = |first: usize| {
            [
                f32x8::from_slice(simd, &numbers[first]),
                f32x8::from_slice(simd, &numbers[first + 1]),
                f32x8::from_slice(simd, &numbers[first + 2]),
            ]
        };
        let end = f32x8::from_slice(simd, &numbers[15]);
        ProjectedLights { origin: load(0), normal: load(3), center: load(6), along: load(9), across: load(12), end }
    }

    /// The samples in front of the surface, before anything hides them.
    #[inline(always)]
    pub(crate) fn above_horizon(&self, simd: S, set: &SampleRows, offsets: &Offsets<S>) -> Bits<S> {
        let linear = self.linear(self.normal);
        let mut bounds = Bounds::none(simd);
        bounds.cut(simd, &linear, f32x8::splat(simd, 0.0).simd_eq(f32x8::splat(simd, 0.0)));
        bounds.bits(simd, set, offsets)
    }

    /// Whether the centre is in front of the surface.
    #[inline(always)]
    pub(crate) fn center_above_horizon(&self, simd: S) -> mask32x8<S> {
        fused_dot(self.normal, self.center).simd_gt(f32x8::splat(simd, 0.0))
    }

    /// The function n · d on the emitter.
    #[inline(always)]
    fn linear(&self, n: Axes<S>) -> Linear<S> {
        Linear { start: fused_dot(n, self.center), x: fused_dot(n, self.along), y: fused_dot(n, self.across) }
    }

    /// The planes through the surface point and the edges of a triangle, and its own; `None` if it hides nothing in any of `lanes`.
    #[inline(always)]
    fn facets(&self, simd: S, [a, b, c]: [Axes<S>; 3], lanes: u32) -> Option<Facets<S>> {
        let zero = f32x8::splat(simd, 0.0);
        let edges = [difference(c, b), difference(a, c), difference(b, a)];
        let (a, b, c) = (difference(a, self.origin), difference(b, self.origin), difference(c, self.origin));
        let n = self.normal;
        let mut above = fused_dot(n, a).simd_gt(zero);
        // Mostly one corner is enough.
        if !above.to_bitmask() as u32 & lanes != 0 {
            above = above | fused_dot(n, b).simd_gt(zero) | fused_dot(n, c).simd_gt(zero);
            if above.to_bitmask() as u32 & lanes == 0 {
                return None;
            }
        }
        let plane = fused_cross(edges[1], edges[2]);
        let volume = fused_dot(plane, a);
        let matters = above & (volume.simd_gt(zero) | volume.simd_lt(zero));
        if matters.to_bitmask() as u32 & lanes == 0 {
            return None;
        }
        let sides =
            [fused_cross(sum(b, c), edges[0]), fused_cross(sum(c, a), edges[1]), fused_cross(sum(a, b), edges[2])];
        Some(Facets { sides, plane, volume, outer: volume.simd_gt(zero), matters })
    }

    /// Clears the bits of the samples that a triangle hides, in `lanes`.
    #[inline(always)]
    pub fn hide(
        &self,
        simd: S,
        (triangle, cuts): ([Axes<S>; 3], Option<Cuts>),
        (set, offsets): (&SampleRows, &Offsets<S>),
        lanes: u32,
        seen: &mut Bits<S>,
    ) {
        let Some(facets) = self.facets(simd, triangle, lanes) else { return };
        let sides = [self.linear(facets.sides[0]), self.linear(facets.sides[1]), self.linear(facets.sides[2])];
        // Most triangles are passed by on the outer side of an edge.
        let passed = sides[0].never(facets.outer) | sides[1].never(facets.outer) | sides[2].never(facets.outer);
        if (facets.matters & !passed).to_bitmask() as u32 & lanes == 0 {
            return;
        }
        let mut bounds = Bounds::none(simd);
        bounds.cut(simd, &sides[0], facets.outer);
        bounds.cut(simd, &sides[1], facets.outer);
        bounds.cut(simd, &sides[2], facets.outer);
        let mut beyond = self.linear(facets.plane);
        beyond.start = (-facets.volume).mul_add_precise(self.end, beyond.start);
        // All of most emitters lies beyond the plane; then that bounds no row.
        let clear = facets.outer.select(beyond.start, -beyond.start).simd_gt(beyond.range()) | !facets.matters;
        if (!clear).to_bitmask() as u32 & lanes != 0 {
            bounds.cut(simd, &beyond, facets.outer);
        }
        let matters = facets.matters.select(i32x8::splat(simd, -1), i32x8::splat(simd, 0)).bitcast::<u32x8<S>>();
        let mut hidden = bounds.bits(simd, set, offsets);
        if let Some(cuts) = cuts {
            for word in 0..set.words as usize {
                hidden[word] &= seen[word];
            }
            let lanes = facets.matters.to_bitmask() as u32 & lanes;
            hidden = self.stopped(simd, (triangle, &cuts), (set, offsets), lanes, hidden);
        }
        for word in 0..set.words as usize {
            seen[word] &= !(hidden[word] & matters);
        }
    }

    /// Those of `samples` that triangles hide where they are not cut out, in `lanes`.
    #[inline(always)]
    fn stopped(
        &self,
        simd: S,
        (triangle, cuts): ([Axes<S>; 3], &Cuts),
        (set, offsets): (&SampleRows, &Offsets<S>),
        lanes: u32,
        samples: Bits<S>,
    ) -> Bits<S> {
        let from = self.lines(triangle);
        let offsets: [[f32; LANES]; MAX_ROWS as usize] = offsets.map(Into::into);
        let mut samples: [[u32; LANES]; MAX_WORDS as usize] = samples.map(Into::into);
        keep_stopped(cuts, &from, (set, &offsets), lanes, &mut samples);
        let mut bits = [u32x8::splat(simd, 0); MAX_WORDS as usize];
        for (bits, samples) in bits.iter_mut().zip(&samples) {
            *bits = u32x8::from_slice(simd, samples);
        }
        bits
    }

    /// The same, lane by lane, with triangles.
    #[inline(always)]
    fn lines(&self, triangle: [Axes<S>; 3]) -> Lines {
        let [a, b, c] = triangle.map(by_lane);
        Lines {
            origin: by_lane(self.origin),
            center: by_lane(self.center),
            along: by_lane(self.along),
            across: by_lane(self.across),
            corners: [a, b, c],
        }
    }

    /// The lanes in which a triangle hides the centre.
    #[inline(always)]
    pub(crate) fn hides_center(&self, simd: S, (triangle, cuts): ([Axes<S>; 3], Option<Cuts>), lanes: u32) -> u32 {
        let Some(facets) = self.facets(simd, triangle, lanes) else { return 0 };
        let zero = f32x8::splat(simd, 0.0);
        let beyond = (-facets.volume).mul_add_precise(self.end, fused_dot(facets.plane, self.center));
        let (u, v, w) = (
            fused_dot(facets.sides[0], self.center),
            fused_dot(facets.sides[1], self.center),
            fused_dot(facets.sides[2], self.center),
        );
        let least = u.min_precise(v).min_precise(w.min_precise(beyond));
        let most = u.max_precise(v).max_precise(w.max_precise(beyond));
        let inside = (facets.outer & least.simd_ge(zero)) | (!facets.outer & most.simd_le(zero));
        let hidden = (inside & facets.matters).to_bitmask() as u32 & lanes;
        match cuts {
            Some(cuts) if hidden != 0 => stopped_centers(&cuts, &self.lines(triangle), hidden),
            _ => hidden,
        }
    }
}

/// A triangle as seen from surface points.
struct Facets<S: Simd> {
    /// Normals of the planes through the point and an edge.
    sides: [Axes<S>; 3],
    /// Normal of its own plane.
    plane: Axes<S>,
    /// The product of that and a corner.
    volume: f32x8<S>,
    /// Whether the volume is positive, and positive functions are inside.
    outer: mask32x8<S>,
    /// Whether it may hide anything.
    matters: mask32x8<S>,
}

/// `start + x · (step in x) + y · (step in y)`.
struct Linear<S: Simd> {
    start: f32x8<S>,
    x: f32x8<S>,
    y: f32x8<S>,
}

impl<S: Simd> Linear<S> {
    /// Whether the function is certainly negative on the whole emitter; positive in lanes that are not `outer`.
    #[inline(always)]
    fn never(&self, outer: mask32x8<S>) -> mask32x8<S> {
        let most = outer.select(self.start, -self.start);
        most.simd_lt(-self.range())
    }

    /// More than it changes from the middle of the emitter to any sample. The outer rows of rectangles begin beyond its side.
    #[inline(always)]
    fn range(&self) -> f32x8<S> {
        (self.x.abs() + self.y.abs() + self.y.abs()) * 1.01
    }
}

/// Bounds of x on a row at y: the largest `low[k] + y step[k]` and the smallest `high[k] + y step[k]`. An edge bounds one side only; on
/// the other its start lies far beyond, whatever the step.
struct Bounds<S: Simd> {
    count: usize,
    low: [f32x8<S>; 4],
    high: [f32x8<S>; 4],
    step: [f32x8<S>; 4],
}

impl<S: Simd> Bounds<S> {
    #[inline(always)]
    fn none(simd: S) -> Bounds<S> {
        let zero = f32x8::splat(simd, 0.0);
        Bounds { count: 0, low: [zero; 4], high: [zero; 4], step: [zero; 4] }
    }

    /// Cuts off where the function is negative, or positive in lanes that are not `outer`.
    #[inline(always)]
    fn cut(&mut self, simd: S, f: &Linear<S>, outer: mask32x8<S>) {
        let (zero, least) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, MIN_SLOPE));
        let slope = f.x.abs().simd_lt(least).select(least.copysign(f.x), f.x);
        let inverse = f32x8::splat(simd, -1.0) / slope;
        let start = f.start * inverse;
        let rises = slope.simd_gt(zero);
        let low = (rises & outer) | (!rises & !outer);
        let beyond = f32x8::splat(simd, UNBOUNDED);
        self.low[self.count] = low.select(start, -beyond);
        self.high[self.count] = low.select(beyond, start);
        self.step[self.count] = f.y * inverse;
        self.count += 1;
    }

    /// The samples within the bounds.
    #[inline(always)]
    fn bits(&self, simd: S, set: &SampleRows, offsets: &Offsets<S>) -> Bits<S> {
        let mut bits = [u32x8::splat(simd, 0); MAX_WORDS as usize];
        let mut row = 0;
        for (word, bits) in bits.iter_mut().enumerate().take(set.words as usize) {
            while row < set.ends[word] as usize {
                *bits |= self.row(simd, set, row, offsets[row]) << set.place[row];
                row += 1;
            }
        }
        bits
    }

    /// The samples of a row as its lowest bits.
    #[inline(always)]
    fn row(&self, simd: S, set: &SampleRows, row: usize, offset: f32x8<S>) -> u32x8<S> {
        let y = f32x8::splat(simd, set.y[row]);
        let mut low = self.step[0].mul_add_precise(y, self.low[0]);
        let mut high = self.step[0].mul_add_precise(y, self.high[0]);
        for k in 1..self.count {
            low = low.max_precise(self.step[k].mul_add_precise(y, self.low[k]));
            high = high.min_precise(self.step[k].mul_add_precise(y, self.high[k]));
        }
        let density = f32x8::splat(simd, set.density[row]);
        let (zero, count) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, set.count[row] as f32));
        let first = low.mul_add_precise(density, offset).max_precise(zero).min_precise(count).ceil();
        let end = high.mul_add_precise(density, offset + 1.0).max_precise(zero).min_precise(count).floor();
        power_of_two(simd, end.max_precise(first)) - power_of_two(simd, first)
    }
}

/// 2^k for whole numbers k from 0 to 30.
#[inline(always)]
fn power_of_two<S: Simd>(simd: S, k: f32x8<S>) -> u32x8<S> {
    // In the exponent of a float; the product is exact.
    let exponent = (k + 127.0) * f32x8::splat(simd, (1u32 << 23) as f32);
    let power: f32x8<S> = exponent.to_int::<i32x8<S>>().bitcast();
    power.to_int::<i32x8<S>>().bitcast()
}

/// Up to eight triangles, one in each lane; the last is repeated.
#[inline(always)]
pub(crate) fn gathered<S: Simd>(simd: S, triangles: &Triangles, indices: &[u32]) -> [Axes<S>; 3] {
    let mut corners = [[[0.0; LANES]; 3]; 3];
    for lane in 0..LANES {
        let index = indices[lane.min(indices.len() - 1)];
        for (axes, Vec3 { x, y, z }) in corners.iter_mut().zip(triangles.at(index).corners()) {
            (axes[0][lane], axes[1][lane], axes[2][lane]) = (x, y, z);
        }
    }
    let load = |axes: &[[f32; LANES]; 3]| {
        [f32x8::from_slice(simd, &axes[0]), f32x8::from_slice(simd, &axes[1]), f32x8::from_slice(simd, &axes[2])]
    };
    [load(&corners[0]), load(&corners[1]), load(&corners[2])]
}
