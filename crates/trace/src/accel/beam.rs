//! The closest hits of rays that lie close together, where it is known about how far they go.
//!
//! # Theory
//!
//! All rays of a *beam* lie in one slender [shaft](Region::shaft), so that one search finds the triangles that any of them can hit up to
//! some distance. Few triangles meet so narrow a space: testing each against all rays, eight at a time, takes less time than a walk
//! for each packet of rays. A hit within the distance is the closest one. Rays that hit nothing there are *left*, and so are beams with
//! too many triangles; they take the usual way.
//!
//! # What is rounded
//!
//! A hit at the computed `t` lies within 9 ε S of its triangle on every axis, S being the largest coordinate of a corner relative to the
//! origin ([`triangle`](super::triangle)): the shaft is that much wider on all sides, and 2⁻¹⁶ of its length longer.

use fearless_simd::prelude::*;
use fearless_simd::{Level, f32x8};
use lightmesh_scene::Bounds;

use super::packet::{ClosestPacket, LANES, PacketShear, PacketVisitor};
use super::ray_clamp::RayClamp;
use super::triangle::largest_axis;
use super::{Accelerator, AcceleratorKind, AlphaMask, Hit, Ray, Region, Triangles};
use crate::simd::dispatch;

/// Triangles of a beam; with more, packets take less time.
const MOST: usize = 64;
/// Twice 9 ε.
const ROUNDING: f32 = 1.0 / (1 << 19) as f32;
/// The part of its length by which a shaft is longer than what is asked for.
const LONGER: f32 = 1.0 / (1 << 16) as f32;

/// Searches beams in a structure.
pub struct Beams<'a> {
    accelerator: &'a dyn Accelerator,
    triangles: &'a Triangles,
    alpha_mask: &'a AlphaMask,
    ray_clamp: RayClamp,
    level: Level,
    found: Vec<u32>,
    left: Vec<(usize, Ray)>,
}

impl<'a> Beams<'a> {
    /// Beams in `accelerator`, which holds `triangles` in `bounds`.
    pub fn new(
        accelerator: &'a dyn Accelerator,
        triangles: &'a Triangles,
        alpha_mask: &'a AlphaMask,
        bounds: &Bounds,
    ) -> Beams<'a> {
        let (level, ray_clamp) = (Level::new(), RayClamp::new(bounds));
        Beams { accelerator, triangles, alpha_mask, ray_clamp, level, found: Vec::new(), left: Vec::new() }
    }

    /// The closest hits of `rays`, whose directions have unit length, cut into beams of `size` rays. `far` says how far those of a beam
    /// should be searched; `None`: as far as there are triangles. The same bits as [`Accelerator::closest_hits`].
    pub fn closest_hits(&mut self, rays: &[Ray], size: usize, far: impl Fn(usize) -> Option<f32>, hits: &mut [Hit]) {
        self.left.clear();
        let beams = rays.chunks(size).zip(hits.chunks_mut(size));
        for (beam, (rays, hits)) in beams.enumerate() {
            let (first, far) = (beam * size, far(beam));
            if self.search(rays, far) {
                let far = far.unwrap_or(f32::INFINITY);
                let Beams { level, triangles, alpha_mask, found, left, .. } = self;
                let held = (*triangles, &found[..], *alpha_mask);
                dispatch!(*level, simd => test(simd, rays, held, far, (first, hits), left));
            } else {
                self.left.extend((first..).zip(rays.iter().copied()));
            }
        }
        let rays: Vec<Ray> = self.left.iter().map(|(_, ray)| *ray).collect();
        let mut found = vec![Hit::MISS; rays.len()];
        self.accelerator.closest_hits(&rays, &mut found);
        for ((place, _), hit) in self.left.iter().zip(found) {
            hits[*place] = hit;
        }
    }

    /// Finds the triangles that rays may hit up to `far`; `false` if there are too many, or too little is known.
    fn search(&mut self, rays: &[Ray], far: Option<f32>) -> bool {
        let near = |ray: &Ray| self.ray_clamp.is_near(ray);
        if !matches!(self.accelerator.kind(), AcceleratorKind::Bvh(_)) || !rays.iter().all(near) {
            return false;
        }
        let origins = Bounds::around(rays.iter().map(|ray| ray.origin));
        let (center, radius) = self.ray_clamp.parts();
        let aside = (origins.min - center).abs().max((origins.max - center).abs());
        let reach = aside.max_element() + radius;
        // A triangle is no farther than the sum of these, and twice that leaves room for rounding.
        let far = far.map_or(2.0 * (aside.element_sum() + 3.0 * radius), |far| far * (1.0 + LONGER));
        let ends = Bounds::around(rays.iter().map(|ray| ray.origin + far * ray.direction));
        let grown = |bounds: Bounds| {
            let margin = ROUNDING * reach.max(bounds.farthest());
            Bounds { min: bounds.min - margin, max: bounds.max + margin }
        };
        self.found.clear();
        let found = &mut self.found;
        let mut fits = true;
        self.accelerator.search(&Region::shaft(grown(origins), grown(ends)), &mut |chunk| {
            found.extend_from_slice(chunk);
            fits = found.len() <= MOST;
            fits
        });
        fits
    }
}

/// Tests all triangles found against all rays of a beam.
#[inline(always)]
fn test<S: Simd>(
    simd: S,
    rays: &[Ray],
    (triangles, found, alpha_mask): (&Triangles, &[u32], &AlphaMask),
    far: f32,
    (first, hits): (usize, &mut [Hit]),
    left: &mut Vec<(usize, Ray)>,
) {
    for (group, rays) in rays.chunks(LANES).enumerate() {
        let start = group * LANES;
        let Some(mut closest) = packet(simd, alpha_mask, rays) else {
            left.extend((first + start..).zip(rays.iter().copied()));
            continue;
        };
        let lanes = u32::MAX >> (u32::BITS - rays.len() as u32);
        for &index in found {
            closest.triangle(simd, &triangles.at(index), lanes);
        }
        let closest = closest.hits();
        for (lane, ray) in rays.iter().enumerate() {
            if closest[lane].t <= far {
                hits[start + lane] = closest[lane];
            } else {
                left.push((first + start + lane, *ray));
            }
        }
    }
}

/// Up to eight rays; `None` if their directions do not have their largest components on one axis.
#[inline(always)]
fn packet<'a, S: Simd>(simd: S, alpha_mask: &'a AlphaMask, rays: &[Ray]) -> Option<ClosestPacket<'a, S>> {
    let axis = largest_axis(rays[0].direction);
    let (mut origin, mut direction, mut t_max) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [0.0; LANES]);
    for lane in 0..LANES {
        let ray = rays[lane.min(rays.len() - 1)];
        if largest_axis(ray.direction) != axis {
            return None;
        }
        for k in 0..3 {
            origin[k][lane] = ray.origin[k];
            direction[k][lane] = ray.direction[k];
        }
        t_max[lane] = ray.t_max;
    }
    let axes = |of: &[[f32; LANES]; 3]| {
        [f32x8::from_slice(simd, &of[0]), f32x8::from_slice(simd, &of[1]), f32x8::from_slice(simd, &of[2])]
    };
    let shear = PacketShear::new(&axes(&origin), &axes(&direction), axis);
    Some(ClosestPacket::new(simd, alpha_mask, shear, f32x8::from_slice(simd, &t_max)))
}
