//! The samples of pixels on the CPU.

use std::sync::Arc;

use fearless_simd::Level;
use glam::Vec3;
use lightmesh_layout::constants::PIXEL_SHARED;
use lightmesh_trace::accel::{Hit, Ray};
use rayon::prelude::*;

use super::SampleRange;
use super::same_surface::{Facet, Surfaces, is_transmissive};
use crate::counters::Tally;
use crate::data::clip::{Clip, Limits};
use crate::data::mattes::count;
use crate::data::picture::Picture;
use crate::data::rays::{RayList, Sampled};
use crate::data::samples::PixelSamples;
use crate::data::wave::{HostWave, Wave};
use crate::footprint::Cone;
use crate::prepared::PreparedScene;
use crate::shading::ids::ids_of;
use crate::steps::spread_out;

/// Number of pixels per task.
const BATCH: usize = 256;
/// Number of pixels of a beam.
const BEAM: usize = 8;

/// What the samples of pixels see; and the wave's rays and hits, those of the centres, without the hits of what is not shared.
pub(crate) fn pixel_samples(
    wave: &HostWave,
    film: &mut Picture,
    range: &SampleRange,
) -> (PixelSamples, RayList, Vec<Hit>) {
    let SampleRange { all, numbers } = range;
    let Wave { context, scene, .. } = *wave;
    let (mut rays, mut hits) = (wave.rays.clone(), wave.hits.clone());
    let view = rays.view.expect("the rays are a camera's");
    let (pixels, first) = (rays.pixels.len(), film.rows.start * view.size()[0]);

    if scene.has_cones() {
        rays.cone = Cone::of_sample(rays.spacing, all.samples, all.breadth);
    }

    // 1. What each sample sees. The rays through a pixel follow each other: they are coherent.
    let (level, count) = (Level::new(), numbers.len());
    let depths = Depths::new(&rays, &hits, first);
    let mut all_hits: Vec<Hit> = bytemuck::zeroed_vec(pixels * count);
    spread_out(all_hits.chunks_mut(BATCH * count)).for_each_init(
        || (Vec::new(), Vec::new(), scene.geometry.beams()),
        |(rays, limits, beams), (batch, hits)| {
            context.piece(hits.len(), || {
                let start = batch * BATCH;
                let pixels = first + start as u32..first + (start + hits.len() / count) as u32;
                all.rays(level, &view, pixels, numbers.clone(), rays);
                clip(&view.clip(), rays, limits);
                beams.closest_hits(rays, BEAM * count, |beam| depths.around(start + beam * BEAM), hits);
                hits.iter_mut().zip(&*limits).for_each(|(hit, limits)| *hit = limits.from_origin(*hit));
            });
        },
    );
    Tally::add(&context.tally.rays, all_hits.len() as u64);
    let mut samples = PixelSamples {
        hits: Arc::new(all_hits),
        state: vec![0; pixels],
        owners: Vec::new(),
        first,
        numbers: numbers.clone(),
    };
    count_ids(scene, &samples, film);
    nearest(scene, &rays, &samples, film, range);
    if all.apart {
        return (samples, rays, hits);
    }

    // 2. Which pixels are shared, and which samples of the others lie on one surface?
    samples.owners = vec![0; pixels * count];
    let parted: Vec<Parted> = (rays.pixels.par_chunks(BATCH), hits.par_chunks_mut(BATCH), rays.rays.par_chunks(BATCH))
        .into_par_iter()
        .map(|(pixels, hits, through)| {
            let mut parted = Parted::default();
            for ((&pixel, hit), ray) in pixels.iter().zip(hits).zip(through) {
                let others = samples.of(pixel);
                // Each sample has a ray of its own behind the surface.
                let may_share = !is_transmissive(scene, hit);
                // Most pixels need no surfaces.
                if may_share && others.iter().all(|other| other.triangle == hit.triangle) {
                    parted.shared.push(pixel);
                    continue;
                }
                let mut surfaces = Surfaces::new(scene, &rays, all, (ray, *hit), (pixel, others));
                if may_share && surfaces.is_shared() {
                    parted.shared.push(pixel);
                    continue;
                }
                parted.others.push(pixel);
                surfaces.add_owners(&mut parted.owners);
                if !all.keeps {
                    *hit = Hit::MISS;
                }
            }
            parted
        })
        .collect();
    for Parted { shared, others, owners } in parted {
        for pixel in shared {
            samples.state[(pixel - first) as usize] = PIXEL_SHARED;
        }
        for (pixel, owners) in others.into_iter().zip(owners.chunks_exact(count)) {
            samples.owners[(pixel - first) as usize * count..][..count].copy_from_slice(owners);
        }
    }
    rays.sampled = Some(Sampled { hits: Arc::clone(&samples.hits), first, count });
    (samples, rays, hits)
}

