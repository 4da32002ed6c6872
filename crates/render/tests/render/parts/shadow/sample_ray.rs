use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, f32x8, u32x8};
use glam::Vec3;
use lightmesh_layout::scene::SampleRows;
use lightmesh_render::SurfacePoint;
use lightmesh_render::accel::{Accelerator, Bvh, Triangle};
use lightmesh_render::internals::shadow::{Cuts, ProjectedLight, ProjectedLights, Rows, SampleRays};
use lightmesh_render::internals::simd::{LANES, dispatch, splat};

/// Numbers in [−1, 1).
struct Random(u64);

impl Random {
    fn signed(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }
}

fn soup(random: &mut Random, size: f32) -> Vec<[Vec3; 3]> {
    (0..60)
        .map(|_| {
            let middle = Vec3::Y + random.vector();
            [0; 3].map(|_| middle + size * random.vector())
        })
        .collect()
}

/// Squares that share corners, each two triangles.
fn sheet(random: &mut Random) -> Vec<[Vec3; 3]> {
    const SIDE: usize = 12;
    let corners: Vec<Vec3> = (0..=SIDE * (SIDE + 1) + SIDE)
        .map(|k| {
            let [x, z] = [k % (SIDE + 1), k / (SIDE + 1)].map(|k| k as f32 / SIDE as f32 - 0.5);
            Vec3::new(x, 1.0 + 0.05 * random.signed(), z)
        })
        .collect();
    let square = |k: usize| {
        let [a, b, c, d] = [k, k + 1, k + SIDE + 1, k + SIDE + 2].map(|k| corners[k]);
        [[a, b, d], [a, d, c]]
    };
    (0..SIDE * (SIDE + 1)).filter(|k| k % (SIDE + 1) < SIDE).flat_map(square).collect()
}

/// The samples of a word that rows, and rays, find hidden.
#[inline(always)]
fn hidden<S: Simd>(
    simd: S,
    bvh: &Bvh,
    triangles: &[Triangle],
    (point, projected): (&SurfacePoint, &ProjectedLight),
    set: &SampleRows,
) -> Vec<[u32; 2]> {
    let projected_lights = ProjectedLights::splat(simd, point, projected);
    let mut offsets = [f32x8::splat(simd, 0.0); 20];
    for (row, offset) in offsets.iter_mut().enumerate().take(set.rows as usize) {
        *offset = f32x8::splat(simd, projected.offset(set, row));
    }
    let mut seen = set.full.map(|full| u32x8::splat(simd, full));
    for triangle in triangles {
        let corners = triangle.corners().map(|corner| splat(simd, corner));
        projected_lights.hide(
            simd,
            (corners, Cuts::splat(bvh.alpha_mask(), triangle.cut())),
            (set, &offsets),
            0xff,
            &mut seen,
        );
    }
    let mut rays = SampleRays::default();
    let words = seen.iter().enumerate().take(set.words as usize);
    words
        .map(|(word, &seen)| {
            rays.most = u32::MAX;
            let arrive = rays.cast(simd, (bvh, 1.0), (point, projected), (set, word), set.full[word]);
            [<[u32; LANES]>::from(seen)[0], arrive].map(|seen| set.full[word] & !seen)
        })
        .collect()
}

#[test]
fn rays_have_the_bits_of_rows() {
    let mut random = Random(7);
    let mut counts = [0; 2];
    for samples in [1, 16, 64, 225] {
        let rows = Rows::new(samples);
        for trial in 0..20 {
            let corners = match trial % 4 {
                0 => sheet(&mut random),
                kind => soup(&mut random, [0.02, 0.2, 1.0][kind - 1]),
            };
            let triangles: Vec<Triangle> =
                corners.into_iter().zip(0..).map(|(corners, index)| Triangle::new(corners, index)).collect();
            let bvh = Bvh::new(&triangles);
            assert_eq!(bvh.name(), "bvh");
            let origin = 0.1 * random.vector();
            let point =
                SurfacePoint { position: origin, origin, normal: (Vec3::Y + 0.9 * random.vector()).normalize() };
            let center = Vec3::Y * 3.0 + random.vector();
            let projected = ProjectedLight {
                center,
                along: random.vector(),
                across: random.vector(),
                end: 1.0 / (1.0 - 1e-6),
                shift: 0.5 + 0.5 * random.signed(),
                inside: 1.0,
                choice: 0,
            };
            for set in [&rows.disc[0], &rows.rectangle[0]] {
                let found = dispatch!(Level::new(), simd => hidden(simd, &bvh, &triangles, (&point, &projected), set));
                counts[1] += set.count.iter().sum::<u32>();
                for [rows, rays] in found {
                    assert_eq!(rows, rays, "{samples} samples, trial {trial}");
                    counts[0] += rows.count_ones();
                }
            }
        }
    }
    assert!(counts[0] > 1000 && counts[0] < counts[1], "{counts:?} are hidden");
}
