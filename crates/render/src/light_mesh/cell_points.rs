//! The template placed at one cell, one lane per point, and the weights of formula (3).

use fearless_simd::{f32x8, mask32x8, prelude::*};
use glam::{IVec3, Vec3};
use lightmesh_scene::Weight;
use lightmesh_trace::simd::{LANES, dot, load, sum_of_lanes};

use super::mesh::LightMesh;

/// Positions of a cell's template points, one lane per point, padded with points at infinity to whole mask words.
#[derive(Clone, Debug)]
pub(crate) struct CellPoints {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    count: usize,
}

impl CellPoints {
    /// Allocates for the template of `mesh`.
    pub(crate) fn new(mesh: &LightMesh) -> CellPoints {
        let far = || vec![f32::INFINITY; mesh.template.words() * 32];
        CellPoints { x: far(), y: far(), z: far(), count: mesh.template.len() }
    }

    /// Moves the template to `cell`.
    pub(crate) fn place(&mut self, mesh: &LightMesh, cell: IVec3) {
        let (anchor, step, cell) = (mesh.lattice.anchor, mesh.lattice.step, cell.as_vec3());
        for (lane, &offset) in mesh.template.offsets().iter().enumerate() {
            // Lattice::point, with a sum of integers that is exact in f32.
            let point = anchor + step * (cell + offset.as_vec3());
            (self.x[lane], self.y[lane], self.z[lane]) = (point.x, point.y, point.z);
        }
    }

    /// Position of template point `index`.
    #[inline(always)]
    pub(crate) fn get(&self, index: usize) -> Vec3 {
        debug_assert!(index < self.count);
        Vec3::new(self.x[index], self.y[index], self.z[index])
    }

    /// Writes w of formula (3) for the points of `mask`, and 0 for all others, to `weights`, which has an entry for every lane.
    /// Returns their sum.
    #[inline(always)]
    pub(crate) fn weights<S: Simd>(
        &self,
        simd: S,
        position: Vec3,
        mesh: &LightMesh,
        mask: &[u32],
        weights: &mut [f32],
    ) -> f32 {
        let zero = f32x8::splat(simd, 0.0);
        let scale = f32x8::splat(simd, 1.0 / (mesh.radius * mesh.radius));
        let mut total = zero;
        for (part, weights) in weights.chunks_exact_mut(LANES).enumerate() {
            let bits = eight_bits(mask, part);
            if bits == 0 {
                weights.fill(0.0);
                continue;
            }
            let first = part * LANES;
            let d = [
                load(simd, &self.x, first) - position.x,
                load(simd, &self.y, first) - position.y,
                load(simd, &self.z, first) - position.z,
            ];
            let weight = weight(simd, mesh.weight, dot(d, d) * scale);
            let chosen = mask32x8::from_bitmask(simd, bits).select(weight, zero);
            chosen.store_slice(weights);
            total += chosen;
        }
        sum_of_lanes(total)
    }
}

/// The bits of eight lanes of a mask.
#[inline(always)]
fn eight_bits(mask: &[u32], part: usize) -> u64 {
    u64::from(mask[part / 4] >> (part % 4 * LANES) & 0xff)
}

/// The sum of `weights` over the lanes in both masks.
#[inline(always)]
pub(crate) fn sum_in_both<S: Simd>(simd: S, weights: &[f32], mask: &[u32], lit: &[u32]) -> f32 {
    let zero = f32x8::splat(simd, 0.0);
    let mut total = zero;
    for part in 0..weights.len() / LANES {
        let bits = eight_bits(mask, part) & eight_bits(lit, part);
        if bits != 0 {
            total += mask32x8::from_bitmask(simd, bits).select(load(simd, weights, part * LANES), zero);
        }
    }
    sum_of_lanes(total)
}

/// The sum of products of `weights` with `values`, lane by lane; weights outside the mask are 0, and not read.
#[inline(always)]
pub(crate) fn sum_of_products<S: Simd>(simd: S, weights: &[f32], mask: &[u32], values: &[f32]) -> f32 {
    let mut total = f32x8::splat(simd, 0.0);
    for part in 0..weights.len() / LANES {
        if eight_bits(mask, part) != 0 {
            total += load(simd, weights, part * LANES) * load(simd, values, part * LANES);
        }
    }
    sum_of_lanes(total)
}

/// w of formula (3) as a function of q² = (distance / radius)². Zero at the rim for all but the constant weight, so that a light
/// point that leaves the half-ball fades out instead of popping.
#[inline(always)]
pub fn weight<S: Simd>(simd: S, kind: Weight, q2: f32x8<S>) -> f32x8<S> {
    let one = f32x8::splat(simd, 1.0);
    let falling = (one - q2).max(f32x8::splat(simd, 0.0));
    match kind {
        Weight::Constant => one,
        Weight::Quadratic => falling,
        Weight::Smooth => falling * falling,
    }
}
