//! Transmittance on the CPU: all samples of a light from one surface point at once.

use glam::Vec3;
use lightmesh_layout::constants::{MAX_THROUGHS, PART_OF_LEVEL, TRANSMITTANCE_LEVELS};
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{Hit, Ray, TangentPlanes};
use rayon::prelude::*;

use super::levels;
use super::shown::may_show;
use crate::counters::Tally;
use crate::data::visibility::Visibility;
use crate::data::wave::{HostWave, Wave};
use crate::prepared::PreparedScene;
use crate::shading::tint::transmittance_at;
use crate::shadow::projected_light::Emitter;
use crate::shadow::{ShadowTarget, hidden};
use crate::stages::primary_rays::cpu::batch;
use crate::steps::spread_out;
use crate::surface::{SurfacePoint, gap_behind, long_segment};

/// So many samples are followed about as fast as it is asked whether they may meet anything.
const FEW: u32 = 4;

/// `visibility` times the transmittance of what is `transmissive`.
pub(crate) fn transmittance(
    wave: &HostWave,
    transmissive: &PreparedScene,
    target: &ShadowTarget,
    mut visibility: Visibility,
) -> Visibility {
    let wave = Wave { lights: visibility.lights.clone().into(), ..*wave };
    let levels = levels(target);
    let rows: Vec<_> = levels.iter().map(|target| wave.rows(target)).collect();
    let emitters: Vec<_> = levels.iter().zip(&rows).map(|(target, rows)| Emitter::all(&wave, target, rows)).collect();
    visibility.passed = visibility.share.par_iter().map(|&share| Vec3::splat(share)).collect();
    let size = batch(wave.hits.len());
    spread_out(visibility.colored_parts(size)).for_each(|(number, mut planes)| {
        let first = number * size;
        let rays = first..wave.hits.len().min(first + size);
        wave.context.piece(rays.len(), || {
            let mut batch = Batch::new(&wave, transmissive);
            for ray in rays.filter(|&ray| wave.sees(ray)) {
                let point = wave.shadow_point(ray);
                let level = if levels.len() > 1 { level_of(&wave, transmissive, ray) } else { 0 };
                for (emitter, (shares, passed)) in emitters[level].iter().zip(&mut planes) {
                    let (share, passed) = (&mut shares[ray - first], &mut passed[ray - first]);
                    if *share <= 0.0 {
                        continue;
                    }
                    let point = emitter.seen_from(&wave.scene.geometry, &point);
                    if !may_show(&wave, transmissive, ray, &point, emitter.light().0) {
                        continue;
                    }
                    let left = match level {
                        0 => batch.left_of_all(emitter, ray, &point, *share),
                        _ => batch.left_of_few(emitter, ray, &point).map(|left| *share * left),
                    };
                    if let Some(left) = left {
                        *passed = left;
                        *share = passed.element_sum() / 3.0;
                    }
                }
            }
        });
    });
    visibility
}

/// The level of what a ray sees: how small a share of what it shows reaches the pixel.
fn level_of(wave: &HostWave, transmissive: &PreparedScene, ray: usize) -> usize {
    if wave.rays.depth == 0 {
        return 0;
    }
    let shown = (Vec3::ONE - transmittance_at(transmissive, &wave.rays.rays[ray], &wave.hits[ray])).max_element();
    let share = wave.parts as f32 * wave.rays.weight(ray).max_element() * shown;
    let (mut level, mut most) = (0, PART_OF_LEVEL);
    while level + 1 < TRANSMITTANCE_LEVELS as usize && share <= most {
        (level, most) = (level + 1, most * PART_OF_LEVEL);
    }
    level
}

/// The shadow rays of one surface point to one light.
struct Batch<'a> {
    wave: &'a HostWave<'a>,
    transmissive: &'a PreparedScene,
    /// Where they end.
    targets: Vec<Vec3>,
    /// The set of samples that each belongs to.
    sets: Vec<u32>,
    /// What is left at each.
    left: Vec<Vec3>,
    /// The ways there.
    rays: Vec<Ray>,
}

