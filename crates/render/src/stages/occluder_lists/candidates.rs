//! Which triangles can hide an emitter from a box of surface points, eight triangles at a time.
//!
//! A triangle hides nothing from a point unless a corner of it lies above the point's tangent plane. A region knows only the planes of
//! all points, lowered by the rounding of its largest box; a triangle is compared with its own, so that those of the surface that the
//! points lie on are dropped.
//!
//! With a, b, c relative to the middle of the box, e = c − b and x = b × c = ½ (b + c) × e, an edge function for a point p and a sample s is
//!
//! ```text
//! f(p, s) = (s − p) · ((b − p) × (c − p)) = s · x − p · (e × s + x)
//! ```
//!
//! bilinear in p and s. With s = m + r, m the middle of the emitter's box, it differs from m · x by r · x − p · (e × m + x) − p · (e × r).
//! Half the edges of both boxes bound each term.
//!
//! # What is rounded
//!
//! Here as in [`ProjectedLights`](crate::shadow::occlusion::ProjectedLights),
//! whose decisions the bounds must cover, a function is off by less than 16 ε times
//! the product of the three lengths in it; 64 ε bound both.
//!
//! The height of a corner above the plane through a point, along n, is off by 4.1 ε Σ |nᵢ| Dᵢ, D being its way from where heights are
//! measured; that of the point by 4.1 ε Σ |nᵢ| eᵢ, e being the edges of the points' box; and what decides by the way between the two by
//! as much as both. So [`REGION_ROUNDING`], 16 ε, times Σ |nᵢ| (Dᵢ + eᵢ) bounds all.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, mask32x8};
use glam::Vec3;
use lightmesh_layout::constants::{ENLARGEMENT, REGION_ROUNDING, UNIT_ROUNDOFF};
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{CHUNK, TangentPlanes, Triangle};
use lightmesh_trace::simd::{Axes, cross, difference, dot, fused_dot, load, scaled, splat, sum};

/// The boxes of a bundle and an emitter.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shaft {
    /// The middle of the box around the surface points.
    middle: Vec3,
    /// Half the edges of that box.
    half: Vec3,
    /// The middle of the emitter's box, relative to the other.
    emitter: Vec3,
    /// Half the edges of the emitter's box.
    emitter_half: Vec3,
    /// No sample is farther from the middle.
    radius: f32,
    /// The square of the radius of an emissive ball about that middle: what lies in it hides nothing.
    body: f32,
}

/// What becomes of eight triangles, a bit each.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Chosen {
    /// May hide something.
    pub(super) kept: u32,
    /// Hide everything from all points.
    pub(super) dark: u32,
}

impl Shaft {
    pub(super) fn new(origins: &Bounds, emitter: &Bounds, (radius, body): (f32, f32)) -> Shaft {
        let middle = origins.center();
        let grown = |bounds: &Bounds| 0.5 * ENLARGEMENT * bounds.extent() + 4.0 * UNIT_ROUNDOFF * bounds.center().abs();
        Shaft {
            middle,
            half: grown(origins),
            emitter: emitter.center() - middle,
            emitter_half: grown(emitter),
            radius: ENLARGEMENT * radius,
            body: body * body,
        }
    }

    /// Chooses among triangles, one in each lane.
    #[inline(always)]
    pub(super) fn choose<S: Simd>(&self, simd: S, [a, b, c]: [Axes<S>; 3]) -> Chosen {
        let (half, emitter, emitter_half) =
            (splat(simd, self.half), splat(simd, self.emitter), splat(simd, self.emitter_half));
        let reach = self.half.element_sum();
        let far = self.emitter.abs().element_sum() + self.emitter_half.element_sum();
        let middle = splat(simd, self.middle);
        let edges = [difference(c, b), difference(a, c), difference(b, a)];
        let (a, b, c) = (difference(a, middle), difference(b, middle), difference(c, middle));
        let lengths = [length(edges[0]), length(edges[1]), length(edges[2])];
        let away = [length(a), length(b), length(c)];

        // The triangle's plane: on which side are the points, and the samples?
        let plane = cross(edges[1], edges[2]);
        let rounding = lengths[1] * lengths[2] * (64.0 * UNIT_ROUNDOFF);
        let side = dot(plane, a);
        let room = extent(plane, half) + rounding * (away[0] + reach);
        let (points_above, points_below) = (side.simd_gt(room), side.simd_lt(-room));
        let side = dot(plane, difference(a, emitter));
        let room = self.extent_of_samples(plane, emitter_half) + rounding * (away[0] + far);
        let (samples_above, samples_below) = (side.simd_gt(room), side.simd_lt(-room));
        let mut dropped = (points_above & samples_above) | (points_below & samples_below);
        if self.body > 0.0 {
            let within = |corner: Axes<S>| {
                let from = difference(corner, emitter);
                dot(from, from).simd_lt(self.body)
            };
            dropped |= within(a) & within(b) & within(c);
        }

        // Its edges.
        let never = mask32x8::splat(simd, false);
        let (mut outside, mut inside) = (never, never);
        let (mut all_inside, mut all_outside) = (!never, !never);
        for (edge, (from, to, from_length, to_length)) in
            [(b, c, away[1], away[2]), (c, a, away[2], away[0]), (a, b, away[0], away[1])].into_iter().enumerate()
        {
            let (e, e_length) = (edges[edge], lengths[edge]);
            let x = scaled(f32x8::splat(simd, 0.5), cross(sum(from, to), e));
            let f = dot(emitter, x);
            let turned = cross(e, emitter);
            let turned = [turned[0] + x[0], turned[1] + x[1], turned[2] + x[2]];
            let room = self.extent_of_samples(x, emitter_half)
                + extent(turned, half)
                + e_length * (self.half.length() * self.emitter_half.length())
                + e_length * (from_length + to_length + 2.0 * reach) * (64.0 * UNIT_ROUNDOFF * (far + reach));
            let (negative, positive) = (f.simd_lt(-room), f.simd_gt(room));
            outside |= negative;
            inside |= positive;
            all_inside &= positive;
            all_outside &= negative;
        }
        dropped |= outside & inside;
        dropped |= (points_above & outside) | (points_below & inside);
        let dark = (points_above & samples_below & all_inside) | (points_below & samples_above & all_outside);
        Chosen { kept: (!dropped).to_bitmask() as u32, dark: dark.to_bitmask() as u32 }
    }
}

