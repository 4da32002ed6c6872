//! Formula (3) on the CPU: the values of a cell's template points are fetched once, then every object point of the cell takes
//! its mean.

use std::ops::Range;

use fearless_simd::{Level, dispatch, prelude::*};
use glam::IVec3;
use rayon::prelude::*;

use crate::accel::Hit;
use crate::job::{Job, Tally};
use crate::light_mesh::{LightMesh, UsedPoints, point_bit, point_of};
use crate::prepared::PreparedScene;
use crate::stages::light_points::Window;
use crate::stages::long_tests::{Lit, LitBy};
use crate::stages::primary_rays::RayList;
use crate::stages::shadow_rays::cpu::{fallback, object_point, ray_key};
use crate::stages::shadow_rays::{Visibility, faces};
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
        let runs = self.masks.groups.runs(RUN);
        let parts: Vec<(Vec<f32>, u64)> = runs
            .par_iter()
            .map(|run| {
                if self.job.observer.cancelled() {
                    return (Vec::new(), 0);
                }
                dispatch!(level, simd => self.shares(simd, run.clone()))
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
    fn shares<S: Simd>(&self, simd: S, run: Range<usize>) -> (Vec<f32>, u64) {
        let lights = &self.scene.scene.lights;
        let mut points = CellPoints::new(self.mesh);
        let mut values = CellValues::new(self.mesh, self.lit);
        let mut shares = Vec::new();
        let mut fallbacks = 0;
        for group in run {
            let cell = point_of(self.masks.groups.cell(group));
            points.place(self.mesh, cell);
            values.fetch(self.mesh, self.points, self.lit, cell);
            for slot in self.masks.groups.slots(group) {
                let ray = self.masks.groups.members()[slot] as usize;
                let point = object_point(self.scene, self.list, self.hits, ray);
                let mask = self.masks.mask(slot);
                let mut fell_back = false;
                for (index, light) in lights.iter().enumerate() {
                    shares.push(if !faces(&point, light, self.scene.reach(point.origin)) {
                        0.0
                    } else if let Some(share) = values.mean(simd, &points, &point, self.mesh, mask, index) {
                        share
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
struct CellValues {
    window: Window,
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

impl CellValues {
    fn new(mesh: &LightMesh, lit: &Lit) -> CellValues {
        let words = mesh.template.words();
        let window = Window::new(&mesh.template);
        let values = || LightValues { full: vec![0; words], some: vec![0; words], share: vec![0.0; 32 * words] };
        CellValues { bricks: vec![None; window.len()], window, lights: lit.lights.iter().map(|_| values()).collect() }
    }

    /// Fetches the values around `cell`. Points that nobody uses come out as dark; no mask has them.
    fn fetch(&mut self, mesh: &LightMesh, points: &UsedPoints, lit: &Lit, cell: IVec3) {
        self.window.place(&mesh.template, cell);
        for (slot, brick) in self.bricks.iter_mut().enumerate() {
            *brick = points.bricks().find(self.window.key(slot));
        }
        for (values, lit) in self.lights.iter_mut().zip(&lit.lights) {
            values.full.fill(0);
            values.some.fill(0);
            for (bit, &offset) in mesh.template.offsets().iter().enumerate() {
                let index = cell + offset;
                let share = self.bricks[self.window.slot(index)].map_or(0.0, |brick| seen(points, lit, brick, index));
                values.share[bit] = share;
                values.full[bit / 32] |= u32::from(share == 1.0) << (bit % 32);
                values.some[bit / 32] |= u32::from(share > 0.0) << (bit % 32);
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

/// The share of a light that a used point sees.
#[inline(always)]
fn seen(points: &UsedPoints, lit: &LitBy, brick: usize, index: IVec3) -> f32 {
    let bit = point_bit(index);
    match lit {
        LitBy::Bits(words) => (words[brick] >> bit & 1) as f32,
        LitBy::Share { .. } if points.used()[brick] >> bit & 1 == 0 => 0.0,
        LitBy::Share { seen, samples } => f32::from(seen[points.rank(brick, bit)]) / *samples as f32,
    }
}
