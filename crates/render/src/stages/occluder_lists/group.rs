//! Eight surface points of a bundle, and what they see of an emitter.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, mask32x8, u32x8};
use lightmesh_layout::constants::{MAX_ROWS, MAX_WORDS};
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::Bounds;
use lightmesh_trace::accel::Bvh;
use lightmesh_trace::simd::{Axes, LANES};

use super::candidates::{Candidates, Chosen, Shaft};
use crate::data::wave::HostWave;
use crate::shadow::cuts::Cuts;
use crate::shadow::occlusion::{Bits, Offsets, ProjectedLights};
use crate::shadow::projected_light::{Emitter, ProjectedLight};
use crate::shadow::sample_ray::SampleRays;
use crate::shadow::weights::Weighed;
use crate::surface::SurfacePoint;

/// What is looked at.
pub(super) struct View<'a> {
    pub(super) wave: &'a HostWave<'a>,
    pub(super) number: usize,
    pub(super) emitter: &'a Emitter<'a>,
    /// Some of its samples; `None`: its centre.
    pub(super) set: Option<&'a SampleRows>,
}

/// Up to eight surface points. Lanes without one repeat the first, and see nothing.
pub(super) struct Group<S: Simd> {
    origin: Axes<S>,
    normal: Axes<S>,
    /// The lanes that have a surface point.
    has: u32,
    /// Whether the light is projected: that is done when it is needed, since most bundles find nothing between them and a light.
    looked: bool,
    shaft: Shaft,
    projected: [ProjectedLight; LANES],
    projected_lights: ProjectedLights<S>,
    offsets: Offsets<S>,
    /// The samples still seen.
    bits: Bits<S>,
    /// The lanes that still see any, or the centre.
    pub(super) lanes: u32,
}

impl<S: Simd> Group<S> {
    /// Without surface points.
    #[inline(always)]
    pub(super) fn new(simd: S) -> Group<S> {
        let (zero, none) = (f32x8::splat(simd, 0.0), [f32x8::splat(simd, 0.0); 3]);
        let projected = [ProjectedLight::default(); LANES];
        Group {
            origin: none,
            normal: none,
            has: 0,
            looked: false,
            shaft: Shaft::default(),
            projected,
            projected_lights: ProjectedLights::splat(simd, &SurfacePoint::default(), &projected[0]),
            offsets: [zero; MAX_ROWS as usize],
            bits: [u32x8::splat(simd, 0); MAX_WORDS as usize],
            lanes: 0,
        }
    }

    /// Replaces the surface points by the first of `points`.
    #[inline(always)]
    pub(super) fn take(&mut self, simd: S, points: &[SurfacePoint]) {
        let count = points.len().min(LANES);
        self.has = (1 << count) - 1;
        if count == 0 {
            return;
        }
        let mut numbers = [[0.0; LANES]; 6];
        for lane in 0..LANES {
            let SurfacePoint { origin, normal, .. } = points[if lane < count { lane } else { 0 }];
            for axis in 0..3 {
                (numbers[axis][lane], numbers[3 + axis][lane]) = (origin[axis], normal[axis]);
            }
        }
        let [x, y, z, u, v, w] = &numbers;
        self.origin = [f32x8::from_slice(simd, x), f32x8::from_slice(simd, y), f32x8::from_slice(simd, z)];
        self.normal = [f32x8::from_slice(simd, u), f32x8::from_slice(simd, v), f32x8::from_slice(simd, w)];
    }

