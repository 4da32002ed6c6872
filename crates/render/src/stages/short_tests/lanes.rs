//! The template of one cell, laid out for SIMD: one lane a light point.

use fearless_simd::{f32x8, prelude::*};
use glam::{IVec3, Vec3};

use crate::accel::triangle::Occluder;
use crate::light_mesh::LightMesh;

/// Lanes of a vector; four vectors make a word of a mask.
pub(super) const LANES: usize = 8;

/// Positions of a cell's template points, padded with points at infinity to whole mask words, and the boxes around each eight.
#[derive(Clone, Debug)]
pub(crate) struct CellPoints {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    clusters: Clusters,
    count: usize,
}

/// The boxes around the points of each vector, one lane a box, padded to whole vectors.
#[derive(Clone, Debug)]
struct Clusters {
    center: [Vec<f32>; 3],
    half: [Vec<f32>; 3],
}

impl CellPoints {
    /// Room for the template of `mesh`.
    pub(crate) fn new(mesh: &LightMesh) -> CellPoints {
        let lanes = mesh.template.words() * 32;
        let far = || vec![f32::INFINITY; lanes];
        let boxes = mesh.template.clusters();
        let room = || vec![0.0; boxes.len().next_multiple_of(LANES)];
        let mut clusters = Clusters { center: std::array::from_fn(|_| room()), half: std::array::from_fn(|_| room()) };
        for (index, cluster) in boxes.iter().enumerate() {
            for axis in 0..3 {
                // The slack covers all rounding of the tests that a box stands for.
                clusters.half[axis][index] = mesh.lattice.step * cluster.half[axis] + mesh.slack();
            }
        }
        CellPoints { x: far(), y: far(), z: far(), clusters, count: mesh.template.len() }
    }

    /// Moves the template to `cell`.
    pub(crate) fn place(&mut self, mesh: &LightMesh, cell: IVec3) {
        let (origin, step, cell) = (mesh.lattice.origin, mesh.lattice.step, cell.as_vec3());
        for (lane, &offset) in mesh.template.offsets().iter().enumerate() {
            // Lattice::point, written out for the compiler to vectorize.
            let point = origin + step * (cell + offset.as_vec3());
            (self.x[lane], self.y[lane], self.z[lane]) = (point.x, point.y, point.z);
        }
        for (index, cluster) in mesh.template.clusters().iter().enumerate() {
            let center = origin + step * (cell + cluster.center);
            for axis in 0..3 {
                self.clusters.center[axis][index] = center[axis];
            }
        }
    }

    /// Position of template point `index`.
    #[inline(always)]
    pub(crate) fn get(&self, index: usize) -> Vec3 {
        debug_assert!(index < self.count);
        Vec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// The vector of lanes `first..first + LANES`, relative to `from`.
    #[inline(always)]
    fn relative<S: Simd>(&self, simd: S, first: usize, from: Vec3) -> [f32x8<S>; 3] {
        [
            load(simd, &self.x, first) - from.x,
            load(simd, &self.y, first) - from.y,
            load(simd, &self.z, first) - from.z,
        ]
    }

    /// Conditions 1 and 2 of formula (2): fills `mask` with the half-ball of `position` over the plane with `normal`.
    #[inline(always)]
    pub(crate) fn half_ball<S: Simd>(
        &self,
        simd: S,
        position: Vec3,
        normal: Vec3,
        mesh: &LightMesh,
        mask: &mut [u32],
    ) {
        let square = f32x8::splat(simd, mesh.radius * mesh.radius);
        let least = f32x8::splat(simd, mesh.least_height());
        for (index, word) in mask.iter_mut().enumerate() {
            *word = 0;
            for part in 0..32 / LANES {
                let d = self.relative(simd, index * 32 + part * LANES, position);
                let near = dot(d, d).simd_lt(square);
                let above = dot(splat(simd, normal), d).simd_gt(least);
                *word |= ((near & above).to_bitmask() as u32) << (part * LANES);
            }
        }
    }

    /// Condition 3 of formula (2) for one triangle: clears the bits of `mask` whose segments from `origin` it blocks.
    ///
    /// Eight clusters at once are held against the triangle's shadow; only those that it can reach are tested point by point.
    #[inline(always)]
    pub(crate) fn clear_blocked<S: Simd>(&self, simd: S, origin: Vec3, occluder: &Occluder, mask: &mut [u32]) {
        // No `map` over arrays here: where it is not inlined, vectors travel through memory.
        let [a, b, c] = occluder.sides;
        let (a, b, c) = (splat(simd, a), splat(simd, b), splat(simd, c));
        let volume = f32x8::splat(simd, occluder.volume);
        let zero = f32x8::splat(simd, 0.0);
        for first in (0..self.clusters.half[0].len()).step_by(LANES) {
            // 1. Clusters that have a bit left. Eight of them are two words; the second may lie beyond the mask.
            let word = first / 4;
            let upper = mask.get(word + 1).copied().unwrap_or(0);
            let mut active = occupied_bytes(u64::from(upper) << 32 | u64::from(mask[word]));
            if active == 0 {
                continue;
            }
            // 2. Clusters that reach into the shadow.
            let (center, half) = self.clusters.relative(simd, first, origin);
            let (u, v, w) = (dot(a, center), dot(b, center), dot(c, center));
            let (eu, ev, ew) = (dot(abs(a), half), dot(abs(b), half), dot(abs(c), half));
            let reached = (u + eu).simd_ge(zero)
                & (v + ev).simd_ge(zero)
                & (w + ew).simd_ge(zero)
                & (u + v + w + (eu + ev + ew)).simd_gt(volume);
            active &= reached.to_bitmask() as u32;
            // 3. Their points.
            while active != 0 {
                let cluster = first + active.trailing_zeros() as usize;
                active &= active - 1;
                let d = self.relative(simd, cluster * LANES, origin);
                let (u, v, w) = (dot(a, d), dot(b, d), dot(c, d));
                let inside = u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero) & (u + v + w).simd_gt(volume);
                mask[cluster / 4] &= !((inside.to_bitmask() as u32) << (cluster % 4 * LANES));
            }
        }
    }

