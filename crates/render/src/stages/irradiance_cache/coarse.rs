//! What coarse records gather: light from everywhere, by direction.

use glam::Vec3;
use lightmesh_layout::constants::{EVEN, FIRST_COUNT, NEAR_CELLS};
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Record, size_of_level};
use super::guide::Guides;
use super::hemisphere_rays::HemisphereRays;
use super::light::{Bins, Light};
use super::rays::Cast;
use super::scene::Scene;

/// What a coarse record gathers.
pub(super) struct CoarseLight {
    pub(super) light: Light,
    /// The radiance that all rays see.
    pub(super) all: Bins,
    /// That of rays that go far.
    pub(super) beyond: Bins,
    pub(super) has_near: bool,
}

impl CoarseLight {
    const EMPTY: CoarseLight =
        CoarseLight { light: Light::NONE, all: Bins::EMPTY, beyond: Bins::EMPTY, has_near: false };

    /// Adds what guided rays see; the numbers of rays of both are given.
    fn join(&mut self, other: &CoarseLight, [count, others]: [f32; 2]) {
        let share = others / (FIRST_COUNT * count + others);
        let mut light = Light::default();
        light.add(1.0 - share, &self.light, Vec3::ZERO);
        light.add(share, &other.light, Vec3::ZERO);
        self.light = light;
        self.all.join(FIRST_COUNT, &other.all);
        self.beyond.join(FIRST_COUNT, &other.beyond);
        self.has_near |= other.has_near;
    }
}

/// How far near light reaches from a record.
pub(super) fn near(record: &Record) -> f32 {
    NEAR_CELLS * size_of_level(record.level)
}

/// Computes what coarse records gather, unless it is known.
pub(super) fn ensure(
    scene: &Scene,
    cells: &Cells,
    bounce: &mut Bounce,
    known: &mut Vec<Option<Box<CoarseLight>>>,
    wanted: &[u32],
    hemispheres: [HemisphereRays; 2],
) {
    known.resize_with(cells.records.len(), || None);
    let new: Vec<u32> = wanted.iter().copied().filter(|&record| known[record as usize].is_none()).collect();
    for new in new.chunks(scene.records_at_once(hemispheres[0])) {
        let records: Vec<Record> = new.iter().map(|&record| cells.records[record as usize]).collect();
        for (&number, seen) in new.iter().zip(gathered(scene, bounce, &records, hemispheres)) {
            known[number as usize] = Some(seen.coarse);
        }
    }
}

/// What records receive by their own rays alone.
pub(super) fn plain(
    scene: &Scene,
    bounce: &mut Bounce,
    records: &[Record],
    hemispheres: [HemisphereRays; 2],
) -> Vec<Light> {
    let each = |records: &[Record]| -> Vec<Light> {
        gathered(scene, bounce, records, hemispheres).into_iter().map(|seen| seen.coarse.light).collect()
    };
    records.chunks(scene.records_at_once(hemispheres[0])).flat_map(each).collect()
}

/// What some records gather.
fn gathered(
    scene: &Scene,
    bounce: &mut Bounce,
    records: &[Record],
    hemispheres: [HemisphereRays; 2],
) -> Vec<SeenByRays> {
    // 1. A few rays from each.
    let (mut first, bright) = seen_by_rays(scene, bounce, records, hemispheres[0], None);
    // 2. More where these see different things.
    let uneven = records.iter().zip(&mut first).zip(bright.chunks_exact(hemispheres[0].len()));
    let mut uneven: Vec<((&Record, &mut SeenByRays), &[f32])> =
        uneven.filter(|((_, seen), _)| seen.is_uneven()).collect();
    for uneven in uneven.chunks_mut(scene.records_at_once(hemispheres[1])) {
        let records: Vec<Record> = uneven.iter().map(|((record, _), _)| **record).collect();
        let mut guides = Guides::new(hemispheres[0]);
        uneven.iter().for_each(|(_, bright)| guides.add(hemispheres[0], hemispheres[1], bright));
        let (more, _) = seen_by_rays(scene, bounce, &records, hemispheres[1], Some(&guides));
        let both = uneven.par_iter_mut().zip(more);
        both.for_each(|(((_, seen), _), more)| {
            seen.coarse.join(&more.coarse, hemispheres.map(|hemisphere| hemisphere.len() as f32))
        });
    }
    first
}

/// What the rays of a record see.
struct SeenByRays {
    coarse: Box<CoarseLight>,
    /// The mean luminance, and the mean of its square.
    luminance: [f32; 2],
}

impl SeenByRays {
    fn is_uneven(&self) -> bool {
        let [mean, square] = self.luminance;
        square > (1.0 + EVEN * EVEN) * mean * mean
    }
}

/// What the rays of records see, and the luminance times the weight of each ray.
fn seen_by_rays(
    scene: &Scene,
    bounce: &mut Bounce,
    records: &[Record],
    hemisphere: HemisphereRays,
    guides: Option<&Guides>,
) -> (Vec<SeenByRays>, Vec<f32>) {
    let cast = scene.cast(records.iter().map(|record| (record, f32::INFINITY)), hemisphere, guides);
    let radiance = bounce.complete(scene, &scene.seen(&cast), hemisphere);
    let Cast { list, hits, weights, areas, .. } = &cast;
    let mut bright = vec![0.0; radiance.len()];
    let gather = |((index, record), bright): ((usize, &Record), &mut [f32])| {
        let near = near(record);
        let mut coarse = Box::new(CoarseLight::EMPTY);
        let mut luminance = [0.0; 2];
        for (ray, bright) in (index * hemisphere.len()..).zip(bright) {
            let (direction, radiance, weight) = (list.rays[ray].direction, radiance[ray], weights[ray]);
            coarse.light.take(record.point.normal, direction, weight * radiance);
            coarse.light.most = coarse.light.most.max(radiance);
            coarse.all.take(direction, radiance, areas[ray]);
            if hits[ray].t < near {
                coarse.has_near = true;
            } else {
                coarse.beyond.take(direction, radiance, areas[ray]);
            }
            let seen = crate::shading::luminance(radiance);
            luminance[0] += weight * seen;
            luminance[1] += weight * seen * seen;
            *bright = weight * seen;
        }
        SeenByRays { coarse, luminance }
    };
    let hemispheres = records.par_iter().enumerate().zip(bright.par_chunks_exact_mut(hemisphere.len()));
    let seen = hemispheres.map(gather).collect();
    (seen, bright)
}
