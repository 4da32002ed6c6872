//! Occluder lists on the CPU: lanes are surface points, a triangle is the same for all of them.

use std::sync::atomic::{AtomicU32, Ordering};

use fearless_simd::Level;
use fearless_simd::prelude::*;
use lightmesh_layout::constants::WARP;
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::{AcceleratorKind, Bvh, TangentPlanes};
use lightmesh_trace::simd::{LANES, dispatch};
use rayon::prelude::*;

use super::candidates::{Candidates, above_planes};
use super::group::{Group, View};
use crate::counters::Tally;
use crate::data::bundles::Bundles;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::ShadowTarget;
use crate::shadow::occlusion::gathered;
use crate::shadow::projected_light::Emitter;
use crate::shadow::sample_ray::SampleRays;
use crate::shadow::terminator::ShadowPoint;
use crate::shadow::weights::Weighed;
use crate::steps::spread_out;
use crate::surface::SurfacePoint;

/// Bundles per task.
const RUN: usize = 16;
/// Number of candidates after which lists are compared with rays for the first time.
const FIRST_CHECK: u32 = 48;
/// Groups of lanes of a bundle.
const GROUPS: usize = WARP as usize / LANES;

// What steps cost on a core with AVX2, nanoseconds; only their ratios matter.

/// To find a triangle.
const FOUND_COST: u32 = 35;
/// To test a candidate against eight surface points.
const CANDIDATE_COST: u32 = 40;
/// The same for each row of samples.
const ROW_COST: u32 = 6;
/// A ray at a node.
const NODE_COST: u32 = 25;
/// A ray at a triangle.
const TRIANGLE_COST: u32 = 15;
/// No ray costs less.
const MIN_RAY_COST: u32 = 50;
/// Rays are considered when this many times what was spent exceeds their price.
const MIN_COST_RATIO: f64 = 2.0;

/// The visible share of each light from each surface point.
pub(crate) fn occluder_lists(wave: &HostWave, bundles: &Bundles, target: &ShadowTarget) -> Visibility {
    let rows = wave.rows(target);
    let emitters = Emitter::all(wave, target, &rows);
    let level = Level::new();
    // Each share has one writer.
    let rays = wave.hits.len();
    let shares: Vec<AtomicU32> = (0..emitters.len() * rays).map(|_| AtomicU32::new(0)).collect();
    spread_out(0..bundles.len().div_ceil(RUN)).for_each(|(_, run)| {
        let run = run * RUN..bundles.len().min((run + 1) * RUN);
        let points = run.clone().map(|bundle| bundles.members(bundle).len()).sum();
        wave.context.piece(points, || {
            let run = run.map(|bundle| bundles.members(bundle));
            dispatch!(level, simd => shares_of_run(simd, wave, &emitters, run, &shares));
        });
    });
    // In the same memory.
    let share = shares.into_iter().map(|share| f32::from_bits(share.into_inner())).collect();
    Visibility { rays, lights: wave.group(), share, weighed: true, ..Visibility::default() }
}

/// Writes the visible shares of all emitters from the surface points of some bundles.
#[inline(always)]
fn shares_of_run<'a, S: Simd>(
    simd: S,
    wave: &'a HostWave<'a>,
    emitters: &[Emitter],
    run: impl Iterator<Item = &'a [u32]>,
    shares: &[AtomicU32],
) {
    let mut bundle = Bundle::new(simd, wave, emitters.len());
    for members in run {
        bundle.take(members);
        let lights = shares.chunks_exact(wave.hits.len());
        for ((number, emitter), shares) in emitters.iter().enumerate().zip(lights) {
            for (&ray, &share) in members.iter().zip(&bundle.shares(number, emitter)) {
                shares[ray as usize].store(share.to_bits(), Ordering::Relaxed);
            }
        }
    }
    Tally::add(&wave.context.tally.shadow_rays, bundle.asked);
}

/// The surface points of a bundle.
struct Bundle<'a, S: Simd> {
    simd: S,
    wave: &'a HostWave<'a>,
    members: &'a [u32],
    /// As shadow rays to any light leave them, and as they leave them for the light that is looked at.
    casting: Vec<ShadowPoint>,
    points: Vec<SurfacePoint>,
    groups: [Group<S>; GROUPS],
    around: Around,
    /// What rays to each emitter cost; 0 if that is not known.
    prices: Vec<f64>,
    /// The number of samples in front of their surfaces.
    asked: u64,
}

/// How far a search has come.
struct Progress {
    /// The number of samples seen before it.
    before: u32,
    /// Number of triangles found.
    found: u32,
    /// Number of candidates tested, each counted for each group.
    tested: u32,
    /// How many of them are compared with rays the next time.
    check: u32,
}

/// What a ray has cost; not 0.
fn price(rays: &SampleRays) -> f64 {
    f64::from(rays.nodes * NODE_COST + rays.triangles * TRIANGLE_COST).max(1.0) / f64::from(rays.cast.max(1))
}