impl<'a> Batch<'a> {
    fn new(wave: &'a HostWave<'a>, transmissive: &'a PreparedScene) -> Batch<'a> {
        Batch { wave, transmissive, targets: Vec::new(), sets: Vec::new(), left: Vec::new(), rays: Vec::new() }
    }

    /// What is left of a share of a light by all of its samples; `None` if that is all of it.
    fn left_of_all(&mut self, emitter: &Emitter, ray: usize, point: &SurfacePoint, share: f32) -> Option<Vec3> {
        let lost = self.lost(emitter, ray, point);
        (lost != Vec3::ZERO).then(|| (Vec3::splat(share) - lost / emitter.samples() as f32).max(Vec3::ZERO))
    }

    /// What is left of a light by the mean of few samples; `None` if that is all of it.
    fn left_of_few(&mut self, emitter: &Emitter, ray: usize, point: &SurfacePoint) -> Option<Vec3> {
        // 1. What is left of each sample.
        if !self.follow(emitter, ray, point) {
            return None;
        }
        // 2. What is opaque hides some of those of which something is lost.
        let mut hidden = self.dimmed_hidden(point).into_iter();
        // 3. The means over what is not hidden, and over all.
        let (mut seen, mut seen_count, mut all) = (Vec3::ZERO, 0.0, Vec3::ZERO);
        for &left in &self.left {
            all += left;
            if left == Vec3::ONE || hidden.next().is_some_and(|(_, hidden)| !hidden) {
                seen += left;
                seen_count += 1.0;
            }
        }
        let mean = if seen_count > 0.0 { seen / seen_count } else { all / self.left.len() as f32 };
        (mean != Vec3::ONE).then_some(mean)
    }

    /// The sum of what is lost on the way to samples that nothing opaque hides.
    fn lost(&mut self, emitter: &Emitter, ray: usize, point: &SurfacePoint) -> Vec3 {
        // 1. What is left of each sample.
        if !self.follow(emitter, ray, point) {
            return Vec3::ZERO;
        }
        // 2. What is opaque hides some of those of which something is lost.
        let dimmed = self.dimmed_hidden(point);

        // 3. The sums of sets.
        let (mut sum, mut of_set, mut set) = (Vec3::ZERO, Vec3::ZERO, 0);
        for (index, hidden) in dimmed {
            if self.sets[index] != set {
                (sum, of_set, set) = (sum + of_set, Vec3::ZERO, self.sets[index]);
            }
            if !hidden {
                of_set += Vec3::ONE - self.left[index];
            }
        }
        sum + of_set
    }

    /// Finds what is left of each sample above the horizon. Returns whether anything may be lost.
    fn follow(&mut self, emitter: &Emitter, ray: usize, point: &SurfacePoint) -> bool {
        if emitter.samples() > FEW && !self.may_meet(emitter, point) {
            return false;
        }
        self.targets.clear();
        self.sets.clear();
        emitter.each_target_of_set(self.wave, ray, point, |set, target| {
            if point.normal.dot(target - point.origin) > 0.0 {
                self.targets.push(target);
                self.sets.push(set);
            }
        });
        self.pass(point.origin)
    }

    /// The samples of which something is lost, and whether anything opaque hides each.
    fn dimmed_hidden(&self, point: &SurfacePoint) -> Vec<(usize, bool)> {
        let dimmed = || (0..self.targets.len()).filter(|&index| self.left[index] != Vec3::ONE);
        let segments: Vec<Ray> = dimmed().map(|index| long_segment(point.origin, self.targets[index])).collect();
        Tally::add(&self.wave.context.tally.shadow_rays, segments.len() as u64);
        dimmed().zip(hidden(self.wave, &segments)).collect()
    }

    /// Whether any transmissive surface may be between a surface point and an emitter.
    fn may_meet(&self, emitter: &Emitter, point: &SurfacePoint) -> bool {
        let geometry = &self.transmissive.geometry;
        let origin = Bounds { min: point.origin, max: point.origin };
        let planes = TangentPlanes::new(point.origin, [(point.origin, point.normal)], 0.0);
        let mut found = false;
        geometry.accelerator.search(&emitter.region(geometry, &origin).above(planes), &mut |_| {
            found = true;
            false
        });
        found
    }

    /// Follows rays through all surfaces that they meet. Returns whether they meet any.
    fn pass(&mut self, origin: Vec3) -> bool {
        let Batch { transmissive, rays, targets, left, .. } = self;
        left.clear();
        left.resize(targets.len(), Vec3::ONE);
        rays.clear();
        rays.extend(targets.iter().map(|&target| long_segment(origin, target)));
        let mut met = false;
        transmissive.geometry.accelerator.all_hits(rays, &mut |ray, hits| {
            left[ray] = left_behind(transmissive, &rays[ray], hits);
            met = true;
        });
        met
    }
}

/// What is left of light along a ray behind these hits, which are in order.
fn left_behind(transmissive: &PreparedScene, ray: &Ray, hits: &[Hit]) -> Vec3 {
    let (mut left, mut last, mut next, mut met) = (Vec3::ONE, 0.0, 0.0, 0);
    for hit in hits {
        if hit.t <= next || met == MAX_THROUGHS {
            continue;
        }
        // Bodies absorb light from one surface to the next.
        left *= transmittance_at(transmissive, ray, &Hit { t: hit.t - last, ..*hit });
        next = hit.t + gap_behind(ray, hit, &transmissive.geometry.triangles.at(hit.triangle));
        (last, met) = (hit.t, met + 1);
    }
    left
}
