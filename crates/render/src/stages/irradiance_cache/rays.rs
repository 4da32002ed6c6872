//! Gather rays: their directions, and what they see.

use glam::Vec3;
use lightmesh_layout::constants::{BOUNCE_SIZE, BRIGHT, CHOSEN_LIGHTS, LAST_DIGIT, SKY_CONE};
use lightmesh_scene::{Light, LightKind};
use lightmesh_trace::accel::{Hit, Ray};
use rayon::prelude::*;

use super::cells::{Kind, Record, kind_of, level_of, outward};
use super::directions::{above, basis};
use super::guide::Guides;
use super::hemisphere_rays::HemisphereRays;
use super::lookup::Place;
use super::scene::Scene;
use super::{FIRST_STEP, RAYS_AT_A_STEP, STEPS};
use crate::counters::Tally;
use crate::data::lights::LightGroup;
use crate::data::rays::RayList;
use crate::data::wave::HostWave;
use crate::render_context::Sampling;
use crate::sampling::{light_center, random_bits};
use crate::shading::environment::surroundings;
use crate::shading::{LightTargets, Surface, falloff, luminance, material_of};
use crate::shadow::{ShadowTarget, Targets, hidden, shadow_segment, size};
use crate::stages::primary_rays::cpu::{batch, closest_hits};
use crate::surface::SurfacePoint;

/// Rays from some records, record by record, with what they hit.
pub(super) struct Cast {
    pub(super) list: RayList,
    /// Shares of the mean radiance by the cosine.
    pub(super) weights: Vec<f32>,
    /// How many rays of an even hemisphere each stands for.
    pub(super) areas: Vec<f32>,
    pub(super) hits: Vec<Hit>,
    hemisphere: HemisphereRays,
    /// The seed of each record.
    seeds: Vec<u64>,
    /// By record: the level of the smallest cells that its rays ask.
    levels: Vec<i32>,
}

/// The level of the smallest cells that the rays of a record ask for reflected light: cells become larger from reflection to reflection, up to
/// what suits a ray of mean length, so that neither corners are asked in detail everywhere nor whole rooms as one.
fn asked_level(own: i32, reach: f32, hits: &[Hit], areas: &[f32]) -> i32 {
    let hits = hits.iter().zip(areas).filter(|(hit, _)| hit.is_some());
    let (sum, count) = hits.fold((0.0, 0.0), |(sum, count), (hit, area)| (sum + area * hit.t, count + area));
    let is_near = reach < f32::INFINITY;
    if is_near || count == 0.0 { own } else { own.max((own + 1).min(level_of(BOUNCE_SIZE * (sum / count)).0)) }
}

impl Cast {
    /// What the rays of each record hit, with their weights.
    pub(super) fn hemispheres(&mut self) -> impl IndexedParallelIterator<Item = (&mut [Hit], &[f32])> {
        let len = self.hemisphere.len();
        self.hits.par_chunks_exact_mut(len).zip(self.weights.par_chunks_exact(len))
    }

    /// Changes the levels of the smallest cells that rays ask, by record.
    pub(super) fn set_levels(&mut self, levels: impl Iterator<Item = i32>) {
        self.levels = levels.collect();
    }

    /// The level of the smallest cells that a ray asks for reflected light.
    fn level(&self, ray: usize) -> i32 {
        self.levels[ray / self.hemisphere.len()]
    }

    /// What distinguishes a ray's random numbers.
    fn seed(&self, ray: usize) -> u64 {
        self.seeds[ray / self.hemisphere.len()]
            .wrapping_add((self.hemisphere.len() + ray % self.hemisphere.len()) as u64)
    }
}

