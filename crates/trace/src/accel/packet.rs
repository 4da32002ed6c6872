//! Eight rays tested against one triangle at once: [`RayShear`](super::triangle::RayShear) and the visitors for coherent rays,
//! one ray per lane. Every operation is that of the single ray, in the same order, so that every result has the same bits.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f64x4, mask32x8, u32x8};

use super::ray_clamp::ClampedRay;
use super::visit::{Any, Closest};
use super::{AlphaMask, Hit, Triangle};

/// Rays in a packet.
pub(super) const LANES: usize = 8;

/// Eight rays whose largest direction component lies on the same axis, prepared for the watertight test.
#[derive(Clone, Copy)]
pub(super) struct PacketShear<S: Simd> {
    axes: [usize; 3],
    origin: [f32x8<S>; 3],
    shear: [f32x8<S>; 2],
    depth: f32x8<S>,
}

/// Where rays meet the plane of a triangle.
struct Meeting<S: Simd> {
    /// Rays that meet the triangle itself.
    met: u32,
    t: f32x8<S>,
    /// Scaled barycentric coordinates of the second and third corner and their unit, for the lower and upper rays.
    scaled: [[f64x4<S>; 3]; 2],
}

impl<S: Simd> PacketShear<S> {
    /// Prepares rays; `z` is the axis of their largest component.
    #[inline(always)]
    pub(super) fn new(origin: &[f32x8<S>; 3], direction: &[f32x8<S>; 3], z: usize) -> PacketShear<S> {
        let axes = [(z + 1) % 3, (z + 2) % 3, z];
        let depth = direction[z];
        let shear = [direction[axes[0]] / depth, direction[axes[1]] / depth];
        let origin = [origin[axes[0]], origin[axes[1]], origin[axes[2]]];
        PacketShear { axes, origin, shear, depth }
    }

    /// Which of the rays in `lanes` meet the triangle, and where their lines meet it.
    #[inline(always)]
    fn intersect(&self, simd: S, triangle: &Triangle, lanes: u32) -> Option<Meeting<S>> {
        // 1. Corners relative to the origins, sheared so that the rays are the z axis.
        let [a, b, c] = triangle.packed();
        let (a, b, c) = (self.sheared(a), self.sheared(b), self.sheared(c));

        // 2. Signs of the edge functions.
        let zero = f32x8::splat(simd, 0.0);
        let u = c[0] * b[1] - c[1] * b[0];
        let v = a[0] * c[1] - a[1] * c[0];
        let w = b[0] * a[1] - b[1] * a[0];
        let below = u.simd_lt(zero) | v.simd_lt(zero) | w.simd_lt(zero);
        let above = u.simd_gt(zero) | v.simd_gt(zero) | w.simd_gt(zero);
        let met = lanes & !((below & above).to_bitmask() as u32);
        // No `bool::then`: its closure would be compiled without the wide instructions.
        if met == 0 { None } else { Some(self.meet(simd, [a, b, c], met)) }
    }

    #[inline(always)]
    fn sheared(&self, corner: &[f32; 4]) -> [f32x8<S>; 3] {
        let [i, j, k] = self.axes;
        let z = corner[k & 3] - self.origin[2];
        let x = corner[i & 3] - self.origin[0];
        let y = corner[j & 3] - self.origin[1];
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }

    /// The decision and the distance in double precision, four rays at a time.
    #[inline(always)]
    fn meet(&self, simd: S, corners: [[f32x8<S>; 3]; 3], met: u32) -> Meeting<S> {
        let [a, b, c] = corners;
        let (a, b, c) = (widen(a), widen(b), widen(c));
        let depth = self.depth.widen();
        let (low, low_t, low_scaled) = meet_half(simd, a.0, b.0, c.0, depth.0);
        let (high, high_t, high_scaled) = meet_half(simd, a.1, b.1, c.1, depth.1);
        Meeting { met: met & (low | high << 4), t: low_t.narrow(high_t), scaled: [low_scaled, high_scaled] }
    }
}

#[inline(always)]
fn widen<S: Simd>([x, y, z]: [f32x8<S>; 3]) -> ([f64x4<S>; 3], [f64x4<S>; 3]) {
    let (x, y, z) = (x.widen(), y.widen(), z.widen());
    ([x.0, y.0, z.0], [x.1, y.1, z.1])
}

