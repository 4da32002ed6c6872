//! Gathered light on the CPU: the steps of [`super`].

use glam::Vec3;
use lightmesh_layout::constants::COARSER;
use rayon::prelude::*;

use super::bounce::Bounce;
use super::cells::{Cells, Record};
use super::coarse::{self, CoarseLight};
use super::fine::{self, CoarseRecords};
use super::light::Light;
use super::lookup::{Links, Place};
use super::scene::Scene;
use super::{BYTES_OF_POINT, Gathering, POINTS_AT_ONCE};
use crate::data::wave::HostWave;
use crate::shading::normal_seen;
use crate::steps::Steps;
use crate::surface::SurfacePoint;

/// What was gathered for a scene.
#[derive(Default)]
pub struct SurfaceLight {
    pub(super) fine_cells: Cells,
    pub(super) fine: Vec<Option<Light>>,
    pub(super) coarse_cells: Cells,
    pub(super) coarse: Vec<Option<Box<CoarseLight>>>,
    pub(super) bounce: Bounce,
}

impl SurfaceLight {
    /// Bytes in memory.
    pub(crate) fn memory(&self) -> u64 {
        let records = self.fine.capacity() * size_of::<Option<Light>>();
        let coarse = self.coarse.iter().flatten().count() * size_of::<CoarseLight>()
            + self.coarse.capacity() * size_of::<usize>();
        (self.fine_cells.memory() + records + self.coarse_cells.memory() + coarse + self.bounce.memory()) as u64
    }
}

/// A question for the light at a surface point.
struct Ask {
    /// Its place in the result.
    index: usize,
    point: SurfacePoint,
    level: i32,
    /// The share of the answer that counts.
    share: f32,
}

/// Some of the points of a wave.
#[derive(Clone, Copy)]
struct Points {
    first: usize,
    step: usize,
    count: usize,
}

impl Points {
    /// Parts of so many points that are computed one after the other: `sampled`, each is a sample of all, otherwise neighbours.
    fn parts(points: usize, sampled: bool) -> Vec<Points> {
        let starts = (0..points).step_by(POINTS_AT_ONCE);
        let parts = starts.len();
        if sampled {
            return (0..parts)
                .map(|first| Points { first, step: parts, count: (points - first).div_ceil(parts) })
                .collect();
        }
        starts.map(|first| Points { first, step: 1, count: POINTS_AT_ONCE.min(points - first) }).collect()
    }

    /// The number in the wave of one of them.
    #[inline(always)]
    fn at(&self, index: usize) -> usize {
        self.first + index * self.step
    }
}

/// The mean radiance that each surface point of a wave receives, weighted by the cosine; zero for rays that see nothing.
pub(crate) fn gather(wave: &HostWave, how: &Gathering, kept: &mut SurfaceLight) -> Vec<Vec3> {
    let mut light = vec![Vec3::ZERO; wave.hits.len()];
    let scene = Scene { context: wave.context, scene: wave.scene, rays_at_once: how.rays_at_once };
    // Of samples of all, the first asks for most records: then progress is known. If they don't fit, few are asked for at a time.
    let sampled = how.most_kept.is_none_or(|most| kept.memory() + BYTES_OF_POINT * light.len() as u64 <= most);
    let parts = Points::parts(light.len(), sampled);
    let sharing = how.sharing(kept.fine.is_empty(), sampled);
    let mut steps = Steps::new(wave.context, parts.iter().map(|part| part.count), sharing);
    for points in parts {
        if how.most_kept.is_some_and(|most| kept.memory() > most) {
            *kept = SurfaceLight::default();
        }
        let found = gather_part(wave, &scene, how, kept, points, &mut steps);
        found.into_iter().enumerate().for_each(|(index, found)| light[points.at(index)] = found);
        steps.end_part();
    }
    light
}