impl Scene<'_> {
    /// The records that rays are cast from at once.
    pub(super) fn records_at_once(&self, hemisphere: HemisphereRays) -> usize {
        self.rays_at_once / hemisphere.len()
    }

    /// The same of records of an image, `done` of `all`: as many again, so that it soon shows how long all take, but no more than a small part.
    pub(super) fn records_at_a_step(&self, hemisphere: HemisphereRays, done: usize, all: usize) -> usize {
        let least = RAYS_AT_A_STEP.div_ceil(hemisphere.len());
        self.records_at_once(hemisphere).min(done.clamp(all.div_ceil(FIRST_STEP), all.div_ceil(STEPS)).max(least))
    }

    /// Casts a hemisphere of rays from each record, as far as it says: even, or as guides have it.
    pub(super) fn cast<'s>(
        &self,
        records: impl Iterator<Item = (&'s Record, f32)>,
        hemisphere: HemisphereRays,
        guides: Option<&Guides>,
    ) -> Cast {
        let records: Vec<(&Record, f32)> = records.collect();
        let count = records.len() * hemisphere.len();
        let nothing = Ray { origin: Vec3::ZERO, direction: Vec3::ZERO, t_max: 0.0 };
        let mut list = RayList { cone: hemisphere.cone(), rays: vec![nothing; count], ..RayList::default() };
        let (mut weights, mut areas) = (vec![0.0; count], vec![1.0; count]);
        let seed = self.context.sampling.seed;
        let hemispheres =
            list.rays.par_chunks_exact_mut(hemisphere.len()).zip(weights.par_chunks_exact_mut(hemisphere.len()));
        let hemispheres = hemispheres.zip(areas.par_chunks_exact_mut(hemisphere.len())).zip(&records);
        hemispheres.enumerate().for_each(|(number, (((rays, weights), areas), &(record, reach)))| {
            let normal = record.point.normal;
            let [tangent, other] = basis(normal);
            let (guide, seed) = (guides.map(|guides| guides.of(number)), record.seed ^ seed);
            let mut sum = 0.0;
            for (index, ray) in rays.iter_mut().enumerate() {
                let even = || (hemisphere.place(seed, index as u32), 1.0);
                let (place, area) = guide.map_or_else(even, |guide| guide.place(hemisphere, seed, index as u32));
                let (local, weight) = above(place);
                let direction = local.x * tangent + local.y * other + local.z * normal;
                *ray = Ray { origin: record.point.origin, direction, t_max: reach };
                (weights[index], areas[index]) = (area * weight, area);
                sum += area * weight;
            }
            weights.iter_mut().for_each(|weight| *weight /= sum);
        });
        let hits = closest_hits(self.scene, &list, |_, trace| self.context.piece(0, trace));
        Tally::add(&self.context.tally.gather_rays, count as u64);
        let seeds = records.iter().map(|(record, _)| record.seed).collect();
        let hemispheres =
            hits.par_chunks_exact(hemisphere.len()).zip(areas.par_chunks_exact(hemisphere.len())).zip(&records);
        let levels = hemispheres
            .map(|((hits, areas), &(record, reach))| asked_level(record.level, reach, hits, areas))
            .collect();
        Cast { list, weights, areas, hits, hemisphere, seeds, levels }
    }

    /// What rays see, but for the light that reaches what they hit from no light directly. Rays that end before they hit anything see nothing.
    pub(super) fn seen(&self, cast: &Cast) -> Vec<Seen> {
        let Scene { context, scene, .. } = *self;
        let wave = HostWave { context, scene, rays: &cast.list, hits: &cast.hits, lights: LightGroup::ALL, parts: 1 };
        let lights = Lights::new(&wave);
        let mut seen = vec![Seen::default(); cast.hits.len()];
        let size = batch(seen.len());
        seen.par_chunks_mut(size).enumerate().for_each(|(batch, seen)| {
            context.piece(0, || {
                let mut segments = Segments::default();
                for (place, seen) in seen.iter_mut().enumerate() {
                    *seen = seen_by(&wave, cast, &lights, [batch * size + place, place], &mut segments);
                }
                segments.add(&wave, seen);
            });
        });
        let hemispheres =
            seen.par_chunks_exact_mut(cast.hemisphere.len()).zip(cast.weights.par_chunks_exact(cast.hemisphere.len()));
        hemispheres.for_each(|(seen, weights)| brighten(seen, weights));
        seen
    }
}