#[inline(always)]
fn meet_half<S: Simd>(
    simd: S,
    a: [f64x4<S>; 3],
    b: [f64x4<S>; 3],
    c: [f64x4<S>; 3],
    depth: f64x4<S>,
) -> (u32, f64x4<S>, [f64x4<S>; 3]) {
    let zero = f64x4::splat(simd, 0.0);
    // 3. Scaled barycentric coordinates: all of one sign if the triangle is hit.
    let u = c[0] * b[1] - c[1] * b[0];
    let v = a[0] * c[1] - a[1] * c[0];
    let w = b[0] * a[1] - b[1] * a[0];
    let below = u.simd_lt(zero) | v.simd_lt(zero) | w.simd_lt(zero);
    let above = u.simd_gt(zero) | v.simd_gt(zero) | w.simd_gt(zero);
    let det = u + v + w;
    let missed = (below & above) | det.simd_eq(zero);
    // 4. Distance.
    let t = (u * a[2] + v * b[2] + w * c[2]) / (det * depth);
    (!(missed.to_bitmask() as u32) & 0xf, t, [v, w, det])
}

impl<S: Simd> Meeting<S> {
    /// Barycentric weights of the second and third corner.
    #[inline(always)]
    fn weights(&self) -> (f32x8<S>, f32x8<S>) {
        let [[v0, w0, det0], [v1, w1, det1]] = self.scaled;
        ((v0 / det0).narrow(v1 / det1), (w0 / det0).narrow(w1 / det1))
    }
}

/// What is done with the triangles that a packet reaches: the twin of [`Visitor`](super::visit::Visitor).
pub(super) trait PacketVisitor<S: Simd> {
    /// A single ray's visitor.
    type Single;

    /// Tests a triangle against the rays in `lanes`.
    fn triangle(&mut self, simd: S, triangle: &Triangle, lanes: u32);

    /// What lies at larger ray parameters need not be tested; negative for a ray that is done.
    fn limit(&self) -> f32x8<S>;

    /// Bit k: ray k needs no more triangles.
    fn done(&self) -> u32;

    /// Continues the ray of one lane alone, and adopts its result.
    fn alone(&mut self, simd: S, lane: usize, near: &ClampedRay, walk: impl FnOnce(&mut Self::Single));
}

/// Searches for the closest hits.
#[derive(Clone, Copy)]
pub(super) struct ClosestPacket<'a, S: Simd> {
    alpha_mask: &'a AlphaMask,
    shear: PacketShear<S>,
    t_max: f32x8<S>,
    limit: f32x8<S>,
    t: f32x8<S>,
    u: f32x8<S>,
    v: f32x8<S>,
    triangle: u32x8<S>,
}

impl<'a, S: Simd> ClosestPacket<'a, S> {
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        alpha_mask: &'a AlphaMask,
        shear: PacketShear<S>,
        t_max: f32x8<S>,
    ) -> ClosestPacket<'a, S> {
        let zero = f32x8::splat(simd, 0.0);
        let t = f32x8::splat(simd, Hit::MISS.t);
        let triangle = u32x8::splat(simd, Hit::NONE);
        ClosestPacket { alpha_mask, shear, t_max, limit: t_max, t, u: zero, v: zero, triangle }
    }

    /// The closest hit of each ray.
    #[inline(always)]
    pub(super) fn hits(&self) -> [Hit; LANES] {
        let (t, u, v): ([f32; LANES], [f32; LANES], [f32; LANES]) = (self.t.into(), self.u.into(), self.v.into());
        let triangle: [u32; LANES] = self.triangle.into();
        let mut hits = [Hit::MISS; LANES];
        for lane in 0..LANES {
            hits[lane] = Hit { t: t[lane], u: u[lane], v: v[lane], triangle: triangle[lane] };
        }
        hits
    }
}

impl<'a, S: Simd> PacketVisitor<S> for ClosestPacket<'a, S> {
    type Single = Closest<'a>;