/// What is known of the surface points that see anything of an emitter. Often it is the same for the next one.
struct Around {
    /// The points, a bit each.
    lanes: u32,
    origins: Bounds,
    planes: TangentPlanes,
}

impl<'a, S: Simd> Bundle<'a, S> {
    #[inline(always)]
    fn new(simd: S, wave: &'a HostWave<'a>, emitters: usize) -> Bundle<'a, S> {
        let groups = std::array::from_fn(
            #[inline(always)]
            |_| Group::new(simd),
        );
        let around = Around { lanes: 0, origins: Bounds::EMPTY, planes: TangentPlanes::NONE };
        Bundle {
            simd,
            wave,
            members: &[],
            casting: Vec::with_capacity(WARP as usize),
            points: Vec::with_capacity(WARP as usize),
            groups,
            around,
            prices: vec![0.0; emitters],
            asked: 0,
        }
    }

    /// Replaces the surface points.
    #[inline(always)]
    fn take(&mut self, members: &'a [u32]) {
        self.members = members;
        self.casting.clear();
        self.casting.extend(members.iter().map(|&ray| self.wave.shadow_point(ray as usize)));
        self.points.clear();
    }

    /// Places the surface points where a light is looked for, unless they are there.
    #[inline(always)]
    fn place(&mut self, emitter: &Emitter) {
        if !self.points.is_empty() && !self.casting.iter().any(ShadowPoint::is_curved) {
            return;
        }
        let geometry = &self.wave.scene.geometry;
        self.points.clear();
        self.points.extend(self.casting.iter().map(|point| emitter.seen_from(geometry, point)));
        self.around.lanes = 0;
        for (number, group) in self.groups.iter_mut().enumerate() {
            group.take(self.simd, &self.points[self.points.len().min(number * LANES)..]);
        }
    }

    /// The share of an emitter that each surface point sees.
    #[inline(always)]
    fn shares(&mut self, number: usize, emitter: &Emitter) -> [f32; WARP as usize] {
        self.place(emitter);
        let mut seen = [0; WARP as usize];
        let mut near = self.near(emitter);
        if emitter.is_point() {
            self.samples(&View { wave: self.wave, number, emitter, set: None }, &mut seen, &mut near);
        }
        for set in emitter.sets {
            self.samples(&View { wave: self.wave, number, emitter, set: Some(set) }, &mut seen, &mut near);
        }
        let mut shares = seen.map(|seen| emitter.share(seen));
        for (share, weighed) in shares.iter_mut().zip(&near).filter(|(_, weighed)| weighed.nearness > 0.0) {
            *share = weighed.share();
        }
        shares
    }

    /// What each surface point sees of an emitter that is near to any of them; else nothing.
    #[inline(always)]
    fn near(&self, emitter: &Emitter) -> Vec<Weighed> {
        let geometry = &self.wave.scene.geometry;
        let near: Vec<Weighed> = self.points.iter().map_while(|point| emitter.weighed(geometry, point)).collect();
        if near.iter().any(|weighed| weighed.nearness > 0.0) { near } else { Vec::new() }
    }

    /// Adds the samples that each surface point sees.
    #[inline(always)]
    fn samples(&mut self, view: &View, seen: &mut [u32; WARP as usize], near: &mut [Weighed]) {
        // 1. The samples in front of the surface.
        let mut lanes = 0;
        for (number, group) in self.groups.iter_mut().enumerate() {
            let first = self.points.len().min(number * LANES);
            group.begin(self.simd, view, &self.members[first..], &self.points[first..]);
            lanes |= group.lanes << (number * LANES);
        }
        let before = self.left(view);
        self.asked += u64::from(before);
        if lanes == 0 {
            return;
        }
        let mut above = [0; WARP as usize];
        if !near.is_empty() {
            self.groups
                .iter()
                .zip(above.chunks_mut(LANES))
                .for_each(|(group, above)| above.copy_from_slice(&group.seen(view)));
        }
        // 2. Search.
        self.look_around(lanes);
        let geometry = &self.wave.scene.geometry;
        let (origins, planes) = (self.around.origins, self.around.planes);
        let region = view.emitter.region(geometry, &origins).above(planes);
        let emitter = view.emitter.bounds(geometry, &origins);
        let radii = (view.emitter.radius(), view.emitter.body());
        for (number, group) in self.groups.iter_mut().enumerate().filter(|(_, group)| group.lanes != 0) {
            group.bound(&self.points[number * LANES..], &emitter, radii);
        }
        let simd = self.simd;
        let mut progress = Progress { before, found: 0, tested: 0, check: FIRST_CHECK * GROUPS as u32 };
        geometry.accelerator.search(&region, &mut |piece| {
            simd.vectorize(
                #[inline(always)]
                || self.piece(view, piece, &mut progress),
            )
        });
        for (group, seen) in self.groups.iter().zip(seen.chunks_mut(LANES)) {
            seen.iter_mut().zip(group.seen(view)).for_each(|(seen, more)| *seen += more);
        }
        // 6. What samples count near a light.
        for (number, (near, above)) in near.chunks_mut(LANES).zip(above.chunks(LANES)).enumerate() {
            let from = number * LANES;
            self.groups[number].weigh(simd, view, (&self.members[from..], &self.points[from..]), above, near);
        }
    }

    /// The box around the surface points of some lanes, and their tangent planes.
    #[inline(always)]
    fn look_around(&mut self, lanes: u32) {
        if self.around.lanes == lanes {
            return;
        }
        let living =
            || self.points.iter().enumerate().filter(|(lane, _)| lanes >> lane & 1 != 0).map(|(_, point)| point);
        let origins = Bounds::around(living().map(|point| point.origin));
        let planes = TangentPlanes::new(origins.min, living().map(|point| (point.origin, point.normal)), 0.0);
        self.around = Around { lanes, origins, planes };
    }

    /// Takes a piece of what was found. Returns whether more is wanted.
    #[inline(always)]
    fn piece(&mut self, view: &View, piece: &[u32], progress: &mut Progress) -> bool {
        if !self.test(view, piece, progress) {
            return false;
        }
        // 5. Rays instead of the rest.
        if progress.tested < progress.check {
            return true;
        }
        progress.check = 2 * progress.tested;
        let geometry = &self.wave.scene.geometry;
        match (view.set, geometry.accelerator.kind()) {
            (Some(set), AcceleratorKind::Bvh(bvh)) => !self.rays_instead(view, set, bvh, progress),
            _ => true,
        }
    }

    /// Whether rays are cheaper than going on; if so, they have been cast.
    #[inline(always)]
    fn rays_instead(&mut self, view: &View, set: &SampleRows, bvh: &Bvh, progress: &Progress) -> bool {
        let left = self.left(view);
        let tested = f64::from(progress.tested) * f64::from(CANDIDATE_COST + ROW_COST * set.rows);
        let spent = f64::from(progress.found) * f64::from(FOUND_COST) + tested;
        // The estimate assumes that candidates go on hiding samples at the same rate until none is left. If they hide few, the search may
        // soon end, so part of the price of the rays must have been spent.
        let going_on = spent * f64::from(left) / f64::from(progress.before - left + 1);
        let dearer = |ray: f64| going_on.min(MIN_COST_RATIO * spent) > ray * f64::from(left);
        if !dearer(f64::from(MIN_RAY_COST)) {
            return false;
        }
        // What a ray costs is found by casting a few, once for several bundles.
        let mut rays = SampleRays::default();
        if self.prices[view.number] == 0.0 {
            self.cast(view, bvh, (&mut rays, 1), 1);
            self.prices[view.number] = price(&rays);
        }
        if !dearer(self.prices[view.number]) {
            return false;
        }
        self.cast(view, bvh, (&mut rays, u32::MAX), LANES);
        self.prices[view.number] = price(&rays);
        true
    }

    /// Casts up to `most` rays from `asking` points of each group to samples still seen.
    #[inline(always)]
    fn cast(&mut self, view: &View, bvh: &Bvh, (rays, most): (&mut SampleRays, u32), asking: usize) {
        let simd = self.simd;
        simd.vectorize(
            #[inline(always)]
            || {
                for (number, group) in self.groups.iter_mut().enumerate().filter(|(_, group)| group.lanes != 0) {
                    let from = number * LANES;
                    group.cast(simd, (view, bvh), (&self.members[from..], &self.points[from..]), (rays, most), asking);
                }
            },
        );
    }

    /// The number of samples still seen.
    #[inline(always)]
    fn left(&self, view: &View) -> u32 {
        self.groups.iter().map(|group| group.seen(view).iter().sum::<u32>()).sum()
    }

    /// Tests a piece of what was found. Returns whether anything is still seen.
    #[inline(always)]
    fn test(&mut self, view: &View, piece: &[u32], progress: &mut Progress) -> bool {
        // 3. Candidates of all, from which each group chooses.
        progress.found += piece.len() as u32;
        let simd = self.simd;
        let triangles = &self.wave.scene.geometry.triangles;
        let mut candidates = Candidates::new();
        let extent = self.around.origins.extent();
        for indices in piece.chunks(LANES) {
            let corners = gathered(simd, triangles, indices);
            let mut above = above_planes(simd, &self.around.planes, extent, corners) & ((1 << indices.len()) - 1);
            while above != 0 {
                candidates.push(&triangles.at(indices[above.trailing_zeros() as usize & (LANES - 1)]));
                above &= above - 1;
            }
        }
        if candidates.count == 0 {
            return true;
        }
        // 4. What they hide.
        let mut lanes = 0;
        for (number, group) in self.groups.iter_mut().enumerate().filter(|(_, group)| group.lanes != 0) {
            let from = number * LANES;
            let tested = group.hide(simd, view, (&self.members[from..], &self.points[from..]), &candidates);
            progress.tested += tested;
            lanes |= group.lanes;
        }
        lanes != 0
    }
}