/// A point that a ray hits, where the light that was reflected before is asked for.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// Its level is that of the cell that it asks.
    pub(super) place: Place,
    /// By how many levels it is smaller than the one that was asked at first.
    pub(super) finer: i32,
    pub(super) kind: Kind,
}

/// What a ray sees.
#[derive(Clone, Copy, Default)]
pub(super) struct Seen {
    /// Emitted light, light that lights give, or the surroundings.
    pub(super) radiance: Vec3,
    /// How much of the other light is reflected,
    pub(super) kd: Vec3,
    /// and where to ask for that.
    pub(super) spot: Option<Spot>,
}

/// What ray number `ray` sees, but for lights: the segments to these are noted for the ray's place in its batch.
fn seen_by(wave: &HostWave, cast: &Cast, lights: &Lights, [ray, place]: [usize; 2], segments: &mut Segments) -> Seen {
    let Ray { direction, t_max, .. } = wave.rays.rays[ray];
    let hit = &wave.hits[ray];
    if !hit.is_some() && t_max < f32::INFINITY {
        return Seen::default();
    }
    // A shadow catcher shows what is behind it.
    let Some(material) = material_of(wave, ray).filter(|material| !material.catcher) else {
        let spread = SKY_CONE * wave.rays.cone.spread;
        return Seen { radiance: surroundings(wave.lights(), direction, spread), ..Seen::default() };
    };
    let surface = Surface::new(wave, ray);
    // Facets reflect as if they scattered.
    let kd = surface.coefficients.all;
    let radiance = if lights.lamps && material.lamp { Vec3::ZERO } else { surface.coefficients.emission };
    if kd == Vec3::ZERO {
        return Seen { radiance, ..Seen::default() };
    }
    segments.note(wave, lights, cast.seed(ray), place, &surface);
    let point = &surface.point;
    let is_front = outward(&wave.scene.geometry.triangles.at(hit.triangle)).dot(direction) < 0.0;
    let level = level_of(BOUNCE_SIZE * hit.t).0.max(cast.level(ray));
    let spot =
        Spot { place: Place::seen(point, level, direction, hit.t), finer: 0, kind: kind_of(point.normal, is_front) };
    Seen { radiance, kd, spot: Some(spot) }
}

/// The mean luminance that the rays of a record see.
pub(super) fn brightness(seen: &[Seen], weights: &[f32]) -> f32 {
    seen.iter().zip(weights).fold(0.0, |mean, (seen, weight)| mean + weight * luminance(seen.radiance))
}

/// Rays of a record that see much more than the mean ask the smallest cells at once.
fn brighten(seen: &mut [Seen], weights: &[f32]) {
    let mean = brightness(seen, weights);
    for seen in seen.iter_mut().filter(|seen| luminance(seen.radiance) > BRIGHT * mean) {
        seen.spot = seen.spot.map(Spot::finest);
    }
}

/// What rays need to know of lights.
struct Lights {
    targets: LightTargets,
    target: ShadowTarget,
    /// Whether there are lights for what lamps emit.
    lamps: bool,
}

impl Lights {
    fn new(wave: &HostWave) -> Lights {
        // The first of several samples: a single one would be the centre.
        let target = ShadowTarget::Area(Sampling { samples: 2, spread: true, ..wave.context.sampling });
        Lights { targets: LightTargets::new(wave.lights()), target, lamps: wave.scene.has_lamps() }
    }
}