    /// Finds the samples in front of the surfaces. Where all or none of a disc is in front of all of them, that needs no projection.
    #[inline(always)]
    pub(super) fn begin(&mut self, simd: S, view: &View, rays: &[u32], points: &[SurfacePoint]) {
        self.looked = false;
        self.lanes = 0;
        if self.has == 0 {
            return;
        }
        let Some(set) = view.set else {
            self.look(simd, view, rays, points);
            self.lanes = self.projected_lights.center_above_horizon(simd).to_bitmask() as u32 & self.has;
            return;
        };
        if view.emitter.is_disc() {
            let (above, below) = view.emitter.heights(simd, &view.wave.scene.geometry, self.origin, self.normal);
            if (above | below) & self.has == self.has {
                self.lanes = above & self.has;
                let lanes = mask32x8::from_bitmask(simd, u64::from(self.lanes));
                for word in 0..set.words as usize {
                    self.bits[word] = lanes.select(u32x8::splat(simd, set.full[word]), u32x8::splat(simd, 0));
                }
                return;
            }
        }
        self.look(simd, view, rays, points);
        self.bits = self.projected_lights.above_horizon(simd, set, &self.offsets);
        for (word, bits) in self.bits.iter_mut().enumerate().take(set.words as usize) {
            let mut lanes = [0; LANES];
            let projected_lights = self.projected.iter().take(self.has.count_ones() as usize);
            lanes
                .iter_mut()
                .zip(projected_lights)
                .for_each(|(lane, projected)| *lane = projected.valid_word(set, word));
            *bits &= u32x8::from_slice(simd, &lanes);
        }
        self.lanes = lanes_of(simd, &self.bits, set);
    }

    /// Projects the light for each point.
    #[inline(always)]
    fn look(&mut self, simd: S, view: &View, rays: &[u32], points: &[SurfacePoint]) {
        self.looked = true;
        let count = self.has.count_ones() as usize;
        for ((projected, &ray), point) in self.projected.iter_mut().zip(&rays[..count]).zip(points) {
            *projected = view.emitter.projected(view.wave, ray as usize, point);
        }
        self.projected_lights = ProjectedLights::gather(simd, &points[..count], &self.projected);
        let Some(set) = view.set else { return };
        for (row, offset) in self.offsets.iter_mut().enumerate().take(set.rows as usize) {
            let mut lanes = [0.0; LANES];
            lanes.iter_mut().zip(&self.projected).for_each(|(lane, projected)| *lane = projected.offset(set, row));
            *offset = f32x8::from_slice(simd, &lanes);
        }
    }

    /// Prepares for the choice among candidates.
    #[inline(always)]
    pub(super) fn bound(&mut self, points: &[SurfacePoint], emitter: &Bounds, radii: (f32, f32)) {
        let living = points.iter().take(LANES).enumerate().filter(|(lane, _)| self.lanes >> lane & 1 != 0);
        self.shaft = Shaft::new(&Bounds::around(living.map(|(_, point)| point.origin)), emitter, radii);
    }

    /// Clears what candidates hide, until nothing is seen. Returns how many were tested.
    #[inline(always)]
    pub(super) fn hide(
        &mut self,
        simd: S,
        view: &View,
        (rays, points): (&[u32], &[SurfacePoint]),
        candidates: &Candidates,
    ) -> u32 {
        let mut tested = 0;
        for first in (0..candidates.count).step_by(LANES) {
            // 3. Those of the eight points. A triangle that hides everything, but for what is cut out of it, comes first; then there is
            // often nothing left to ask.
            let Chosen { kept, dark } = self.shaft.choose(simd, candidates.eight(simd, first));
            let mut kept = kept & (0xff >> (LANES - (candidates.count - first).min(LANES)));
            let mut dark = dark & kept;
            if kept != 0 && !self.looked {
                self.look(simd, view, rays, points);
            }
            // 4. What they hide.
            while kept != 0 {
                let next = if dark != 0 { dark.trailing_zeros() } else { kept.trailing_zeros() };
                (dark, kept) = (dark & !(1 << next), kept & !(1 << next));
                let number = first + next as usize;
                let cuts = Cuts::splat(&view.wave.scene.geometry.alpha_mask, candidates.cut(number));
                let held = (candidates.splat(simd, number), cuts);
                match view.set {
                    Some(set) => {
                        self.projected_lights.hide(simd, held, (set, &self.offsets), self.lanes, &mut self.bits);
                        self.lanes = lanes_of(simd, &self.bits, set);
                    }
                    None => self.lanes &= !self.projected_lights.hides_center(simd, held, self.lanes),
                }
                tested += 1;
                if self.lanes == 0 {
                    return tested;
                }
            }
        }
        tested
    }

