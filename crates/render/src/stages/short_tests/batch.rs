//! Eight object points of one cell at a time, one lane a point; light points and triangles are the same for all lanes.

use fearless_simd::{f32x8, prelude::*};
use glam::Vec3;

use super::cells::Candidate;
use super::lanes::{Axes, LANES, cross, difference, dot, scaled, splat};
use super::{CellPoints, MaskCounts};
use crate::light_mesh::LightMesh;
use crate::surface::SurfacePoint;

/// Up to eight object points and, for each light point of the template, the lanes that still see it.
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
        let seen = vec![0; mesh.template.words() * 32];
        Batch { position: lanes(), origin: lanes(), normal: lanes(), lanes: 0, seen }
    }

    /// Takes in object points, at most eight.
    pub(super) fn fill(&mut self, points: impl Iterator<Item = SurfacePoint>) {
        self.lanes = 0;
        for (lane, point) in points.enumerate() {
            for axis in 0..3 {
                self.position[axis][lane] = point.position[axis];
                self.origin[axis][lane] = point.origin[axis];
                self.normal[axis][lane] = point.normal[axis];
            }
            self.lanes |= 1 << lane;
        }
    }

    /// The masks of the object points, one after the other.
    #[inline(always)]
    pub(super) fn masks<S: Simd>(
        &mut self,
        simd: S,
        mesh: &LightMesh,
        points: &CellPoints,
        candidates: &[Candidate],
        masks: &mut [u32],
    ) -> MaskCounts {
        // 1, 2. The half-balls.
        let sizes = self.half_balls(simd, mesh, points);

        // 3. What stands in their way.
        let mut tested = 0;
        for candidate in candidates {
            if let Some((occluders, lanes)) = self.occluders(simd, mesh, &candidate.corners) {
                tested |= lanes;
                self.clear_blocked(simd, mesh, points, candidate, &occluders, lanes);
            }
        }

        self.write(mesh.template.words(), masks);
        let mut counts = MaskCounts::default();
        for (lane, &size) in sizes.iter().enumerate() {
            counts.half_ball += size as u64;
            counts.tested += if tested >> lane & 1 != 0 { size as u64 } else { 0 };
        }
        counts.used = super::population(masks);
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
            let inside = dot(d, d).simd_lt(square) & dot(normal, d).simd_gt(least);
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

    /// [`ShortTest::occluder`](crate::accel::ShortTest::occluder) in each lane, with the same operations in the same order, and
    /// the lanes in which there is one.
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
        (lanes != 0).then_some((Occluders { sides, volume: sign * volume }, lanes))
    }

    /// [`Occluder::blocks`](crate::accel::triangle::Occluder::blocks) in each of `lanes`, for the light points that the
    /// candidate's shadow can reach.
    #[inline(always)]
    fn clear_blocked<S: Simd>(
        &mut self,
        simd: S,
        mesh: &LightMesh,
        points: &CellPoints,
        candidate: &Candidate,
        occluders: &Occluders<S>,
        lanes: u8,
    ) {
        let zero = f32x8::splat(simd, 0.0);
        let origin = self.load(simd, &self.origin);
        let Occluders { sides: [a, b, c], volume } = *occluders;
        let (low, high) = (candidate.low, candidate.high);
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                for bit in mesh.template.row(y, z, low.x, high.x) {
                    if self.seen[bit] & lanes == 0 {
                        continue;
                    }
                    let d = difference(splat(simd, points.get(bit)), origin);
                    let (u, v, w) = (dot(a, d), dot(b, d), dot(c, d));
                    let inside = u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero) & (u + v + w).simd_gt(volume);
                    self.seen[bit] &= !(inside.to_bitmask() as u8 & lanes);
                }
            }
        }
    }

    /// From lanes by light point to light points by lane: the masks, `words` for each object point.
    #[inline(always)]
    fn write(&self, words: usize, masks: &mut [u32]) {
        for (group, seen) in self.seen.chunks_exact(8).enumerate() {
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

/// A triangle as seen from eight origins.
#[derive(Clone, Copy)]
struct Occluders<S: Simd> {
    sides: [Axes<S>; 3],
    volume: f32x8<S>,
}

/// The 8×8 bit matrix mirrored at its diagonal (Warren: *Hacker's Delight*, 7-3). Bit j of byte i goes to bit i of byte j.
#[inline(always)]
fn transposed(mut x: u64) -> u64 {
    for (shift, bits) in [(7, 0x00aa_00aa_00aa_00aa), (14, 0x0000_cccc_0000_cccc), (28, 0x0000_0000_f0f0_f0f0)] {
        let swapped = (x ^ (x >> shift)) & bits;
        x ^= swapped ^ (swapped << shift);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_change_places_with_bytes() {
        for byte in 0..8 {
            for bit in 0..8 {
                assert_eq!(transposed(1 << (8 * byte + bit)), 1 << (8 * bit + byte));
            }
        }
    }
}
