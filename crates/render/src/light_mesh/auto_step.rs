//! `--step auto`: a light-mesh step that follows the size of a pixel in the scene.
//!
//! There are two bounds. A cell should be about four pixels wide, so that interpolation smooths no more than an image can show.
//! And light points must pay: there should be fewer than a quarter as many as pixels, or the method casts more long rays than
//! plain ray tracing.

use glam::Vec3;
use lightmesh_trace::accel::{Hit, Ray};
use rayon::prelude::*;

use super::lattice::Lattice;
use crate::data::clip::Limits;
use crate::prepared::PreparedScene;
use crate::stages::primary_rays::cpu::closest_hits_within;
use crate::surface::SurfacePoint;
use crate::view::View;

/// Cell width in pixels.
const PIXELS_PER_STEP: f32 = 4.0;
/// Most light points per pixel.
const POINTS_PER_PIXEL: f64 = 0.25;
/// Factor by which a step grows if it leaves too many light points.
pub const GROWTH: f32 = 1.05;
/// Number of sampled pixels along the longer side of an image.
const PROBES: u32 = 128;

/// A sampled pixel.
pub struct Probe {
    /// Distance to the next pixel's surface point, scene units.
    pub spacing: f32,
    /// Area of surface that the pixel covers, square scene units.
    pub area: f64,
}

/// The step for an image of `scene` in `view` with interpolation radius `radius` (in steps). It depends on the image alone,
/// not on how it is tiled.
pub(crate) fn auto_step(scene: &PreparedScene, view: &View, radius: f32) -> f32 {
    // The least step that keeps the lattice's numbers and rounding in bounds.
    let finest = Lattice::finest(scene, radius);
    let least = (scene.geometry.bounds.diagonal() * 1e-5).max(finest).max(f32::MIN_POSITIVE.sqrt());
    let mut probes = probe(scene, view);
    if probes.is_empty() {
        // Nothing is seen: any step does, and this one is small against the scene.
        return if scene.geometry.bounds.is_empty() {
            1.0
        } else {
            rounded((scene.geometry.bounds.diagonal() / 256.0).max(least))
        };
    }
    let middle = probes.len() / 2;
    let (_, median, _) = probes.select_nth_unstable_by(middle, |a, b| a.spacing.total_cmp(&b.spacing));
    let least = (PIXELS_PER_STEP * median.spacing).max(least);
    rounded(raised(least, |step| points_per_pixel(&probes, f64::from(step), f64::from(radius)) >= POINTS_PER_PIXEL))
}

/// The first of `step`, 1.05·`step`, 1.05²·`step`, … that is not too fine. All before it are, so it is found by halving.
pub fn raised(step: f32, is_too_fine: impl Fn(f32) -> bool) -> f32 {
    let mut steps = vec![step];
    while is_too_fine(steps[steps.len() - 1]) {
        let more = steps.len();
        for _ in 0..more {
            steps.push(steps[steps.len() - 1] * GROWTH);
        }
    }
    // The last one is not too fine.
    steps[steps.partition_point(|&step| is_too_fine(step))]
}

/// Light points to expect per pixel that sees something.
///
/// Over a surface of area A stands a layer of light points r high: A·r/h³ of them. A pixel whose surface is larger than its
/// half-ball has the half-ball to itself: 2πR³/3.
pub fn points_per_pixel(probes: &[Probe], step: f64, radius: f64) -> f64 {
    let half_ball = 2.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let expected = |probe: &Probe| (probe.area / (step * step) * radius).min(half_ball);
    probes.iter().map(expected).sum::<f64>() / probes.len() as f64
}

/// Looks at every so many pixels and the right (or lower) neighbour of each.
fn probe(scene: &PreparedScene, view: &View) -> Vec<Probe> {
    let [width, height] = view.size();
    let stride = width.max(height).div_ceil(PROBES).max(1);
    let neighbour = if width > 1 { 1 } else { width };
    let (columns, rows) = if width > 1 { (width - 1, height) } else { (width, height.max(2) - 1) };
    let rows: Vec<u32> = (stride / 2..rows).step_by(stride as usize).collect();
    rows.par_iter()
        .flat_map_iter(|row| {
            let pixels = (stride / 2..columns).step_by(stride as usize).map(|column| row * width + column);
            let rays: Vec<Ray> = pixels.flat_map(|pixel| [view.ray(pixel), view.ray(pixel + neighbour)]).collect();
            let mut hits = vec![Hit::MISS; rays.len()];
            let limits: Vec<Limits> = rays.iter().map(|ray| view.clip().limits(ray)).collect();
            closest_hits_within(&*scene.geometry.accelerator, &rays, &limits, &mut hits);
            let pairs = rays.chunks_exact(2).zip(hits.chunks_exact(2));
            pairs.filter_map(|(rays, hits)| look(scene, rays, hits)).collect::<Vec<Probe>>()
        })
        .collect()
}

fn look(scene: &PreparedScene, rays: &[Ray], hits: &[Hit]) -> Option<Probe> {
    if !hits.iter().all(Hit::is_some) {
        return None;
    }
    let point = |i: usize| SurfacePoint::new(&rays[i], &hits[i], &scene.geometry.triangles.at(hits[i].triangle));
    let (here, there) = (point(0), point(1));
    let spacing = (there.position - here.position).length();
    // Neighbouring rays, followed to this pixel's distance, are one pixel apart.
    let at = |ray: &Ray| -> Vec3 { ray.origin + hits[0].t * ray.direction };
    let pixel = f64::from((at(&rays[1]) - at(&rays[0])).length());
    let slant = f64::from(here.normal.dot(rays[0].direction).abs().max(1e-3));
    let probe = Probe { spacing, area: pixel * pixel / slant };
    (probe.spacing.is_finite() && probe.area.is_finite()).then_some(probe)
}

/// Two significant digits, rounded up: a number that a person can type again.
pub fn rounded(step: f32) -> f32 {
    let unit = 10f64.powi(f64::from(step).log10().floor() as i32 - 1);
    // A step that has two digits already keeps them in spite of rounding.
    ((f64::from(step) / unit * (1.0 - 1e-6)).ceil() * unit) as f32
}
