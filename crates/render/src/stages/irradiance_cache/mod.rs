//! Gathered light: what surfaces receive from their surroundings and from each other, kept in *records* at points of the surfaces. An irradiance
//! cache (Ward, Rubinstein, Clear: *A Ray Tracing Solution for Diffuse Interreflection*, 1988) whose records do not depend on the view.
//!
//! In: rays that hit surfaces, and the records so far. Out: by ray, the mean radiance that the surface point receives, weighted by the cosine.
//!
//! 1. [`coarse`] records gather the light from afar, one in a coarse cell, by hundreds of rays. It changes slowly from place to place, if what is
//!    near is left out.
//! 2. [`fine`] records, a few pixels apart, add what is near, which does not, by few and short rays: what they hit takes the place of what
//!    coarse records have seen. So only the difference is noisy.
//! 3. A surface point takes the weighted mean of the fine records around it ([`lookup`]), or counts as one itself if it sees none.
//!
//! What rays hit is lit by the lights, by a shadow ray each, and by what was reflected before ([`bounce`]). All of this belongs to cells of
//! space ([`cells`]) and depends on nothing but the cell, the scene and the seed: not on what else was asked for, nor on the camera. So it can
//! be kept from image to image, and dropped at any time, and changes no bit.

mod bounce;
mod cells;
mod coarse;
pub(crate) mod cpu;
pub(crate) mod cuda;
pub(crate) mod directions;
mod fine;
pub(crate) mod guide;
mod hemisphere_rays;
pub(crate) mod identity;
mod light;
mod lookup;
mod rays;
pub(crate) mod saved;
mod scene;
mod sources;

use glam::Vec3;
use lightmesh_layout::constants::BLEND_FROM;
use lightmesh_scene::Bounds;

use crate::settings::Quality;
use crate::steps::Sharing;
use crate::view::View;
use cells::level_of;
use hemisphere_rays::{HemisphereRays, RecordRays};
pub(crate) use sources::Sources;

/// Surface points that are processed at once.
const POINTS_AT_ONCE: usize = 1 << 16;
/// Rays that are cast at once: the more the better for many processors, unless memory is scarce.
const RAYS_AT_ONCE: [usize; 3] = [1 << 18, 1 << 16, 1 << 14];
/// Records of an image are computed in steps, the first of which has one of so many, and each at most one of so many:
const FIRST_STEP: usize = 256;
const STEPS: usize = 32;
/// unless that casts fewer rays than this. What they hit asks for many more.
const RAYS_AT_A_STEP: usize = 1 << 12;
/// What these take, at most, with all that is known of them: three times, for what they hit asks again.
const BYTES_OF_RAY: u64 = 3 * 256;
/// What a point takes.
const BYTES_OF_POINT: u64 = 512;
/// What is kept may take one part in this many of the memory that is left.
const PART_KEPT: u64 = 4;
/// Rays may take one part in this many.
const PART_FOR_RAYS: u64 = 8;
/// Cells are no smaller than this share of the largest coordinate, whose digits would not suffice.
const MIN_SIZE: f32 = 1.0 / (1 << 20) as f32;
/// Without fine records, surface points count as such of cells with this share of it.
const BRUTE_FORCE_SIZE: f32 = 1.0 / (1 << 10) as f32;

/// How an image gathers light.
#[derive(Clone, Copy, Debug)]
pub struct Gathering {
    eye: Vec3,
    /// The size of a pixel: a constant, and a multiple of its distance.
    spacing: [f32; 2],
    /// The largest size of fine cells, in pixels.
    pixels: f32,
    least_level: i32,
    rays: RecordRays,
    /// Whether each surface point gathers for itself.
    brute_force: bool,
    rays_at_once: usize,
    points_at_once: usize,
    /// What is kept is dropped when it takes more bytes than this.
    most_kept: Option<u64>,
}

impl Gathering {
    /// For an image of what lies within `bounds`, if `left` bytes are left for all of it.
    pub(crate) fn new(view: &View, bounds: &Bounds, quality: Quality, left: Option<u64>) -> Gathering {
        let (pixels, coarse, fine) = match quality {
            Quality::Draft => (8.0, [8, 12], 4),
            Quality::Good => (6.0, [12, 20], 6),
            Quality::Final => (4.0, [24, 42], 8),
        };
        let rays = RecordRays { coarse: coarse.map(HemisphereRays::new), fine: HemisphereRays::new(fine) };
        let least_level = level_of(MIN_SIZE * bounds.farthest()).0;
        let fits = |rays: &usize| left.is_none_or(|left| BYTES_OF_RAY * *rays as u64 <= left / PART_FOR_RAYS);
        let [.., fewest] = RAYS_AT_ONCE;
        let [width, height] = view.size();
        Gathering {
            eye: view.origin(),
            spacing: view.spacing(),
            pixels,
            least_level,
            rays,
            brute_force: false,
            rays_at_once: RAYS_AT_ONCE.into_iter().find(fits).unwrap_or(fewest),
            points_at_once: POINTS_AT_ONCE.min((u64::from(width) * u64::from(height)) as usize),
            most_kept: left.map(|left| left / PART_KEPT),
        }
    }

    /// The same without records: each surface point casts rays of its own. Nothing depends on the camera.
    pub(crate) fn brute_force(view: &View, bounds: &Bounds, quality: Quality, left: Option<u64>) -> Gathering {
        let coarse = match quality {
            Quality::Draft => [16, 28],
            Quality::Good => [32, 56],
            Quality::Final => [64, 112],
        };
        let how = Gathering::new(view, bounds, quality, left);
        let rays = RecordRays { coarse: coarse.map(HemisphereRays::new), ..how.rays };
        // No pixels make a cell: all are of the least level.
        let least_level = how.least_level.max(level_of(BRUTE_FORCE_SIZE * bounds.farthest()).0);
        Gathering { pixels: 0.0, least_level, rays, brute_force: true, ..how }
    }

    /// What `points` surface points count as in the time that gathering takes, if the first ones of pixels count as one each. What was gathered for
    /// these serves others; the factor is measured in seven scenes, in which it was .2 to .9.
    pub(crate) fn pieces(&self, points: f64, new: bool) -> f64 {
        if new || self.brute_force { points } else { 0.45 * points }
    }

    /// How much surface points share, the first of all or not, in parts that are samples of all or not.
    fn sharing(&self, first: bool, sampled: bool) -> Sharing {
        if self.brute_force { Sharing::NONE } else { Sharing::of_parts(first, sampled) }
    }

    /// Bytes that it needs on the host, besides the image.
    pub(crate) fn memory(&self) -> u64 {
        let at_once = BYTES_OF_RAY * self.rays_at_once as u64 + BYTES_OF_POINT * self.points_at_once as u64;
        at_once + self.most_kept.unwrap_or(0)
    }

    /// The levels of the fine cells at a position, with their shares.
    fn levels(&self, position: Vec3) -> [(i32, f32); 2] {
        let [constant, factor] = self.spacing;
        let (level, rest) = level_of(self.pixels * (constant + factor * (position - self.eye).length()));
        let next = ((rest - BLEND_FROM) / (2.0 - BLEND_FROM)).max(0.0);
        [(level, 1.0 - next), (level + 1, next)].map(|(level, share)| (level.max(self.least_level), share))
    }
}
