//! The reference on the CPU: lanes are triangles.

use fearless_simd::prelude::*;
use fearless_simd::{Level, u32x8};
use lightmesh_layout::constants::{MAX_ROWS, MAX_WORDS};
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::TangentPlanes;
use lightmesh_trace::simd::{LANES, dispatch};
use rayon::prelude::*;

use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::prepared::PreparedGeometry;
use crate::shadow::ShadowTarget;
use crate::shadow::cuts::Cuts;
use crate::shadow::occlusion::{Bits, Offsets, ProjectedLights, gathered};
use crate::shadow::projected_light::{Emitter, ProjectedLight};
use crate::steps::spread_out;
use crate::surface::SurfacePoint;

/// Maximum number of surface points per task.
const BATCH: usize = 256;

/// The visible share of each light from each surface point.
pub(crate) fn area_shadows(wave: &HostWave, target: &ShadowTarget) -> Visibility {
    let rows = wave.rows(target);
    let emitters = Emitter::all(wave, target, &rows);
    let mut visibility = Visibility { weighed: true, ..Visibility::dark(wave.group(), wave.hits.len()) };
    let level = Level::new();
    spread_out(visibility.parts(BATCH)).for_each(|(number, mut shares)| {
        let first = number * BATCH;
        let rays = first..wave.hits.len().min(first + BATCH);
        wave.context.piece(rays.len(), || {
            let (mut found, mut asked) = (Vec::new(), 0);
            for ray in rays.filter(|&ray| wave.sees(ray)) {
                let point = wave.shadow_point(ray);
                for (emitter, shares) in emitters.iter().zip(&mut shares) {
                    let point = emitter.seen_from(&wave.scene.geometry, &point);
                    let projected = emitter.projected(wave, ray, &point);
                    shares[ray - first] =
                        dispatch!(level, simd => share(simd, wave, emitter, &point, &projected, &mut found, &mut asked));
                }
            }
            Tally::add(&wave.context.tally.shadow_rays, asked);
        });
    });
    visibility
}

/// Finds all triangles that may hide an emitter from a point.
fn search(wave: &HostWave, emitter: &Emitter, point: &SurfacePoint, found: &mut Vec<u32>) {
    let geometry = &wave.scene.geometry;
    let origin = Bounds { min: point.origin, max: point.origin };
    let planes = TangentPlanes::new(point.origin, [(point.origin, point.normal)], 0.0);
    geometry.accelerator.triangles_in(&emitter.region(geometry, &origin).above(planes), found);
}

/// The share of an emitter that a surface point sees. Adds to `asked` how many samples are in front of the surface.
#[inline(always)]
fn share<S: Simd>(
    simd: S,
    wave: &HostWave,
    emitter: &Emitter,
    point: &SurfacePoint,
    projected: &ProjectedLight,
    found: &mut Vec<u32>,
    asked: &mut u64,
) -> f32 {
    let projected_lights = ProjectedLights::splat(simd, point, projected);
    let PreparedGeometry { triangles, alpha_mask, .. } = &*wave.scene.geometry;
    if emitter.is_point() {
        if projected_lights.center_above_horizon(simd).to_bitmask() & 1 == 0 {
            return 0.0;
        }
        *asked += 1;
        search(wave, emitter, point, found);
        let hidden = |indices| {
            let held = (gathered(simd, triangles, indices), Cuts::gathered(alpha_mask, triangles, indices));
            projected_lights.hides_center(simd, held, 0xff) != 0
        };
        return emitter.share(u32::from(!found.chunks(LANES).any(hidden)));
    }
    let mut near = emitter.weighed(&wave.scene.geometry, point).filter(|weighed| weighed.nearness > 0.0);
    let mut searched = false;
    let mut count = 0;
    for set in emitter.sets {
        let offsets = offsets(simd, set, projected);
        let mut bits = initial(simd, &projected_lights, set, &offsets, projected);
        let unhidden = words(&bits, set).map(u32::count_ones).sum::<u32>();
        if unhidden == 0 {
            continue;
        }
        *asked += u64::from(unhidden);
        if !searched {
            search(wave, emitter, point, found);
            searched = true;
        }
        for indices in found.chunks(LANES) {
            let held = (gathered(simd, triangles, indices), Cuts::gathered(alpha_mask, triangles, indices));
            projected_lights.hide(simd, held, (set, &offsets), 0xff, &mut bits);
        }
        let left = words(&bits, set).map(u32::count_ones).sum::<u32>();
        count += left;
        if let Some(weighed) = &mut near {
            weighed.count(unhidden, left);
            if emitter.sets.len() > 1 || !weighed.is_plain() {
                let bits: Vec<u32> = words(&bits, set).collect();
                weighed.add(&emitter.weights(point, projected), projected, set, &bits);
            }
        }
    }
    near.map_or_else(|| emitter.share(count), |weighed| weighed.share())
}

#[inline(always)]
fn offsets<S: Simd>(simd: S, set: &SampleRows, projected: &ProjectedLight) -> Offsets<S> {
    let mut offsets = [fearless_simd::f32x8::splat(simd, 0.0); MAX_ROWS as usize];
    for (row, offset) in offsets.iter_mut().enumerate().take(set.rows as usize) {
        *offset = fearless_simd::f32x8::splat(simd, projected.offset(set, row));
    }
    offsets
}

/// The samples that count and are above the horizon.
#[inline(always)]
fn initial<S: Simd>(
    simd: S,
    projected_lights: &ProjectedLights<S>,
    set: &SampleRows,
    offsets: &Offsets<S>,
    projected: &ProjectedLight,
) -> Bits<S> {
    let mut bits = projected_lights.above_horizon(simd, set, offsets);
    for (word, bits) in bits.iter_mut().enumerate().take(set.words as usize) {
        *bits &= u32x8::splat(simd, projected.valid_word(set, word));
    }
    bits
}

/// The samples that no lane's triangle hides, by word.
#[inline(always)]
fn words<S: Simd>(bits: &Bits<S>, set: &SampleRows) -> impl Iterator<Item = u32> {
    let words: [u32; MAX_WORDS as usize] =
        bits.map(|word| <[u32; LANES]>::from(word).into_iter().fold(!0, |a, b| a & b));
    words.into_iter().take(set.words as usize)
}
