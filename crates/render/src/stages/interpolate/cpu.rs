//! Formula (3) on the CPU: the values of a cell's template points are fetched once, then every object point of the cell takes
//! its mean.

use std::ops::Range;

use fearless_simd::{Level, prelude::*};
use rayon::prelude::*;

use crate::accel::Hit;
use crate::job::{Job, Tally};
use crate::light_mesh::{LightMesh, UsedPoints, point_of};
use crate::prepared::PreparedScene;
use crate::simd::dispatch;
use crate::stages::light_points::{Place, Windows};
use crate::stages::long_tests::{Lit, LitBy};
use crate::stages::primary_rays::{RayList, object_point};
use crate::stages::shadow_rays::cpu::{fallback, ray_key};
use crate::stages::shadow_rays::{Visibility, above_horizon};
use crate::stages::short_tests::{CellPoints, Masks, population};
use crate::surface::SurfacePoint;

/// Object points that one task takes.
const RUN: usize = 4096;

/// What formula (3) needs.
pub(crate) struct Interpolation<'a> {
    pub(crate) job: &'a Job<'a>,
    pub(crate) scene: &'a PreparedScene<'a>,
    pub(crate) list: &'a RayList,
    pub(crate) hits: &'a [Hit],
    pub(crate) masks: &'a Masks,
    pub(crate) points: &'a UsedPoints,
    pub(crate) lit: &'a Lit,
    pub(crate) mesh: &'a LightMesh,
}

impl Interpolation<'_> {
    pub(crate) fn run(&self) -> Visibility {
        let lights = self.lit.lights.len();
        let level = Level::new();
        let windows = Windows::new(&self.mesh.template);
        let runs = self.masks.groups.runs(RUN);
        let parts: Vec<(Vec<f32>, u64)> = runs
            .par_iter()
            .map(|run| {
                if self.job.observer.cancelled() {
                    return (Vec::new(), 0);
                }
                dispatch!(level, simd => self.shares(simd, &windows, run.clone()))
            })
            .collect();

        // From the order of cells back to the order of rays.
        let mut share = vec![0.0; self.hits.len() * lights];
        let mut used = vec![0; self.hits.len()];
        let members = self.masks.groups.members();
        let found = parts.iter().flat_map(|(shares, _)| shares.chunks_exact(lights.max(1)));
        for (&ray, shares) in members.iter().zip(found) {
            share[ray as usize * lights..][..lights].copy_from_slice(shares);
        }
        for (slot, &ray) in members.iter().enumerate() {
            used[ray as usize] = population(self.masks.mask(slot)) as u32;
        }
        Tally::add(&self.job.tally.fallbacks, parts.iter().map(|(_, fallbacks)| fallbacks).sum());
        Visibility { lights, share, used, direct: Vec::new() }
    }

    /// The shares of the object points of some cells, `lights` for each, and how many found no light point.
    #[inline(always)]
    fn shares<S: Simd>(&self, simd: S, windows: &Windows, run: Range<usize>) -> (Vec<f32>, u64) {
        let lights = &self.scene.scene.lights;
        let mut points = CellPoints::new(self.mesh);
        let mut values = CellValues::new(self, windows);
        let mut shares = Vec::new();
        let mut fallbacks = 0;
        for group in run {
            let cell = point_of(self.masks.groups.cell(group));
            points.place(self.mesh, cell);
            values.fetch(cell);
            for slot in self.masks.groups.slots(group) {
                let ray = self.masks.groups.members()[slot] as usize;
                let point = object_point(self.scene, self.list, self.hits, ray);
                let mask = self.masks.mask(slot);
                let mut fell_back = false;
                for (index, light) in lights.iter().enumerate() {
                    let most = above_horizon(&point, light, self.scene.reach(point.origin));
                    shares.push(if most == 0.0 {
                        0.0
                    } else if let Some(share) = values.mean(simd, &points, &point, self.mesh, mask, index) {
                        share.min(most)
                    } else {
                        fell_back = true;
                        fallback(self.job, self.scene, ray_key(self.list, ray), &point, index)
                    });
                }
                fallbacks += u64::from(fell_back || (lights.is_empty() && population(mask) == 0));
            }
        }
        (shares, fallbacks)
    }
}