impl Shaft {
    /// The largest product of `v` and the way from the middle of the emitter to a sample: a ball's box is larger than the ball.
    #[inline(always)]
    fn extent_of_samples<S: Simd>(&self, v: Axes<S>, half: Axes<S>) -> f32x8<S> {
        extent(v, half).min(dot(v, v).sqrt() * self.radius)
    }
}

/// The largest product of `v` and a vector in a box of these half edges.
#[inline(always)]
fn extent<S: Simd>(v: Axes<S>, half: Axes<S>) -> f32x8<S> {
    v[0].abs() * half[0] + v[1].abs() * half[1] + v[2].abs() * half[2]
}

/// The sum of absolute components.
#[inline(always)]
fn length<S: Simd>(v: Axes<S>) -> f32x8<S> {
    v[0].abs() + v[1].abs() + v[2].abs()
}

/// Bit k: a corner of triangle k may lie above the tangent plane of any of the points, which are not farther than `extent` from the lowest
/// corner of their box.
#[inline(always)]
pub(super) fn above_planes<S: Simd>(simd: S, planes: &TangentPlanes, extent: Vec3, [a, b, c]: [Axes<S>; 3]) -> u32 {
    let corner = splat(simd, planes.corner());
    let (a, b, c) = (difference(a, corner), difference(b, corner), difference(c, corner));
    let far = [
        a[0].abs().max(b[0].abs()).max(c[0].abs()) + extent.x,
        a[1].abs().max(b[1].abs()).max(c[1].abs()) + extent.y,
        a[2].abs().max(b[2].abs()).max(c[2].abs()) + extent.z,
    ];
    let mut above = if planes.is_empty() { 0xff } else { 0 };
    for (normal, height) in planes.each() {
        let n = splat(simd, normal);
        let top = fused_dot(n, a).max(fused_dot(n, b)).max(fused_dot(n, c));
        let reached = top + fused_dot(splat(simd, normal.abs()), far) * REGION_ROUNDING;
        above |= reached.simd_gt(f32x8::splat(simd, height)).to_bitmask() as u32;
    }
    above
}

/// Up to [`CHUNK`] triangles that may hide something, side by side.
pub(super) struct Candidates {
    corners: [[f32; CHUNK]; 9],
    /// The number of each that is cut out, or 0.
    cuts: [u32; CHUNK],
    pub(super) count: usize,
}

impl Candidates {
    pub(super) fn new() -> Candidates {
        Candidates { corners: [[0.0; CHUNK]; 9], cuts: [0; CHUNK], count: 0 }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, triangle: &Triangle) {
        self.cuts[self.count] = triangle.cut();
        for (corner, axes) in triangle.corners().iter().zip(self.corners.chunks_exact_mut(3)) {
            (axes[0][self.count], axes[1][self.count], axes[2][self.count]) = (corner.x, corner.y, corner.z);
        }
        self.count += 1;
    }

    /// Eight of them, one in each lane.
    #[inline(always)]
    pub(super) fn eight<S: Simd>(&self, simd: S, first: usize) -> [Axes<S>; 3] {
        let [ax, ay, az, bx, by, bz, cx, cy, cz] = &self.corners;
        [
            [load(simd, ax, first), load(simd, ay, first), load(simd, az, first)],
            [load(simd, bx, first), load(simd, by, first), load(simd, bz, first)],
            [load(simd, cx, first), load(simd, cy, first), load(simd, cz, first)],
        ]
    }

    /// The number of one of them if it is cut out, else 0.
    #[inline(always)]
    pub(super) fn cut(&self, number: usize) -> u32 {
        self.cuts[number & (CHUNK - 1)]
    }

    /// One of them, in all lanes.
    #[inline(always)]
    pub(super) fn splat<S: Simd>(&self, simd: S, number: usize) -> [Axes<S>; 3] {
        let number = number & (CHUNK - 1);
        let corner = |axes: &[[f32; CHUNK]]| Vec3::new(axes[0][number], axes[1][number], axes[2][number]);
        let (a, b, c) = (corner(&self.corners[..3]), corner(&self.corners[3..6]), corner(&self.corners[6..]));
        [splat(simd, a), splat(simd, b), splat(simd, c)]
    }
}
