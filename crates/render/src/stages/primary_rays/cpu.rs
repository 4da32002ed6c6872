//! Step 1 on the CPU.

use std::ops::Range;

use rayon::prelude::*;

use super::RayList;
use crate::accel::{Hit, Ray};
use crate::job::{Job, Tally};
use crate::prepared::PreparedScene;
use crate::view::View;

/// Rays that one task traces: enough to keep the dispatch cheap, few enough to balance the threads.
const BATCH: usize = 2048;

pub(crate) fn camera_rays(view: &View, rows: Range<u32>) -> RayList {
    let [width, _] = view.size();
    let pixels: Vec<u32> = (rows.start * width..rows.end * width).collect();
    let rays: Vec<Ray> = pixels.par_iter().map(|&pixel| view.ray(pixel)).collect();
    RayList { rays, pixels, weights: Vec::new() }
}

pub(crate) fn primary_rays(job: &Job, scene: &PreparedScene, list: &RayList) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; list.rays.len()];
    list.rays.par_chunks(BATCH).zip(hits.par_chunks_mut(BATCH)).for_each(|(rays, hits)| {
        if job.observer.cancelled() {
            return;
        }
        scene.accelerator.closest_hits(rays, hits);
        job.observer.advance(rays.len() as u64);
    });
    let found = hits.par_iter().filter(|hit| hit.is_some()).count() as u64;
    Tally::add(&job.tally.rays, list.rays.len() as u64);
    Tally::add(&job.tally.object_points, found);
    if list.from_camera() {
        Tally::add(&job.tally.hits, found);
    }
    hits
}
