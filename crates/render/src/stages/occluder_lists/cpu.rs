//! Occluder lists on the CPU: lanes are surface points, a triangle is the same for all of them.

use std::sync::atomic::{AtomicU32, Ordering};

use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x8, u32x8};
use lightmesh_layout::constants::{MOST_ROWS, MOST_WORDS, WARP};
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::Bounds;
use rayon::prelude::*;

use super::candidates::{Chosen, Shaft};
use crate::accel::TangentPlanes;
use crate::counters::Tally;
use crate::data::items::Items;
use crate::data::visibility::Visibility;
use crate::data::wave::HostWave;
use crate::shadow::Aim;
use crate::shadow::occlusion::{Bits, Offsets, Sights, gathered};
use crate::shadow::rows::Rows;
use crate::shadow::sight::{Emitter, Sight};
use crate::simd::{LANES, dispatch, splat};
use crate::surface::SurfacePoint;

/// Items per task.
const RUN: usize = 16;
/// Groups of lanes of an item.
const GROUPS: usize = WARP as usize / LANES;

/// The visible share of each light from each surface point.
pub(crate) fn occluder_lists(wave: &HostWave, items: &Items, aim: &Aim) -> Visibility {
    let rows = Rows::of(aim);
    let emitters = Emitter::all(wave, aim, &rows);
    let level = Level::new();
    // Each share has one writer.
    let rays = wave.hits.len();
    let shares: Vec<AtomicU32> = (0..emitters.len() * rays).map(|_| AtomicU32::new(0)).collect();
    (0..items.len().div_ceil(RUN)).into_par_iter().for_each(|run| {
        let run = run * RUN..items.len().min((run + 1) * RUN);
        let points = run.clone().map(|item| items.members(item).len()).sum();
        wave.job.piece(points, || {
            let mut item = ItemShadows::default();
            for members in run.map(|item| items.members(item)) {
                item.points.clear();
                item.points.extend(members.iter().map(|&ray| wave.surface_point(ray as usize)));
                for (emitter, shares) in emitters.iter().zip(shares.chunks_exact(rays)) {
                    let seen = dispatch!(level, simd => item.seen(simd, wave, members, emitter));
                    for (&ray, &seen) in members.iter().zip(&seen) {
                        shares[ray as usize].store(emitter.share(seen).to_bits(), Ordering::Relaxed);
                    }
                }
            }
            Tally::add(&wave.job.tally.shadow_rays, item.asked);
        });
    });
    // In the same memory.
    let share = shares.into_iter().map(|share| f32::from_bits(share.into_inner())).collect();
    Visibility { rays, lights: wave.group(), share, used: Vec::new() }
}

/// The surface points of an item, and buffers.
#[derive(Default)]
struct ItemShadows {
    points: Vec<SurfacePoint>,
    sights: Vec<Sight>,
    found: Vec<u32>,
    /// The number of samples in front of their surfaces.
    asked: u64,
}

/// Eight surface points of an item.
struct Group<S: Simd> {
    sights: Sights<S>,
    offsets: Offsets<S>,
    /// The samples still seen.
    bits: Bits<S>,
    /// The lanes that still see any.
    lanes: u32,
}

impl ItemShadows {
    /// How many samples of an emitter each surface point sees.
    #[inline(always)]
    fn seen<S: Simd>(&mut self, simd: S, wave: &HostWave, members: &[u32], emitter: &Emitter) -> [u32; WARP as usize] {
        let mut seen = [0; WARP as usize];
        self.sights.clear();
        let sights = members.iter().zip(&self.points).map(|(&ray, point)| emitter.sight(wave, ray as usize, point));
        self.sights.extend(sights);
        if emitter.is_point() {
            self.center(simd, wave, emitter, &mut seen);
        }
        for set in emitter.sets {
            self.samples(simd, wave, emitter, set, &mut seen);
        }
        seen
    }

    /// Adds the samples of a set that each surface point sees.
    #[inline(always)]
    fn samples<S: Simd>(&mut self, simd: S, wave: &HostWave, emitter: &Emitter, set: &SampleRows, seen: &mut [u32]) {
        // 1. The samples in front of the surface.
        let mut groups: [Option<Group<S>>; GROUPS] = [const { None }; GROUPS];
        for ((group, points), sights) in groups.iter_mut().zip(self.points.chunks(LANES)).zip(self.sights.chunks(LANES))
        {
            let unhidden = Group::new(simd, set, points, sights);
            self.asked += unhidden.seen(set).iter().map(|&seen| u64::from(seen)).sum::<u64>();
            *group = Some(unhidden);
        }
        let lanes = |groups: &[Option<Group<S>>; GROUPS]| {
            let lanes =
                |(at, group): (usize, &Option<Group<S>>)| group.as_ref().map_or(0, |group| group.lanes) << (at * LANES);
            groups.iter().enumerate().map(lanes).sum::<u32>()
        };
        let alive = lanes(&groups);
        if alive == 0 {
            return;
        }
        // 2. Search.
        let emitter_box = self.search(wave, emitter, alive);
        let triangles = &wave.scene.geometry.triangles;
        for (group, points) in
            groups.iter_mut().flatten().zip(self.points.chunks(LANES)).filter(|(group, _)| group.lanes != 0)
        {
            // 3. Candidates.
            let living = points.iter().enumerate().filter(|(lane, _)| group.lanes >> lane & 1 != 0);
            let shaft =
                Shaft::new(&Bounds::around(living.map(|(_, point)| point.origin)), (&emitter_box.0, emitter_box.1));
            for indices in self.found.chunks(LANES) {
                let Chosen { mut kept, dark } = shaft.choose(simd, gathered(simd, triangles, indices));
                kept &= (1 << indices.len()) - 1;
                // A triangle that hides everything comes first; then there is nothing left to ask.
                let mut first = dark & kept;
                // 4. What they hide.
                while kept != 0 && group.lanes != 0 {
                    let next = if first != 0 { first.trailing_zeros() } else { kept.trailing_zeros() };
                    let corners = triangles[indices[next as usize] as usize].corners();
                    (first, kept) = (first & !(1 << next), kept & !(1 << next));
                    group.sights.hide(
                        simd,
                        corners.map(|corner| splat(simd, corner)),
                        (set, &group.offsets),
                        group.lanes,
                        &mut group.bits,
                    );
                    group.lanes = lanes_of(simd, &group.bits, set);
                }
                if group.lanes == 0 {
                    break;
                }
            }
        }
        for (group, seen) in groups.iter().flatten().zip(seen.chunks_mut(LANES)) {
            seen.iter_mut().zip(group.seen(set)).for_each(|(seen, more)| *seen += more);
        }
    }

