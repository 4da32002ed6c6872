//! Eight surface points of one cell at a time, one per lane; light points and triangles are the same for all lanes.

use std::ops::Range;

use fearless_simd::{f32x8, prelude::*};
use glam::Vec3;
use lightmesh_trace::accel::{AlphaMask, Triangle};
use lightmesh_trace::simd::{Axes, LANES, cross, difference, dot, dot_along_x, scaled, splat};

use super::MaskCounts;
use super::cells::CellOccluders;
use crate::data::masks::population;
use crate::light_mesh::{CellPoints, LightMesh};
use crate::surface::SurfacePoint;

/// Up to eight surface points and, for each light point of the template, the lanes that still see it.
pub(super) struct Batch {
    position: [[f32; LANES]; 3],
    origin: [[f32; LANES]; 3],
    normal: [[f32; LANES]; 3],
    /// One bit for each lane in use.
    lanes: u8,
    seen: Vec<u8>,
}

impl Batch {
    pub(super) fn new(mesh: &LightMesh) -> Batch {
        let lanes = || [[0.0; LANES]; 3];
        // Eight more, so that rows can be read eight points at a time.
        let seen = vec![0; mesh.template.words() * 32 + 8];
        Batch { position: lanes(), origin: lanes(), normal: lanes(), lanes: 0, seen }
    }

    /// Loads surface points, at most eight.
    pub(super) fn fill(&mut self, points: &[SurfacePoint]) {
        self.lanes = 0;
        for (lane, point) in points.iter().enumerate() {
            for axis in 0..3 {
                self.position[axis][lane] = point.position[axis];
                self.origin[axis][lane] = point.origin[axis];
                self.normal[axis][lane] = point.normal[axis];
            }
            self.lanes |= 1 << lane;
        }
    }

    /// The masks of the surface points, one after the other.
    #[inline(always)]
    pub(super) fn masks<S: Simd>(
        &mut self,
        simd: S,
        mesh: &LightMesh,
        points: &CellPoints,
        (triangles, alpha_mask): (&CellOccluders, &AlphaMask),
        masks: &mut [u32],
    ) -> MaskCounts {
        // 1, 2. The half-balls.
        let sizes = self.half_balls(simd, mesh, points);

        // 3. What blocks their segments.
        let mut tested = 0;
        for candidate in &triangles.candidates {
            if let Some((occluders, lanes)) = self.occluders(simd, mesh, &candidate.triangle.corners()) {
                tested |= lanes;
                let cut = Cut { triangle: &candidate.triangle, alpha_mask };
                self.clear_blocked(simd, points, triangles.rows(candidate), (&occluders, cut), lanes);
            }
        }

        self.write(mesh.template.words(), masks);
        let mut counts = MaskCounts::default();
        for (lane, &size) in sizes.iter().enumerate() {
            counts.half_ball += size as u64;
            counts.tested += if tested >> lane & 1 != 0 { size as u64 } else { 0 };
        }
        counts.used = population(masks);
        counts
    }

    /// Conditions 1 and 2 of formula (2). Returns how many light points each lane has.
    #[inline(always)]
    fn half_balls<S: Simd>(&mut self, simd: S, mesh: &LightMesh, points: &CellPoints) -> [f32; LANES] {
        let square = f32x8::splat(simd, mesh.radius * mesh.radius);
        let least = f32x8::splat(simd, mesh.least_height());
        let position = self.load(simd, &self.position);
        let normal = self.load(simd, &self.normal);
        let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
        let mut sizes = zero;
        for bit in 0..mesh.template.len() {
            let d = difference(splat(simd, points.get(bit)), position);
            let inside = dot_along_x(d, d).simd_lt(square) & dot_along_x(normal, d).simd_gt(least);
            sizes += inside.select(one, zero);
            self.seen[bit] = inside.to_bitmask() as u8 & self.lanes;
        }
        let mut sizes: [f32; LANES] = sizes.into();
        for (lane, size) in sizes.iter_mut().enumerate() {
            if self.lanes >> lane & 1 == 0 {
                *size = 0.0;
            }
        }
        sizes
    }

