//! Triangles that are cut out, and samples in rows: which samples a triangle hides where there is any of it. Twin: `stopped_samples` in
//! `occlusion.cuh`.
//!
//! Rows say which samples the whole triangle would hide; here each of these asks alone, with [`AlphaMask::stops`]. Lanes are taken apart: what
//! is decided differs from sample to sample, and most triangles are opaque.

use fearless_simd::prelude::*;
use glam::Vec3;
use lightmesh_layout::constants::{MAX_ROWS, MAX_WORDS};
use lightmesh_layout::scene::SampleRows;
use lightmesh_trace::accel::{AlphaMask, Triangle, Triangles};
use lightmesh_trace::simd::{Axes, LANES};

use super::projected_light::ProjectedLight;

/// What is cut out of the triangles of eight lanes.
#[derive(Clone, Copy)]
pub struct Cuts<'a> {
    alpha_mask: &'a AlphaMask,
    /// The number of each lane's triangle; 0 if it is opaque.
    numbers: [u32; LANES],
}

impl<'a> Cuts<'a> {
    /// One triangle in all lanes; `None` if it is opaque.
    #[inline(always)]
    pub fn splat(alpha_mask: &'a AlphaMask, number: u32) -> Option<Cuts<'a>> {
        (number != 0).then_some(Cuts { alpha_mask, numbers: [number; LANES] })
    }

    /// Those of [gathered](super::occlusion::gathered) triangles; `None` if all are opaque.
    #[inline(always)]
    pub(crate) fn gathered(alpha_mask: &'a AlphaMask, triangles: &Triangles, indices: &[u32]) -> Option<Cuts<'a>> {
        let number = |lane: usize| triangles.at(indices[lane.min(indices.len() - 1)]).cut();
        let numbers = std::array::from_fn(number);
        (numbers != [0; LANES]).then_some(Cuts { alpha_mask, numbers })
    }

    /// The triangle of a lane.
    fn triangle(&self, from: &Lines, lane: usize) -> Triangle {
        Triangle::new(from.corners.map(|corner| corner[lane]), 0).alpha_tested(self.numbers[lane])
    }
}

/// Surface points, the light as each sees it, and triangles, lane by lane.
pub(super) struct Lines {
    pub(super) origin: [Vec3; LANES],
    pub(super) center: [Vec3; LANES],
    pub(super) along: [Vec3; LANES],
    pub(super) across: [Vec3; LANES],
    pub(super) corners: [[Vec3; LANES]; 3],
}

/// Eight vectors as they are in lanes.
#[inline(always)]
pub(super) fn by_lane<S: Simd>([x, y, z]: Axes<S>) -> [Vec3; LANES] {
    let (x, y, z): ([f32; LANES], [f32; LANES], [f32; LANES]) = (x.into(), y.into(), z.into());
    let mut vectors = [Vec3::ZERO; LANES];
    for lane in 0..LANES {
        vectors[lane] = Vec3::new(x[lane], y[lane], z[lane]);
    }
    vectors
}

/// Keeps those of the samples, by word and lane, whose ray a triangle stops where it is not cut out.
#[inline(never)]
pub(super) fn keep_stopped(
    cuts: &Cuts,
    from: &Lines,
    (set, offsets): (&SampleRows, &[[f32; LANES]; MAX_ROWS as usize]),
    lanes: u32,
    samples: &mut [[u32; LANES]; MAX_WORDS as usize],
) {
    for lane in (0..LANES).filter(|&lane| lanes >> lane & 1 != 0 && cuts.numbers[lane] != 0) {
        let triangle = cuts.triangle(from, lane);
        let projected = ProjectedLight {
            center: from.center[lane],
            along: from.along[lane],
            across: from.across[lane],
            ..ProjectedLight::default()
        };
        let mut row = 0;
        for (word, samples) in samples.iter_mut().enumerate().take(set.words as usize) {
            let mut rest = samples[lane];
            while rest != 0 {
                let bit = rest.trailing_zeros();
                rest &= rest - 1;
                while row + 1 < set.ends[word] as usize && set.place[row] + set.count[row] <= bit {
                    row += 1;
                }
                let target = projected.scaled_sample(set, row, (bit - set.place[row]) as f32, offsets[row][lane]);
                if !cuts.alpha_mask.stops(&triangle, from.origin[lane], target) {
                    samples[lane] &= !(1 << bit);
                }
            }
            row = set.ends[word] as usize;
        }
    }
}

/// Those of `lanes` whose ray to the centre a triangle stops where it is not cut out.
#[inline(never)]
pub(super) fn stopped_centers(cuts: &Cuts, from: &Lines, lanes: u32) -> u32 {
    let stops = |&lane: &usize| {
        let (origin, center) = (from.origin[lane], from.center[lane]);
        lanes >> lane & 1 != 0 && cuts.alpha_mask.stops(&cuts.triangle(from, lane), origin, center)
    };
    (0..LANES).filter(stops).fold(0, |all, lane| all | 1 << lane)
}