    /// Finds which surface points see the centre.
    #[inline(always)]
    fn center<S: Simd>(&mut self, simd: S, wave: &HostWave, emitter: &Emitter, seen: &mut [u32]) {
        let mut groups: [Option<Sights<S>>; GROUPS] = [const { None }; GROUPS];
        let mut alive = 0;
        for (at, (points, sights)) in self.points.chunks(LANES).zip(self.sights.chunks(LANES)).enumerate() {
            let sights = Sights::gather(simd, points, sights);
            let lanes = sights.center_above_horizon(simd).to_bitmask() as u32 & ((1 << points.len()) - 1);
            self.asked += u64::from(lanes.count_ones());
            alive |= lanes << (at * LANES);
            groups[at] = Some(sights);
        }
        if alive == 0 {
            return;
        }
        let emitter_box = self.search(wave, emitter, alive);
        let living = self.points.iter().enumerate().filter(|(lane, _)| alive >> lane & 1 != 0);
        let shaft = Shaft::new(&Bounds::around(living.map(|(_, point)| point.origin)), (&emitter_box.0, emitter_box.1));
        let triangles = &wave.scene.geometry.triangles;
        for indices in self.found.chunks(LANES) {
            let mut kept = shaft.choose(simd, gathered(simd, triangles, indices)).kept & ((1 << indices.len()) - 1);
            while kept != 0 && alive != 0 {
                let index = indices[kept.trailing_zeros() as usize];
                kept &= kept - 1;
                let corners = triangles[index as usize].corners().map(|corner| splat(simd, corner));
                for (at, sights) in groups.iter().flatten().enumerate() {
                    let lanes = alive >> (at * LANES) & 0xff;
                    if lanes != 0 {
                        alive &= !(sights.hides_center(simd, corners, lanes) << (at * LANES));
                    }
                }
            }
            if alive == 0 {
                return;
            }
        }
        seen.iter_mut().enumerate().for_each(|(lane, seen)| *seen = alive >> lane & 1);
    }

    /// Finds the triangles that may hide an emitter from those surface points that are `alive`.
    fn search(&mut self, wave: &HostWave, emitter: &Emitter, alive: u32) -> (Bounds, f32) {
        let geometry = &wave.scene.geometry;
        let living =
            || self.points.iter().enumerate().filter(|(lane, _)| alive >> lane & 1 != 0).map(|(_, point)| point);
        let origins = Bounds::around(living().map(|point| point.origin));
        let planes = TangentPlanes::new(origins.min, living().map(|point| (point.origin, point.normal)), 0.0);
        let region = emitter.region(geometry, &origins).above(planes);
        geometry.accelerator.triangles_in(&region, &mut self.found);
        (emitter.bounds(geometry, &origins), emitter.radius())
    }
}

impl<S: Simd> Group<S> {
    /// Some surface points, with the samples in front of their surfaces.
    #[inline(always)]
    fn new(simd: S, set: &SampleRows, points: &[SurfacePoint], sights: &[Sight]) -> Group<S> {
        let gathered = Sights::gather(simd, points, sights);
        let mut offsets = [f32x8::splat(simd, 0.0); MOST_ROWS as usize];
        for (row, offset) in offsets.iter_mut().enumerate().take(set.rows as usize) {
            let mut lanes = [0.0; LANES];
            lanes.iter_mut().zip(sights).for_each(|(lane, sight)| *lane = sight.offset(set, row));
            *offset = f32x8::from_slice(simd, &lanes);
        }
        let mut bits = gathered.above_horizon(simd, set, &offsets);
        for (word, bits) in bits.iter_mut().enumerate().take(set.words as usize) {
            let mut lanes = [0; LANES];
            lanes.iter_mut().zip(sights).for_each(|(lane, sight)| *lane = sight.valid_word(set, word));
            *bits &= u32x8::from_slice(simd, &lanes);
        }
        let lanes = lanes_of(simd, &bits, set);
        Group { sights: gathered, offsets, bits, lanes }
    }

    /// The number of samples that each lane sees.
    #[inline(always)]
    fn seen(&self, set: &SampleRows) -> [u32; LANES] {
        let mut seen = [0; LANES];
        for bits in &self.bits[..set.words as usize] {
            let bits: [u32; LANES] = (*bits).into();
            seen.iter_mut().zip(bits).for_each(|(seen, bits)| *seen += bits.count_ones());
        }
        seen
    }
}

/// The lanes that have any bits.
#[inline(always)]
fn lanes_of<S: Simd>(simd: S, bits: &[u32x8<S>; MOST_WORDS as usize], set: &SampleRows) -> u32 {
    let mut any = u32x8::splat(simd, 0);
    for bits in &bits[..set.words as usize] {
        any |= *bits;
    }
    (!any.simd_eq(u32x8::splat(simd, 0))).to_bitmask() as u32
}