    /// [`ShortTest::occluder`](lightmesh_trace::accel::ShortTest::occluder) in each lane, with the same operations in the same order, and
    /// the lanes that have an occluder.
    #[inline(always)]
    fn occluders<S: Simd>(&self, simd: S, mesh: &LightMesh, corners: &[Vec3; 3]) -> Option<(Occluders<S>, u8)> {
        let zero = f32x8::splat(simd, 0.0);
        let origin = self.load(simd, &self.origin);
        let normal = self.load(simd, &self.normal);
        let a = difference(splat(simd, corners[0]), origin);
        let b = difference(splat(simd, corners[1]), origin);
        let c = difference(splat(simd, corners[2]), origin);
        let above = dot(normal, a).simd_gt(zero) | dot(normal, b).simd_gt(zero) | dot(normal, c).simd_gt(zero);
        if above.to_bitmask() as u8 & self.lanes == 0 {
            return None;
        }
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let volume = dot(a, bc);
        let area = cross(difference(b, a), difference(c, a));
        let edge_on = f32x8::splat(simd, mesh.edge_on() * mesh.edge_on());
        let faces = (volume * volume).simd_gt(edge_on * dot(area, area));
        let lanes = (above & faces).to_bitmask() as u8 & self.lanes;
        let sign = volume.simd_lt(zero).select(f32x8::splat(simd, -1.0), f32x8::splat(simd, 1.0));
        let sides = [scaled(sign, bc), scaled(sign, ca), scaled(sign, ab)];
        let slack = f32x8::splat(simd, 1e-5 * mesh.radius);
        let slack = [slack * length(sides[0]), slack * length(sides[1]), slack * length(sides[2])];
        (lanes != 0).then_some((Occluders { sides, volume: sign * volume, slack }, lanes))
    }

    /// [`Occluder::blocks`](lightmesh_trace::accel::triangle::Occluder::blocks) in each of `lanes`, for the light points that the
    /// candidate's shadow can reach.
    #[inline(always)]
    fn clear_blocked<S: Simd>(
        &mut self,
        simd: S,
        points: &CellPoints,
        rows: &[Range<u16>],
        (occluders, cut): (&Occluders<S>, Cut),
        lanes: u8,
    ) {
        let zero = f32x8::splat(simd, 0.0);
        let origin = self.load(simd, &self.origin);
        let Occluders { sides: [a, b, c], volume, .. } = *occluders;
        for row in rows {
            // Eight points of a row are skipped at a time if no lane sees any of them, or none lies in a shadow.
            let (mut next, end) = (usize::from(row.start), usize::from(row.end));
            while next < end {
                let (first, count) = (next, 8.min(end - next));
                next += count;
                let ends = (points.get(first), points.get(first + count - 1));
                if !self.any_seen(first, count, lanes) || occluders.reach(simd, origin, ends) & lanes == 0 {
                    continue;
                }
                // What does not change along the row.
                let (dy, dz) = (f32x8::splat(simd, ends.0.y) - origin[1], f32x8::splat(simd, ends.0.z) - origin[2]);
                let (ua, va, wa) = (a[2] * dz + a[1] * dy, b[2] * dz + b[1] * dy, c[2] * dz + c[1] * dy);
                for bit in first..first + count {
                    if self.seen[bit] & lanes == 0 {
                        continue;
                    }
                    let dx = f32x8::splat(simd, points.get(bit).x) - origin[0];
                    let (u, v, w) = (ua + a[0] * dx, va + b[0] * dx, wa + c[0] * dx);
                    let inside = u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero) & (u + v + w).simd_gt(volume);
                    let mut blocked = inside.to_bitmask() as u8 & lanes;
                    if cut.triangle.cut() != 0 {
                        blocked = self.stopped(cut, points.get(bit), blocked & self.seen[bit]);
                    }
                    self.seen[bit] &= !blocked;
                }
            }
        }
    }

    /// Those of `lanes` whose segments to a light point a triangle that is cut out stops.
    #[inline(never)]
    fn stopped(&self, cut: Cut, light_point: Vec3, lanes: u8) -> u8 {
        let stops = |lane: &usize| {
            let origin = Vec3::from(self.origin.map(|axis| axis[*lane]));
            lanes >> lane & 1 != 0 && cut.alpha_mask.stops(cut.triangle, origin, light_point - origin)
        };
        (0..LANES).filter(stops).fold(0, |all, lane| all | 1 << lane)
    }

    /// Whether any of `lanes` still sees any of the `count` light points from `first` on, at most eight.
    #[inline(always)]
    fn any_seen(&self, first: usize, count: usize, lanes: u8) -> bool {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&self.seen[first..first + 8]);
        let wanted = (u64::from(lanes) * 0x0101_0101_0101_0101) & (!0 >> (8 * (8 - count)));
        u64::from_le_bytes(bytes) & wanted != 0
    }

    /// Turns lanes per light point into light points per lane: the masks, `words` for each surface point.
    #[inline(always)]
    fn write(&self, words: usize, masks: &mut [u32]) {
        for (group, seen) in self.seen[..words * 32].chunks_exact(8).enumerate() {
            let rows = u64::from_le_bytes([seen[0], seen[1], seen[2], seen[3], seen[4], seen[5], seen[6], seen[7]]);
            let columns = transposed(rows).to_le_bytes();
            let (word, shift) = (group / 4, group % 4 * 8);
            for (lane, mask) in masks.chunks_exact_mut(words).enumerate() {
                let kept = if shift == 0 { 0 } else { mask[word] };
                mask[word] = kept | u32::from(columns[lane]) << shift;
            }
        }
    }

    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, lanes: &[[f32; LANES]; 3]) -> Axes<S> {
        [f32x8::from_slice(simd, &lanes[0]), f32x8::from_slice(simd, &lanes[1]), f32x8::from_slice(simd, &lanes[2])]
    }
}