/// Rays between their limits, and these; no limits if all depths are seen.
fn clip(clip: &Clip, rays: &mut [Ray], limits: &mut Vec<Limits>) {
    limits.clear();
    if clip.cuts() {
        limits.extend(rays.iter().map(|ray| clip.limits(ray)));
        rays.iter_mut().zip(limits).for_each(|(ray, limits)| *ray = limits.between(ray));
    }
}

/// How far the centres of pixels see.
struct Depths {
    by_pixel: Vec<f32>,
}

impl Depths {
    fn new(rays: &RayList, hits: &[Hit], first: u32) -> Depths {
        let mut by_pixel = vec![0.0; hits.len()];
        for (&pixel, hit) in rays.pixels.iter().zip(hits) {
            by_pixel[(pixel - first) as usize] = hit.t;
        }
        Depths { by_pixel }
    }

    /// About how far the samples of the pixels of a beam see; `None` if some centre sees nothing.
    fn around(&self, start: usize) -> Option<f32> {
        let depths = &self.by_pixel[start..self.by_pixel.len().min(start + BEAM)];
        let (nearest, farthest) =
            depths.iter().fold((f32::INFINITY, 0.0_f32), |(low, high), &depth| (low.min(depth), high.max(depth)));
        (farthest < f32::INFINITY).then_some(farthest + 1.5 * (farthest - nearest) + 0.01 * farthest)
    }
}

/// The pixels of a batch: those that are shared, and the others with the owners of their samples.
#[derive(Default)]
struct Parted {
    shared: Vec<u32>,
    others: Vec<u32>,
    owners: Vec<u8>,
}

/// The numbers of what samples see: how many see each, and the nearest one's.
fn count_ids(scene: &PreparedScene, samples: &PixelSamples, film: &mut Picture) {
    let (Some(counted), Some(layers)) = (&mut film.counted, &mut film.layers) else { return };
    let nearest = layers.object.nearest.par_iter_mut().zip(&mut layers.material.nearest).zip(&layers.depth);
    let hits = samples.hits.par_chunks_exact(samples.numbers.len());
    counted.pixels().zip(nearest).zip(hits).with_min_len(BATCH).for_each(|((mut slots, nearest), hits)| {
        let ((object, material), &(mut depth)) = nearest;
        for hit in hits.iter().filter(|hit| hit.is_some()) {
            let ids = ids_of(scene, hit);
            count(&mut slots, ids);
            if hit.t < depth {
                depth = hit.t;
                [*object, *material] = ids;
            }
        }
    });
}

/// Coverage, and the layers of the nearest samples.
fn nearest(scene: &PreparedScene, rays: &RayList, samples: &PixelSamples, film: &mut Picture, range: &SampleRange) {
    let SampleRange { all, numbers } = range;
    let view = rays.view.expect("the rays are a camera's");
    let weight = 1.0 / all.samples as f32;
    if let Some(coverage) = &mut film.coverage {
        for (pixel, coverage) in (samples.first..).zip(coverage) {
            for _ in samples.of(pixel).iter().filter(|hit| hit.is_some()) {
                *coverage += weight;
            }
        }
    }
    let Some(layers) = &mut film.layers else { return };
    for (index, pixel) in (samples.first..).enumerate().take(samples.state.len()) {
        for (sample, hit) in numbers.clone().zip(samples.of(pixel)).filter(|(_, hit)| hit.is_some()) {
            if hit.t < layers.depth[index] {
                let ray = all.ray(&view, pixel, sample);
                let point: (Vec3, Vec3) = {
                    let facet = Facet::seen(scene, rays.spacing, &ray, hit);
                    (facet.point.position, facet.point.normal)
                };
                layers.depth[index] = hit.t;
                layers.position[index] = scene.scene.to_world(point.0).as_vec3().to_array();
                layers.normal[index] = point.1.to_array();
            }
        }
    }
}