/// What the template points of one cell see, in the template's order.
struct CellValues<'a> {
    points: &'a UsedPoints,
    lit: &'a Lit,
    windows: &'a Windows,
    bricks: Vec<Option<usize>>,
    lights: Vec<LightValues>,
}

/// The template points' values for one light.
struct LightValues {
    /// Points that see all of the light.
    full: Vec<u32>,
    /// Points that see some of it.
    some: Vec<u32>,
    /// The share that each point sees, padded to whole words.
    share: Vec<f32>,
}

impl<'a> CellValues<'a> {
    fn new(work: &Interpolation<'a>, windows: &'a Windows) -> CellValues<'a> {
        let words = work.mesh.template.words();
        let values = || LightValues { full: vec![0; words], some: vec![0; words], share: vec![0.0; 32 * words] };
        CellValues {
            points: work.points,
            lit: work.lit,
            windows,
            bricks: vec![None; windows.len()],
            lights: work.lit.lights.iter().map(|_| values()).collect(),
        }
    }

    /// Fetches the values around `cell`. Points that nobody uses come out as dark; no mask has them.
    fn fetch(&mut self, cell: glam::IVec3) {
        let window = self.windows.around(cell);
        for (slot, brick) in self.bricks.iter_mut().enumerate() {
            *brick = self.points.bricks().find(window.key(slot));
        }
        for (values, lit) in self.lights.iter_mut().zip(&self.lit.lights) {
            match lit {
                LitBy::Bits(words) => values.fetch_bits(window.places, &self.bricks, words),
                LitBy::Share { seen, samples } => {
                    values.fetch_shares(window.places, &self.bricks, self.points, seen, *samples);
                }
            }
        }
    }

    /// Formula (3) without χ for one light; `None` where no light point counts.
    #[inline(always)]
    fn mean<S: Simd>(
        &self,
        simd: S,
        points: &CellPoints,
        point: &SurfacePoint,
        mesh: &LightMesh,
        mask: &[u32],
        light: usize,
    ) -> Option<f32> {
        let values = &self.lights[light];
        let (mut dark, mut not_full, mut any) = (true, false, false);
        for (word, (full, some)) in mask.iter().zip(values.full.iter().zip(&values.some)) {
            any |= *word != 0;
            dark &= word & some == 0;
            not_full |= word & !full != 0;
        }
        if !any {
            return None;
        }
        // All alike: the mean is known without weights.
        if dark {
            return Some(0.0);
        }
        if !not_full {
            return Some(1.0);
        }
        let (weights, products) = points.weighted(simd, point.position, mesh, mask, &values.share);
        // Weights that vanish at the rim may vanish altogether.
        (weights > 0.0).then(|| (products / weights).min(1.0))
    }
}

impl LightValues {
    fn fetch_bits(&mut self, places: &[Place], bricks: &[Option<usize>], words: &[u64]) {
        for ((places, some), shares) in places.chunks(32).zip(&mut self.some).zip(self.share.chunks_mut(32)) {
            *some = 0;
            for (bit, (place, share)) in places.iter().zip(shares).enumerate() {
                let word = bricks[usize::from(place.slot)].map_or(0, |brick| words[brick]);
                let seen = (word >> place.bit & 1) as u32;
                *some |= seen << bit;
                *share = seen as f32;
            }
        }
        self.full.copy_from_slice(&self.some);
    }

    fn fetch_shares(
        &mut self,
        places: &[Place],
        bricks: &[Option<usize>],
        points: &UsedPoints,
        seen: &[u16],
        samples: u32,
    ) {
        self.full.fill(0);
        self.some.fill(0);
        for (index, place) in places.iter().enumerate() {
            let brick = bricks[usize::from(place.slot)];
            let brick = brick.filter(|&brick| points.used()[brick] >> place.bit & 1 != 0);
            let count = brick.map_or(0, |brick| u32::from(seen[points.rank(brick, u32::from(place.bit))]));
            self.share[index] = count as f32 / samples as f32;
            self.full[index / 32] |= u32::from(count == samples) << (index % 32);
            self.some[index / 32] |= u32::from(count > 0) << (index % 32);
        }
    }
}
