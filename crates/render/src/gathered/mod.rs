//! Gathered light: what surfaces receive from their surroundings and from each other, carried by points of the surfaces.
//!
//! 1. **Far** light ([`far`]) is gathered once in a coarse cell, by hundreds of rays. It changes slowly from place to place, if what is near
//!    is left out.
//! 2. **Near** light, which does not, is found at [`fine`] sites, a few pixels apart, by few and short rays: what they hit takes the place of
//!    the far light that they would have seen. So only the difference is noisy.
//! 3. A surface point takes the weighted mean of the fine sites around it ([`lookup`]), or counts as one itself if it sees none.
//!
//! What rays hit is lit by the lights, by a shadow ray each, and by what was reflected before ([`bounce`]). All of this belongs to cells of
//! space ([`cells`]) and depends on nothing but the cell, the scene and the seed: not on what else was asked for, nor on the camera. So it can
//! be kept from image to image, and dropped at any time, and changes no bit.

mod bounce;
mod cells;
pub(crate) mod cuda;
pub(crate) mod directions;
mod fan;
mod far;
mod fine;
pub(crate) mod guide;
pub(crate) mod identity;
mod light;
mod lookup;
mod rays;
pub(crate) mod saved;
mod scene;
mod sources;

use glam::Vec3;
use lightmesh_layout::constants::{BLEND_FROM, COARSER};
use lightmesh_scene::Bounds;
use rayon::prelude::*;

use crate::data::wave::HostWave;
use crate::settings::Quality;
use crate::shading::normal_seen;
use crate::surface::SurfacePoint;
use crate::view::View;
use bounce::Bounce;
use cells::{Cells, Site, level_of};
use fan::{Fan, Fans};
use far::Far;
use fine::Coarse;
use light::Light;
use lookup::{Links, Place};
use scene::Scene;
pub(crate) use sources::Sources;

/// Surface points that are processed at once.
const POINTS_AT_ONCE: usize = 1 << 16;
/// Rays that are cast at once: the more the better for many processors, unless memory is scarce.
const RAYS_AT_ONCE: [usize; 2] = [1 << 18, 1 << 16];
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
/// Without fine sites, surface points count as such of cells with this share of it.
const SIZE_ALONE: f32 = 1.0 / (1 << 10) as f32;

/// How an image gathers light.
#[derive(Clone, Copy, Debug)]
pub struct Gathering {
    eye: Vec3,
    /// The size of a pixel: a constant, and a multiple of its distance.
    spacing: [f32; 2],
    /// The largest size of fine cells, in pixels.
    pixels: f32,
    least_level: i32,
    fans: Fans,
    /// Whether each surface point gathers for itself.
    alone: bool,
    rays_at_once: usize,
    /// What is kept is dropped when it takes more bytes than this.
    most_kept: Option<u64>,
}

impl Gathering {
    /// For an image of what lies within `bounds`, if `left` bytes are left for all of it.
    pub(crate) fn new(view: &View, bounds: &Bounds, quality: Quality, left: Option<u64>) -> Gathering {
        let (pixels, far, near) = match quality {
            Quality::Draft => (8.0, [8, 12], 4),
            Quality::Good => (6.0, [12, 20], 6),
            Quality::Final => (4.0, [24, 42], 8),
        };
        let fans = Fans { far: far.map(Fan::new), near: Fan::new(near) };
        let least_level = level_of(MIN_SIZE * bounds.farthest()).0;
        let [many, few] = RAYS_AT_ONCE;
        let is_scarce = left.is_some_and(|left| BYTES_OF_RAY * many as u64 > left / PART_FOR_RAYS);
        Gathering {
            eye: view.origin(),
            spacing: view.spacing(),
            pixels,
            least_level,
            fans,
            alone: false,
            rays_at_once: if is_scarce { few } else { many },
            most_kept: left.map(|left| left / PART_KEPT),
        }
    }

    /// The same without sites: each surface point casts rays of its own. Nothing depends on the camera.
    pub(crate) fn alone(view: &View, bounds: &Bounds, quality: Quality, left: Option<u64>) -> Gathering {
        let far = match quality {
            Quality::Draft => [16, 28],
            Quality::Good => [32, 56],
            Quality::Final => [64, 112],
        };
        let how = Gathering::new(view, bounds, quality, left);
        let fans = Fans { far: far.map(Fan::new), ..how.fans };
        // No pixels make a cell: all are of the least level.
        let least_level = how.least_level.max(level_of(SIZE_ALONE * bounds.farthest()).0);
        Gathering { pixels: 0.0, least_level, fans, alone: true, ..how }
    }