fn gather_part(
    wave: &HostWave,
    scene: &Scene,
    how: &Gathering,
    kept: &mut SurfaceLight,
    points: Points,
    steps: &mut Steps,
) -> Vec<Vec3> {
    // 1. Where light is asked for: at one level, or between two.
    let asks = |index: usize| {
        let point = wave.surface_point(points.at(index));
        let levels = how.levels(point.position).into_iter().filter(|(_, share)| *share > 0.0);
        levels.map(move |(level, share)| Ask { index, point, level, share })
    };
    let seen = (0..points.count).into_par_iter().filter(|&index| wave.sees(points.at(index)));
    let asks: Vec<Ask> = seen.flat_map_iter(asks).collect();
    let normal = |ask: &Ask| normal_seen(wave, points.at(ask.index));

    // 2. to 3. The mean of fine records. Where there is none, the point counts as one itself.
    let means = if how.brute_force { vec![None; asks.len()] } else { means(scene, how, kept, (&asks, normal), steps) };
    let misses: Vec<&Ask> = asks.iter().zip(&means).filter(|(_, mean)| mean.is_none()).map(|(ask, _)| ask).collect();
    let records: Vec<Record> = misses.iter().map(|ask| record_of(ask, how.brute_force)).collect();
    let SurfaceLight { coarse_cells, coarse, bounce, .. } = kept;
    let own = if how.brute_force {
        let mut own = Vec::with_capacity(records.len());
        for part in records.chunks(scene.records_at_once(how.rays.coarse[0])) {
            own.extend(coarse::plain(scene, bounce, part, how.rays.coarse));
            steps.tell(own.len(), records.len());
        }
        own
    } else {
        fine::plain(scene, &mut CoarseRecords { cells: coarse_cells, known: coarse, bounce }, &records, &how.rays)
    };
    let own = misses.iter().zip(own).map(|(ask, own): (&&Ask, Light)| (*ask, own.at(normal(ask) - ask.point.normal)));
    let means = asks.iter().zip(means).filter_map(|(ask, mean)| Some((ask, mean?)));
    let mut light = vec![Vec3::ZERO; points.count];
    for (ask, mean) in means.chain(own) {
        light[ask.index] += ask.share * mean.max(Vec3::ZERO);
    }
    light
}

/// The mean of what the fine records around receive; `None` where no record is seen.
fn means(
    scene: &Scene,
    how: &Gathering,
    kept: &mut SurfaceLight,
    (asks, normal): (&[Ask], impl Fn(&Ask) -> Vec3 + Sync),
    steps: &mut Steps,
) -> Vec<Option<Vec3>> {
    // 2. The fine records around that are seen, and what they receive.
    let places: Vec<Place> = asks.iter().map(|ask| Place::new(&ask.point, ask.level)).collect();
    let SurfaceLight { fine_cells, fine, coarse_cells, coarse, bounce } = kept;
    let mut links = Links::new(scene, fine_cells, &places);
    let mut coarse = CoarseRecords { cells: coarse_cells, known: coarse, bounce };
    fine::ensure(scene, fine_cells, fine, &mut coarse, &links.records(), &how.rays, steps);
    let known = |record: u32| fine[record as usize].as_ref().expect("it was ensured");
    links.settle(scene, fine_cells, &places);

    // 3. The mean.
    let mean = |(number, ask): (usize, &Ask)| {
        let (normal, mut sum, mut weights) = (normal(ask), Vec3::ZERO, 0.0);
        for (record, weight) in links.of(number) {
            let turned = normal - fine_cells.records[record as usize].point.normal;
            sum += weight * known(record).at(turned);
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    };
    asks.par_iter().enumerate().map(mean).collect()
}

/// A surface point as a record. All have the same pattern, or each its own.
fn record_of(ask: &Ask, same: bool) -> Record {
    let [x, y, z] = ask.point.position.to_array().map(|axis| u64::from(axis.to_bits()));
    Record { point: ask.point, level: ask.level + COARSER, seed: if same { 0 } else { x ^ y << 21 ^ z << 42 } }
}
