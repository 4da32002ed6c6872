//! The template of one cell, laid out for SIMD: one lane a light point.

use fearless_simd::{f32x8, prelude::*};
use glam::{IVec3, Vec3};

use crate::accel::triangle::Occluder;
use crate::light_mesh::LightMesh;

/// Lanes of a vector; four vectors make a word of a mask.
const LANES: usize = 8;

/// Positions of a cell's template points, padded with points at infinity to whole mask words.
#[derive(Clone, Debug)]
pub(crate) struct CellPoints {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    count: usize,
}

impl CellPoints {
    /// Room for the template of `mesh`.
    pub(crate) fn new(mesh: &LightMesh) -> CellPoints {
        let lanes = mesh.template.words() * 32;
        let far = || vec![f32::INFINITY; lanes];
        CellPoints { x: far(), y: far(), z: far(), count: mesh.template.len() }
    }

    /// Moves the template to `cell`.
    pub(crate) fn place(&mut self, mesh: &LightMesh, cell: IVec3) {
        for (lane, &offset) in mesh.template.offsets().iter().enumerate() {
            let point = mesh.lattice.point(cell + offset);
            (self.x[lane], self.y[lane], self.z[lane]) = (point.x, point.y, point.z);
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
        let axis = |lanes: &[f32], from: f32| {
            f32x8::from_slice(simd, &lanes[first..first + LANES]) - f32x8::splat(simd, from)
        };
        [axis(&self.x, from.x), axis(&self.y, from.y), axis(&self.z, from.z)]
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
    #[inline(always)]
    pub(crate) fn clear_blocked<S: Simd>(&self, simd: S, origin: Vec3, occluder: &Occluder, mask: &mut [u32]) {
        let sides = occluder.sides.map(|side| splat(simd, side));
        let volume = f32x8::splat(simd, occluder.volume);
        let zero = f32x8::splat(simd, 0.0);
        for (index, word) in mask.iter_mut().enumerate() {
            for part in 0..32 / LANES {
                let shift = part * LANES;
                if *word >> shift & 0xff == 0 {
                    continue;
                }
                let d = self.relative(simd, index * 32 + shift, origin);
                let [u, v, w] = sides.map(|side| dot(side, d));
                let inside = u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero) & (u + v + w).simd_gt(volume);
                *word &= !((inside.to_bitmask() as u32) << shift);
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

#[inline(always)]
fn splat<S: Simd>(simd: S, v: Vec3) -> [f32x8<S>; 3] {
    [f32x8::splat(simd, v.x), f32x8::splat(simd, v.y), f32x8::splat(simd, v.z)]
}

/// The same order of operations as [`Vec3::dot`].
#[inline(always)]
fn dot<S: Simd>(a: [f32x8<S>; 3], b: [f32x8<S>; 3]) -> f32x8<S> {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The lanes added in ascending order.
#[inline(always)]
fn sum<S: Simd>(lanes: f32x8<S>) -> f32 {
    let lanes: [f32; LANES] = lanes.into();
    lanes.iter().sum()
}
