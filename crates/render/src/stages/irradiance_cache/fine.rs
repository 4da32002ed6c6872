//! What fine records receive: from afar what coarse records gather, and from nearby what their own rays hit.
//!
//! ```text
//! A = coarse + Σ_j ω_j (L_j − all_j)        L_j: what ray j hits nearby, or else what coarse records see beyond
//! ```
//!
//! The mean of what coarse records see along the ray, all_j, is a control variate: its integral is the light `coarse` that they receive. So where
//! nothing is near, there is no noise but theirs.

use glam::Vec3;
use lightmesh_layout::constants::{CLOSER, COARSER, CROWDED, CROWDED_AGAIN, HOPELESS, NEAR_REACH};
use lightmesh_trace::accel::Hit;
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Record, size_of_level};
use super::coarse::{self, CoarseLight};
use super::directions::bin;
use super::hemisphere_rays::RecordRays;
use super::light::Light;
use super::lookup::{Link, Links, Place};
use super::rays::Cast;
use super::scene::Scene;
use crate::steps::{Steps, spread};

/// What coarse records know.
pub(super) struct CoarseRecords<'a> {
    pub(super) cells: &'a mut Cells,
    pub(super) known: &'a mut Vec<Option<Box<CoarseLight>>>,
    pub(super) bounce: &'a mut Bounce,
}

/// Computes what fine records receive, unless it is known.
pub(super) fn ensure(
    scene: &Scene,
    cells: &Cells,
    known: &mut Vec<Option<Light>>,
    coarse: &mut CoarseRecords,
    wanted: &[u32],
    rays: &RecordRays,
    steps: &mut Steps,
) {
    known.resize_with(cells.records.len(), || None);
    let all: Vec<u32> = wanted.iter().copied().filter(|&record| known[record as usize].is_none()).collect();
    let all: Vec<u32> = spread(all.len()).map(|index| all[index]).collect();
    let mut done = 0;
    while done < all.len() {
        let new = &all[done..all.len().min(done + scene.records_at_a_step(rays.fine, done, all.len()))];
        // As coarse as what they ask.
        let coarser = |record: &Record| Record { level: record.level + COARSER, ..*record };
        let records: Vec<Record> = new.iter().map(|&record| coarser(&cells.records[record as usize])).collect();
        for (&number, fine) in new.iter().zip(received(scene, coarse, &records, rays)) {
            known[number as usize] = Some(fine);
        }
        done += new.len();
        steps.tell(done, all.len());
    }
}

/// What records receive that belong to no cell, as coarse as what they ask.
pub(super) fn plain(scene: &Scene, coarse: &mut CoarseRecords, records: &[Record], rays: &RecordRays) -> Vec<Light> {
    let each = |records: &[Record]| received(scene, coarse, records, rays);
    records.chunks(scene.records_at_once(rays.fine)).flat_map(each).collect()
}

/// How far the near rays of a record reach.
fn reach(record: &Record) -> f32 {
    NEAR_REACH * coarse::near(record)
}

/// Records among near things ask smaller coarse cells: light changes fast from place to place there. What is near is measured as Ward measures how fast
/// irradiance changes, by the mean inverse distance of what rays hit (Ward, Rubinstein, Clear: *A Ray Tracing Solution for Diffuse Interreflection*,
/// 1988, the split sphere).
fn come_closer(cast: &mut Cast, records: &mut [Record]) {
    cast.hemispheres().zip(records.par_iter_mut()).for_each(|((hits, weights), record)| {
        let mut most = CROWDED;
        for _ in 0..CLOSER {
            let near = hits.iter().zip(weights).filter(|(hit, _)| hit.t < reach(record));
            let near = near.fold(0.0, |sum, (hit, weight)| sum + weight / hit.t);
            let crowded = near * size_of_level(record.level);
            if crowded <= most || crowded > HOPELESS {
                break;
            }
            record.level -= 1;
            most *= CROWDED_AGAIN;
        }
        hits.iter_mut().filter(|hit| hit.t >= reach(record)).for_each(|hit| *hit = Hit::MISS);
    });
    cast.set_levels(records.iter().map(|record| record.level));
}

