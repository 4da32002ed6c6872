//! Step 1 on the CPU: camera rays in blocks of pixels, so that consecutive rays are coherent.

use std::ops::Range;

use lightmesh_layout::constants::TILE_SIDE;
use lightmesh_trace::accel::{Accelerator, Hit, Ray};
use rayon::prelude::*;

use crate::counters::Tally;
use crate::data::clip::Limits;
use crate::data::rays::RayList;
use crate::prepared::PreparedScene;
use crate::render_context::RenderContext;
use crate::steps::spread_out;
use crate::view::View;

/// Number of rays per task, at most: enough to keep the dispatch cheap, few enough to balance the threads.
const BATCH: usize = 2048;

pub(crate) fn camera_rays(view: &View, rows: Range<u32>) -> RayList {
    let pixels = blocks_of_pixels(view.size()[0], rows);
    let rays: Vec<Ray> = pixels.par_iter().map(|&pixel| view.ray(pixel)).collect();
    let (spacing, window, clip) = (view.spacing(), view.window(), view.clip());
    RayList { rays, pixels, spacing, eye: view.origin(), clip, view: Some(*view), window, ..RayList::default() }
}

/// The pixels of some rows in blocks of 4×2 within 8×8 within 32×32, so that consecutive rays are coherent.
pub fn blocks_of_pixels(width: u32, rows: Range<u32>) -> Vec<u32> {
    let mut pixels = Vec::with_capacity((width * (rows.end - rows.start)) as usize);
    let cut = |range: Range<u32>, size: u32| {
        range.clone().step_by(size as usize).map(move |first| first..range.end.min(first + size))
    };
    let blocks = |rows: Range<u32>, columns: Range<u32>, size: [u32; 2]| {
        cut(rows, size[1])
            .flat_map(move |rows| cut(columns.clone(), size[0]).map(move |columns| (rows.clone(), columns)))
    };
    for (rows, columns) in blocks(rows, 0..width, [TILE_SIDE; 2]) {
        for (rows, columns) in blocks(rows, columns, [8, 8]) {
            for (rows, columns) in blocks(rows, columns, [4, 2]) {
                for y in rows {
                    pixels.extend(columns.clone().map(|x| y * width + x));
                }
            }
        }
    }
    pixels
}

pub(crate) fn primary_rays(context: &RenderContext, scene: &PreparedScene, list: &RayList) -> Vec<Hit> {
    let hits = closest_hits(scene, list, |rays, trace| context.piece(rays, trace));
    let found = hits.par_iter().filter(|hit| hit.is_some()).count() as u64;
    Tally::add(&context.tally.rays, list.rays.len() as u64);
    Tally::add(&context.tally.surface_points, found);
    if list.from_camera() {
        Tally::add(&context.tally.hits, found);
    }
    hits
}

/// Rays per task, of so many: short lists have work for all processors, too, and each task casts several together.
pub(crate) fn batch(rays: usize) -> usize {
    rays.div_ceil(4 * rayon::current_num_threads()).next_multiple_of(64).clamp(128, BATCH)
}

/// The hits of rays, which `piece` computes run by run.
pub(crate) fn closest_hits(
    scene: &PreparedScene,
    list: &RayList,
    piece: impl Fn(usize, &mut dyn FnMut()) + Sync,
) -> Vec<Hit> {
    let mut hits = vec![Hit::MISS; list.rays.len()];
    let batch = batch(list.rays.len());
    spread_out(list.rays.chunks(batch).zip(hits.chunks_mut(batch))).for_each(|(task, (rays, hits))| {
        piece(rays.len(), &mut || {
            if list.clip.cuts() {
                let first = task * batch;
                let limits: Vec<Limits> = (first..first + rays.len()).map(|ray| list.limits(ray)).collect();
                closest_hits_within(&*scene.geometry.accelerator, rays, &limits, hits);
            } else {
                scene.geometry.accelerator.closest_hits(rays, hits);
            }
        });
    });
    hits
}

/// The hits of rays between their limits.
pub(crate) fn closest_hits_within(accelerator: &dyn Accelerator, rays: &[Ray], limits: &[Limits], hits: &mut [Hit]) {
    let between: Vec<Ray> = rays.iter().zip(limits).map(|(ray, limits)| limits.between(ray)).collect();
    accelerator.closest_hits(&between, hits);
    hits.iter_mut().zip(limits).for_each(|(hit, limits)| *hit = limits.from_origin(*hit));
}