    /// Casts up to `most` rays from each of the first `asking` lanes to samples still seen.
    #[inline(always)]
    pub(super) fn cast(
        &mut self,
        simd: S,
        (view, bvh): (&View, &Bvh),
        (rays, points): (&[u32], &[SurfacePoint]),
        (sample_rays, most): (&mut SampleRays, u32),
        asking: usize,
    ) {
        let Some(set) = view.set else { return };
        if !self.looked {
            self.look(simd, view, rays, points);
        }
        let mut seen = self.bits.map(<[u32; LANES]>::from);
        for lane in (0..LANES).filter(|lane| self.lanes >> lane & 1 != 0).take(asking) {
            sample_rays.most = most;
            for (word, seen) in seen.iter_mut().enumerate().take(set.words as usize).filter(|(_, seen)| seen[lane] != 0)
            {
                let from = (&points[lane], &self.projected[lane]);
                seen[lane] = sample_rays.cast(simd, (bvh, view.emitter.scale()), from, (set, word), seen[lane]);
            }
        }
        for (bits, seen) in self.bits.iter_mut().zip(&seen).take(set.words as usize) {
            *bits = u32x8::from_slice(simd, seen);
        }
        self.lanes = lanes_of(simd, &self.bits, set);
    }

    /// Adds what the points that are `near` see: of the samples of a single set their weights, unless all or none of those `above` are seen.
    #[inline(always)]
    pub(super) fn weigh(
        &mut self,
        simd: S,
        view: &View,
        (rays, points): (&[u32], &[SurfacePoint]),
        above: &[u32],
        near: &mut [Weighed],
    ) {
        let (Some(set), seen) = (view.set, self.seen(view)) else { return };
        for (lane, weighed) in near.iter_mut().enumerate().filter(|(_, weighed)| weighed.nearness > 0.0) {
            weighed.count(above[lane], seen[lane]);
            if view.emitter.sets.len() == 1 && weighed.is_plain() {
                continue;
            }
            if !self.looked {
                self.look(simd, view, rays, points);
            }
            let mut bits = [0; MAX_WORDS as usize];
            if self.lanes != 0 {
                bits.iter_mut().zip(&self.bits).for_each(|(bits, word)| *bits = <[u32; LANES]>::from(*word)[lane]);
            }
            let projected = &self.projected[lane];
            weighed.add(&view.emitter.weights(&points[lane], projected), projected, set, &bits);
        }
    }

    /// The number of samples that each lane sees.
    #[inline(always)]
    pub(super) fn seen(&self, view: &View) -> [u32; LANES] {
        let mut seen = [0; LANES];
        let Some(set) = view.set else {
            seen.iter_mut().enumerate().for_each(|(lane, seen)| *seen = self.lanes >> lane & 1);
            return seen;
        };
        if self.lanes != 0 {
            for bits in &self.bits[..set.words as usize] {
                let bits: [u32; LANES] = (*bits).into();
                seen.iter_mut().zip(bits).for_each(|(seen, bits)| *seen += bits.count_ones());
            }
        }
        seen
    }
}

/// The lanes that have any bits.
#[inline(always)]
fn lanes_of<S: Simd>(simd: S, bits: &Bits<S>, set: &SampleRows) -> u32 {
    let mut any = u32x8::splat(simd, 0);
    for bits in &bits[..set.words as usize] {
        any |= *bits;
    }
    (!any.simd_eq(u32x8::splat(simd, 0))).to_bitmask() as u32
}