    #[inline(always)]
    fn triangle(&mut self, simd: S, triangle: &Triangle, lanes: u32) {
        let Some(meeting) = self.shear.intersect(simd, triangle, lanes) else { return };
        let index = u32x8::splat(simd, triangle.index());
        let t = meeting.t;
        let inside = t.simd_gt(f32x8::splat(simd, 0.0)) & t.simd_lt(self.t_max);
        let beats = t.simd_lt(self.t) | (t.simd_eq(self.t) & index.simd_lt(self.triangle));
        let mut better = meeting.met & (inside & beats).to_bitmask() as u32;
        if better == 0 {
            return;
        }
        let (u, v) = meeting.weights();
        if triangle.cut() != 0 {
            better = self.alpha_mask.covered_lanes(triangle.cut(), u.into(), v.into(), better);
        }
        let better = mask32x8::from_bitmask(simd, u64::from(better));
        self.t = better.select(t, self.t);
        self.limit = better.select(t, self.limit);
        self.u = better.select(u, self.u);
        self.v = better.select(v, self.v);
        self.triangle = better.select(index, self.triangle);
    }

    #[inline(always)]
    fn limit(&self) -> f32x8<S> {
        self.limit
    }

    #[inline(always)]
    fn done(&self) -> u32 {
        0
    }

    #[inline(always)]
    fn alone(&mut self, simd: S, lane: usize, near: &ClampedRay, walk: impl FnOnce(&mut Closest<'a>)) {
        let before = self.hits()[lane];
        let mut single = Closest::from(near, self.alpha_mask, before);
        walk(&mut single);
        if single.best.triangle == before.triangle {
            return;
        }
        let own = mask32x8::from_bitmask(simd, 1 << lane);
        self.t = own.select(f32x8::splat(simd, single.best.t), self.t);
        self.limit = own.select(f32x8::splat(simd, single.best.t), self.limit);
        self.u = own.select(f32x8::splat(simd, single.best.u), self.u);
        self.v = own.select(f32x8::splat(simd, single.best.v), self.v);
        self.triangle = own.select(u32x8::splat(simd, single.best.triangle), self.triangle);
    }
}

/// Searches for any hits.
#[derive(Clone, Copy)]
pub(super) struct AnyPacket<'a, S: Simd> {
    alpha_mask: &'a AlphaMask,
    shear: PacketShear<S>,
    t_max: f32x8<S>,
    /// `t_max`; negative for a ray that has hit.
    limit: f32x8<S>,
    pub(super) hit: u32,
}

impl<'a, S: Simd> AnyPacket<'a, S> {
    #[inline(always)]
    pub(super) fn new(alpha_mask: &'a AlphaMask, shear: PacketShear<S>, t_max: f32x8<S>) -> AnyPacket<'a, S> {
        AnyPacket { alpha_mask, shear, t_max, limit: t_max, hit: 0 }
    }

    #[inline(always)]
    fn mark(&mut self, simd: S, hit: u32) {
        self.hit |= hit;
        let done = mask32x8::from_bitmask(simd, u64::from(hit));
        self.limit = done.select(f32x8::splat(simd, -1.0), self.limit);
    }
}

impl<'a, S: Simd> PacketVisitor<S> for AnyPacket<'a, S> {
    type Single = Any<'a>;

    #[inline(always)]
    fn triangle(&mut self, simd: S, triangle: &Triangle, lanes: u32) {
        let Some(meeting) = self.shear.intersect(simd, triangle, lanes & !self.hit) else { return };
        let inside = meeting.t.simd_gt(f32x8::splat(simd, 0.0)) & meeting.t.simd_lt(self.t_max);
        let mut hit = meeting.met & inside.to_bitmask() as u32;
        if hit != 0 && triangle.cut() != 0 {
            let (u, v) = meeting.weights();
            hit = self.alpha_mask.covered_lanes(triangle.cut(), u.into(), v.into(), hit);
        }
        if hit != 0 {
            self.mark(simd, hit);
        }
    }

    #[inline(always)]
    fn limit(&self) -> f32x8<S> {
        self.limit
    }

    #[inline(always)]
    fn done(&self) -> u32 {
        self.hit
    }

    #[inline(always)]
    fn alone(&mut self, simd: S, lane: usize, near: &ClampedRay, walk: impl FnOnce(&mut Any<'a>)) {
        let mut single = Any::new(near, self.alpha_mask);
        walk(&mut single);
        if single.hit {
            self.mark(simd, 1 << lane);
        }
    }
}