fn received(scene: &Scene, coarse: &mut CoarseRecords, records: &[Record], rays: &RecordRays) -> Vec<Light> {
    let hemisphere = rays.fine;
    // 1. What is near.
    let mut cast = scene.cast(records.iter().map(|record| (record, reach(record))), hemisphere, None);
    let mut records = records.to_vec();
    come_closer(&mut cast, &mut records);

    // 2. The coarse records around that are seen, and what they gather.
    let places: Vec<Place> = records.iter().map(|record| Place::new(&record.point, record.level)).collect();
    let mut links = Links::new(scene, coarse.cells, &places);
    links.settle(scene, coarse.cells, &places);
    coarse::ensure(scene, coarse.cells, coarse.bounce, coarse.known, &links.records(), rays.coarse);

    // 3. What near rays see.
    let near = coarse.bounce.complete(scene, &scene.seen(&cast), hemisphere);

    // 4. Both together; more rays of their own for records that see no coarse one.
    let sees = |record: usize| links.of(record).next().is_some();
    let misses: Vec<usize> = (0..records.len()).into_par_iter().filter(|&record| !sees(record)).collect();
    let own: Vec<Record> = misses.iter().map(|&record| records[record]).collect();
    let own = coarse::plain(scene, coarse.bounce, &own, rays.coarse);
    let coarse = &*coarse;
    let both = |record: usize| {
        let rays = record * hemisphere.len()..(record + 1) * hemisphere.len();
        if !sees(record) {
            return Light::default();
        }
        near_and_coarse(coarse, records[record].point.normal, links.of(record), &cast, &near, rays)
    };
    let mut fine: Vec<Light> = (0..records.len()).into_par_iter().map(both).collect();
    misses.iter().zip(own).for_each(|(&record, light)| fine[record] = light);
    fine
}

/// What a fine record receives from coarse records, and from what its rays hit nearby: `near` is the radiance along each ray.
fn near_and_coarse(
    coarse: &CoarseRecords,
    normal: Vec3,
    links: impl Iterator<Item = Link> + Clone,
    cast: &Cast,
    near: &[Vec3],
    rays: std::ops::Range<usize>,
) -> Light {
    let known = |record: u32| coarse.known[record as usize].as_ref().expect("it was ensured");
    let total: f32 = links.clone().map(|(_, weight)| weight).sum();
    let mut light = Light::NONE;
    let mut has_near = cast.hits[rays.clone()].iter().any(Hit::is_some);
    for (record, weight) in links.clone() {
        light.add(weight / total, &known(record).light, normal - coarse.cells.records[record as usize].point.normal);
        has_near |= known(record).has_near;
    }
    if !has_near {
        return light;
    }
    let mean = light.mean;
    for ray in rays {
        let direction = cast.list.rays[ray].direction;
        let bin = bin(direction);
        let (mut all, mut beyond) = (Mean::default(), Mean::default());
        for (record, weight) in links.clone() {
            let known = known(record);
            all.add(weight, known.all.of(bin));
            beyond.add(weight, known.beyond.of(bin));
        }
        let all = all.or(mean);
        let seen = if cast.hits[ray].is_some() { near[ray] } else { beyond.or(all) };
        light.most = light.most.max(seen);
        light.take(normal, direction, cast.weights[ray] * (seen - all));
    }
    light
}

/// A weighted mean.
#[derive(Default)]
struct Mean {
    sum: Vec3,
    weight: f32,
}

impl Mean {
    #[inline(always)]
    fn add(&mut self, weight: f32, (sum, count): (Vec3, f32)) {
        // By the mean of the rays: with their sum, records with many rays would count more here than in the light that is corrected.
        if count > 0.0 {
            self.sum += weight * (sum / count);
            self.weight += weight;
        }
    }

    /// The mean, or something else without any.
    #[inline(always)]
    fn or(&self, other: Vec3) -> Vec3 {
        if self.weight > 0.0 { self.sum / self.weight } else { other }
    }
}