/// Which lights a point asks about, of many: one after the other, each with a chance by what it may give. A light that is chosen stands for those
/// that are not.
struct Choice {
    /// How many lights one of strength 1 counts as; 0: all are chosen.
    scale: f32,
    /// How many the lights so far count as. Wherever that passes a whole number, a light is chosen.
    sum: f32,
}

impl Choice {
    fn new(wave: &HostWave, from: (&SurfacePoint, f32), seed: u64) -> Choice {
        let lights = wave.lights();
        let mut choice = Choice { scale: 0.0, sum: 0.0 };
        if lights.len() > CHOSEN_LIGHTS as usize {
            let total = lights.iter().fold(0.0, |total, light| total + strength_expected(light, from));
            if total > 0.0 && total < f32::INFINITY {
                let random = random_bits(wave.context.sampling.seed, seed, lights.len());
                choice = Choice { scale: CHOSEN_LIGHTS as f32 / total, sum: (random >> 40) as f32 * LAST_DIGIT };
            }
        }
        choice
    }

    /// The chance that the next light had if it is chosen; 0 if it is not.
    fn chance(&mut self, light: &Light, from: (&SurfacePoint, f32)) -> f32 {
        if self.scale == 0.0 {
            return 1.0;
        }
        let chance = strength_expected(light, from) * self.scale;
        let before = self.sum;
        self.sum += chance;
        if chance >= 1.0 {
            1.0
        } else if self.sum.floor() > before.floor() {
            chance
        } else {
            0.0
        }
    }
}

/// About how strongly a light may shine on a surface point, whose reach is given: 0 only if no part of it does.
fn strength_expected(light: &Light, (point, reach): (&SurfacePoint, f32)) -> f32 {
    let way = light_center(light, point.origin, reach) - point.origin;
    let distance = way.length();
    let size = match light.kind {
        LightKind::Point { spread, .. } => spread,
        _ => size(light, distance),
    };
    let far = distance.max(size);
    let received = ((point.normal.dot(way) + size) / far).min(1.0);
    let front = light.surface.map_or(far, |normal| -normal.dot(way));
    if received <= 0.0 || front <= 0.0 {
        return 0.0;
    }
    falloff(light, far) * light.intensity.max_element() * received * ((front + size) / far).min(1.0)
}

/// Segments to the lights.
#[derive(Default)]
struct Segments {
    rays: Vec<Ray>,
    /// Whose radiance grows by how much if nothing is in the way.
    gains: Vec<(usize, Vec3)>,
}

impl Segments {
    /// One segment to each light that is chosen, to a random point if it has a size. That tells whether the light is seen; how much it would give is known, unless a
    /// part of it is below the horizon.
    fn note(&mut self, wave: &HostWave, lights: &Lights, seed: u64, place: usize, surface: &Surface) {
        let point = &surface.point;
        let reach = wave.scene.geometry.sun_distance(point.origin);
        let mut choice = Choice::new(wave, (point, reach), seed);
        for (index, light) in wave.lights().iter().enumerate() {
            let chance = choice.chance(light, (point, reach));
            if chance == 0.0 {
                continue;
            }
            let target = Targets::new(&lights.target, (index, light), point.origin, reach, seed).get(0);
            if point.normal.dot(target - point.origin) <= 0.0 {
                continue;
            }
            let arriving = surface.arriving(&lights.targets, light, index, reach);
            let arriving = arriving.unwrap_or_else(|| surface.arriving_from(light, target)) / chance;
            let gain = surface.coefficients.all * arriving;
            if gain != Vec3::ZERO {
                self.rays.push(shadow_segment(light, point.origin, target));
                self.gains.push((place, gain));
            }
        }
    }

    fn add(&self, wave: &HostWave, seen: &mut [Seen]) {
        Tally::add(&wave.context.tally.shadow_rays, self.rays.len() as u64);
        for (&(place, gain), hidden) in self.gains.iter().zip(hidden(wave, &self.rays)) {
            if !hidden {
                seen[place].radiance += gain;
            }
        }
    }
}