    /// Bytes that it needs on the host, besides the image.
    pub(crate) fn memory(&self) -> u64 {
        let at_once = BYTES_OF_RAY * self.rays_at_once as u64 + BYTES_OF_POINT * POINTS_AT_ONCE as u64;
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

/// What was gathered for a scene.
#[derive(Default)]
pub struct SurfaceLight {
    fine_cells: Cells,
    fine: Vec<Option<Light>>,
    far_cells: Cells,
    far: Vec<Option<Box<Far>>>,
    bounce: Bounce,
}

impl SurfaceLight {
    /// Bytes in memory.
    pub(crate) fn memory(&self) -> u64 {
        let sites = self.fine.capacity() * size_of::<Option<Light>>();
        let far = self.far.iter().flatten().count() * size_of::<Far>() + self.far.capacity() * size_of::<usize>();
        (self.fine_cells.memory() + sites + self.far_cells.memory() + far + self.bounce.memory()) as u64
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

/// The mean radiance that each surface point of a wave receives, weighted by the cosine; zero for rays that see nothing.
pub(crate) fn gather(wave: &HostWave, how: &Gathering, kept: &mut SurfaceLight) -> Vec<Vec3> {
    let mut light = vec![Vec3::ZERO; wave.hits.len()];
    let scene = Scene { context: wave.context, scene: wave.scene, rays_at_once: how.rays_at_once };
    for (part, light) in light.chunks_mut(POINTS_AT_ONCE).enumerate() {
        if how.most_kept.is_some_and(|most| kept.memory() > most) {
            *kept = SurfaceLight::default();
        }
        gather_part(wave, &scene, how, kept, part * POINTS_AT_ONCE, light);
        wave.context.advance(light.len() as u64);
    }
    light
}

fn gather_part(
    wave: &HostWave,
    scene: &Scene,
    how: &Gathering,
    kept: &mut SurfaceLight,
    first: usize,
    light: &mut [Vec3],
) {
    // 1. Where light is asked for: at one level, or between two.
    let asks = |index: usize| {
        let point = wave.surface_point(first + index);
        let levels = how.levels(point.position).into_iter().filter(|(_, share)| *share > 0.0);
        levels.map(move |(level, share)| Ask { index, point, level, share })
    };
    let seen = (0..light.len()).into_par_iter().filter(|index| wave.sees(first + index));
    let asks: Vec<Ask> = seen.flat_map_iter(asks).collect();
    let normal = |ask: &Ask| normal_seen(wave, first + ask.index);

    // 2. to 3. The mean of fine sites. Where there is none, the point counts as one itself.
    let means = if how.alone { vec![None; asks.len()] } else { means(scene, how, kept, &asks, normal) };
    let alone: Vec<&Ask> = asks.iter().zip(&means).filter(|(_, mean)| mean.is_none()).map(|(ask, _)| ask).collect();
    let sites: Vec<Site> = alone.iter().map(|ask| site_of(ask, how.alone)).collect();
    let SurfaceLight { far_cells, far, bounce, .. } = kept;
    let own = if how.alone {
        far::plain(scene, bounce, &sites, how.fans.far)
    } else {
        fine::plain(scene, &mut Coarse { cells: far_cells, known: far, bounce }, &sites, &how.fans)
    };
    let own = alone.iter().zip(own).map(|(ask, own): (&&Ask, Light)| (*ask, own.at(normal(ask) - ask.point.normal)));
    let means = asks.iter().zip(means).filter_map(|(ask, mean)| Some((ask, mean?)));
    for (ask, mean) in means.chain(own) {
        light[ask.index] += ask.share * mean.max(Vec3::ZERO);
    }
}

/// The mean of what the fine sites around receive; `None` where no site is seen.
fn means(
    scene: &Scene,
    how: &Gathering,
    kept: &mut SurfaceLight,
    asks: &[Ask],
    normal: impl Fn(&Ask) -> Vec3 + Sync,
) -> Vec<Option<Vec3>> {
    // 2. The fine sites around that are seen, and what they receive.
    let places: Vec<Place> = asks.iter().map(|ask| Place::new(&ask.point, ask.level)).collect();
    let SurfaceLight { fine_cells, fine, far_cells, far, bounce } = kept;
    let mut links = Links::new(scene, fine_cells, &places);
    let mut coarse = Coarse { cells: far_cells, known: far, bounce };
    fine::ensure(scene, fine_cells, fine, &mut coarse, &links.sites(), &how.fans);
    let known = |site: u32| fine[site as usize].as_ref().expect("it was ensured");
    links.settle(scene, fine_cells, &places);

    // 3. The mean.
    let mean = |(number, ask): (usize, &Ask)| {
        let (normal, mut sum, mut weights) = (normal(ask), Vec3::ZERO, 0.0);
        for (site, weight) in links.of(number) {
            let turned = normal - fine_cells.sites[site as usize].point.normal;
            sum += weight * known(site).at(turned);
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    };
    asks.par_iter().enumerate().map(mean).collect()
}

/// A surface point as a site. All have the same pattern, or each its own.
fn site_of(ask: &Ask, same: bool) -> Site {
    let [x, y, z] = ask.point.position.to_array().map(|axis| u64::from(axis.to_bits()));
    Site { point: ask.point, level: ask.level + COARSER, seed: if same { 0 } else { x ^ y << 21 ^ z << 42 } }
}
