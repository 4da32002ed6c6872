//! The samples of pixels on the CPU.

use std::sync::Arc;

use glam::Vec3;
use lightmesh_layout::constants::PIXEL_SHARED;
use rayon::prelude::*;

use super::SampleRange;
use super::alike::{Facet, mirrors};
use crate::accel::{Hit, Ray};
use crate::counters::Tally;
use crate::data::picture::Picture;
use crate::data::rays::{RayList, Sampled};
use crate::data::samples::PixelSamples;
use crate::footprint::Cone;
use crate::job::Job;
use crate::prepared::PreparedScene;

/// Number of pixels per task.
const BATCH: usize = 256;

/// What the samples of pixels see. Takes away from `hits`, those of the centres, what is not shared.
pub(crate) fn pixel_samples(
    job: &Job,
    scene: &PreparedScene,
    rays: &mut RayList,
    hits: &mut [Hit],
    film: &mut Picture,
    range: &SampleRange,
) -> PixelSamples {
    let SampleRange { all, numbers } = range;
    let view = rays.view.expect("the rays are a camera's");
    let (pixels, first) = (rays.pixels.len(), film.rows.start * view.size()[0]);

    if !scene.geometry.mip_levels.is_empty() {
        rays.cone = Cone::of_sample(rays.spacing, all.samples);
    }

    // 1. What each sample sees. Rays through a pixel follow each other: they are coherent.
    let count = numbers.len();
    let mut all_hits = vec![Hit::MISS; pixels * count];
    let found = rays.pixels.par_chunks(BATCH).map(|pixels| {
        job.piece(pixels.len() * count, || {
            let through = |&pixel: &u32| {
                let pattern = all.pattern(view.window().number(pixel));
                numbers.clone().map(move |sample| view.ray_beside(pixel, all.within(&pattern, sample)))
            };
            let rays: Vec<Ray> = pixels.iter().flat_map(through).collect();
            let mut hits = vec![Hit::MISS; rays.len()];
            scene.geometry.accelerator.closest_hits(&rays, &mut hits);
            hits
        })
    });
    let found: Vec<Vec<Hit>> = found.collect();
    let in_order = found.iter().flat_map(|hits| hits.chunks_exact(count));
    for (&pixel, hits) in rays.pixels.iter().zip(in_order) {
        all_hits[(pixel - first) as usize * count..][..count].copy_from_slice(hits);
    }
    Tally::add(&job.tally.rays, all_hits.len() as u64);
    let mut samples =
        PixelSamples { hits: Arc::new(all_hits), state: vec![0; pixels], first, numbers: numbers.clone() };
    nearest(scene, rays, &samples, film, range);
    if all.apart {
        return samples;
    }

    // 2. Which pixels are shared?
    let states: Vec<u32> = rays
        .pixels
        .par_iter()
        .zip(&mut *hits)
        .zip(&rays.rays)
        .map(|((&pixel, hit), ray)| {
            let alike = |(sample, other): (usize, &Hit)| {
                is_alike(hit, other, || {
                    let beside = all.ray(&view, pixel, sample as u32);
                    let facet = |ray, hit| Facet::new(scene, rays.spacing, ray, hit);
                    facet(ray, hit).continues(&facet(&beside, other))
                })
            };
            // Each sample has a mirror ray of its own.
            let shared = !mirrors(scene, all, hit) && samples.of(pixel).enumerate().all(alike);
            if !shared && !all.keeps {
                *hit = Hit::MISS;
            }
            u32::from(shared) * PIXEL_SHARED
        })
        .collect();
    for (&pixel, state) in rays.pixels.iter().zip(states) {
        samples.state[(pixel - first) as usize] = state;
    }
    rays.sampled = Some(Sampled { hits: Arc::clone(&samples.hits), first, count });
    samples
}

/// Whether two hits of a pixel may be shaded together; `continues` decides for different triangles.
#[inline(always)]
pub(crate) fn is_alike(a: &Hit, b: &Hit, continues: impl FnOnce() -> bool) -> bool {
    a.triangle == b.triangle || a.is_some() && b.is_some() && continues()
}

/// Coverage, and the layers of the nearest samples.
fn nearest(scene: &PreparedScene, rays: &RayList, samples: &PixelSamples, film: &mut Picture, range: &SampleRange) {
    let SampleRange { all, numbers } = range;
    let view = rays.view.expect("the rays are a camera's");
    let weight = 1.0 / all.samples as f32;
    if let Some(coverage) = &mut film.coverage {
        for (pixel, coverage) in (samples.first..).zip(coverage) {
            for _ in samples.of(pixel).filter(|hit| hit.is_some()) {
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
                    let facet = Facet::new(scene, rays.spacing, &ray, hit);
                    (facet.point.position, facet.point.normal)
                };
                layers.depth[index] = hit.t;
                layers.position[index] = scene.scene.to_world(point.0).as_vec3().to_array();
                layers.normal[index] = point.1.to_array();
            }
        }
    }
}