/// A triangle, and where triangles are cut out.
#[derive(Clone, Copy)]
struct Cut<'a> {
    triangle: &'a Triangle,
    alpha_mask: &'a AlphaMask,
}

/// A triangle as seen from eight origins.
#[derive(Clone, Copy)]
struct Occluders<S: Simd> {
    sides: [Axes<S>; 3],
    volume: f32x8<S>,
    /// Far above the rounding of the products with each side, which is a few ε of the same size.
    slack: Axes<S>,
}

impl<S: Simd> Occluders<S> {
    /// The lanes in which a light point between two on a line along x can be hidden. The deciding functions are linear: their
    /// largest values on the line are at its ends.
    #[inline(always)]
    fn reach(&self, simd: S, origin: Axes<S>, (low, high): (Vec3, Vec3)) -> u8 {
        let [a, b, c] = self.sides;
        let [su, sv, sw] = self.slack;
        let (dy, dz) = (f32x8::splat(simd, low.y) - origin[1], f32x8::splat(simd, low.z) - origin[2]);
        let (from, to) = (f32x8::splat(simd, low.x) - origin[0], f32x8::splat(simd, high.x) - origin[0]);
        let (u, v, w) = (a[1] * dy + a[2] * dz, b[1] * dy + b[2] * dz, c[1] * dy + c[2] * dz);
        let (ua, va, wa) = (u + a[0] * from, v + b[0] * from, w + c[0] * from);
        let (ub, vb, wb) = (u + a[0] * to, v + b[0] * to, w + c[0] * to);
        let zero = f32x8::splat(simd, 0.0);
        let reached = (ua.max(ub) + su).simd_ge(zero)
            & (va.max(vb) + sv).simd_ge(zero)
            & (wa.max(wb) + sw).simd_ge(zero)
            & ((ua + va + wa).max(ub + vb + wb) + (su + sv + sw)).simd_ge(self.volume);
        reached.to_bitmask() as u8
    }
}

/// The sum of absolute components.
#[inline(always)]
fn length<S: Simd>(a: Axes<S>) -> f32x8<S> {
    a[0].abs() + a[1].abs() + a[2].abs()
}

/// The 8×8 bit matrix transposed (Warren: *Hacker's Delight*, 7-3). Bit j of byte i goes to bit i of byte j.
#[inline(always)]
pub fn transposed(mut x: u64) -> u64 {
    for (shift, bits) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let swapped = (x ^ (x >> shift)) & bits;
        x ^= swapped ^ (swapped << shift);
    }
    x
}