    /// Σw and Σw·value of formula (3) over the points of `mask`; `values` has a value for every lane.
    #[inline(always)]
    pub(crate) fn weighted<S: Simd>(
        &self,
        simd: S,
        position: Vec3,
        mesh: &LightMesh,
        mask: &[u32],
        values: &[f32],
    ) -> (f32, f32) {
        let zero = f32x8::splat(simd, 0.0);
        let one = f32x8::splat(simd, 1.0);
        let scale = f32x8::splat(simd, 1.0 / (mesh.radius * mesh.radius));
        let (mut weights, mut products) = (zero, zero);
        for (index, &word) in mask.iter().enumerate() {
            for part in 0..32 / LANES {
                let bits = word >> (part * LANES) & 0xff;
                if bits == 0 {
                    continue;
                }
                let first = index * 32 + part * LANES;
                let d = self.relative(simd, first, position);
                let falling = (one - dot(d, d) * scale).max(zero);
                let weight = match mesh.weight {
                    lightmesh_scene::Weight::Constant => one,
                    lightmesh_scene::Weight::Quadratic => falling,
                    lightmesh_scene::Weight::Smooth => falling * falling,
                };
                let chosen = fearless_simd::mask32x8::from_bitmask(simd, u64::from(bits)).select(weight, zero);
                weights += chosen;
                products += chosen * f32x8::from_slice(simd, &values[first..first + LANES]);
            }
        }
        (sum(weights), sum(products))
    }
}

impl Clusters {
    /// Eight boxes from `first` on: middles relative to `from`, and half edges.
    #[inline(always)]
    fn relative<S: Simd>(&self, simd: S, first: usize, from: Vec3) -> ([f32x8<S>; 3], [f32x8<S>; 3]) {
        let [x, y, z] = &self.center;
        let center = [
            load(simd, x, first) - from.x,
            load(simd, y, first) - from.y,
            load(simd, z, first) - from.z,
        ];
        let [x, y, z] = &self.half;
        (center, [load(simd, x, first), load(simd, y, first), load(simd, z, first)])
    }
}

/// Bit k: byte k of `word` is not zero.
#[inline(always)]
fn occupied_bytes(word: u64) -> u32 {
    const LOW: u64 = 0x7f7f_7f7f_7f7f_7f7f;
    let top = (((word & LOW) + LOW) | word) & !LOW;
    // The product gathers the eight top bits in the highest byte.
    ((top >> 7).wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
}

#[inline(always)]
fn load<S: Simd>(simd: S, lanes: &[f32], first: usize) -> f32x8<S> {
    f32x8::from_slice(simd, &lanes[first..first + LANES])
}

#[inline(always)]
fn abs<S: Simd>(a: [f32x8<S>; 3]) -> [f32x8<S>; 3] {
    [a[0].abs(), a[1].abs(), a[2].abs()]
}

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, v: Vec3) -> [f32x8<S>; 3] {
    [f32x8::splat(simd, v.x), f32x8::splat(simd, v.y), f32x8::splat(simd, v.z)]
}

/// The same order of operations as [`Vec3::dot`].
#[inline(always)]
pub(super) fn dot<S: Simd>(a: [f32x8<S>; 3], b: [f32x8<S>; 3]) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The lanes added in ascending order.
#[inline(always)]
fn sum<S: Simd>(lanes: f32x8<S>) -> f32 {
    let lanes: [f32; LANES] = lanes.into();
    lanes.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn occupied_bytes_are_told_apart() {
        for pattern in 0..256u32 {
            let word = (0..8).filter(|byte| pattern >> byte & 1 != 0).map(|byte| 0x80u64 >> (byte % 8) << (8 * byte));
            assert_eq!(occupied_bytes(word.sum()), pattern);
        }
    }
}
