//! Lights that rays see: those with an area that neither a surface of the scene nor its surroundings show. Twin: `seen_lights.cuh`.
//!
//! Rays that go on at surfaces see them as surfaces: in mirrors, and through glass; the camera's see those that are
//! [visible](lightmesh_scene::Light::visible). They hide what is behind them from these rays, and nothing else. Their radiance is what gives the light's
//! strength, where A is their area, θ the angle to their normal, t the way to them, and r the sine of half of a sun's angle:
//!
//! ```text
//!                                falloff inverse-square     none
//! one side shines                L = I / A                  L = π t² I / A
//! both sides shine evenly        L = I / (A cos θ)          L = π t² I / (A cos θ)
//! ball, with a spot's cone       L = I / (π r²)             L = t² I / r²              t: to the centre
//! sun                            L = I / (π r²)             L = I / r²
//! ```
//!
//! 1. Where a ray meets a light, if no surface is nearer.
//! 2. How much of its cone does: a rectangle takes from it what overlaps, a disc and a ball have an edge as wide as the cone, and as much light.
//! 3. From the nearest on, each hides its share of what is behind it. Rays from rough mirrors show a share of its radiance alone.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;
use lightmesh_layout::constants::{MIN_SEEN_COSINE, MIN_SHINING_COSINE, SAME_DISTANCE};
use lightmesh_layout::scene;
use lightmesh_scene::{Falloff, Light, LightKind, Lights};
use rayon::prelude::*;

use super::{cone, seen_as};
use crate::data::clip::Limits;
use crate::data::wave::HostWave;
use crate::footprint::Cone;
use crate::sampling::disk_radius;
use crate::shadow::size;

/// The lights of a scene that rays see, with their numbers.
pub(crate) struct SeenLights<'a>(Vec<(u32, &'a Light, bool)>);

/// A ray and how wide it is.
struct Beam {
    origin: Vec3,
    direction: Vec3,
    cone: Cone,
    /// What the width of the cone is multiplied with.
    times: f32,
    /// Where it hits a surface.
    end: f32,
    /// The part of it on which lights are seen.
    limits: Limits,
}

/// What a ray sees of a light.
struct Seen {
    distance: f32,
    /// How much of the ray's cone sees it.
    share: f32,
    radiance: Vec3,
}

/// What is in front of the surface that a ray hits, or of everything behind the scene.
pub(crate) struct InFront {
    /// How much of that is seen.
    pub(crate) left: f32,
    /// What is seen of lights.
    pub(crate) radiance: Vec3,
}

impl<'a> SeenLights<'a> {
    /// Those among the lights of a scene.
    pub(crate) fn new(lights: &'a Lights) -> SeenLights<'a> {
        let seen = |(index, light): (usize, &'a Light)| {
            let flags = seen_as(lights, light);
            let is_surface = flags & scene::Light::SURFACE != 0;
            is_surface.then_some((index as u32, light, flags & scene::Light::CAMERA != 0))
        };
        SeenLights(lights.iter().enumerate().filter_map(seen).collect())
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What is in front of what a ray sees. `times` widens the ray.
    #[inline(always)]
    pub(crate) fn in_front(&self, wave: &HostWave, ray: usize, times: f32) -> InFront {
        let mut radiance = Vec3::ZERO;
        let left = self.each(wave, ray, times, |_, seen| radiance += seen);
        InFront { left, radiance }
    }

    /// Adds what is in front to what each ray sees. Returns how much is left of that by ray, nothing without lights.
    pub(crate) fn put_in_front(&self, wave: &HostWave, sums: &mut [Vec3]) -> Vec<f32> {
        if self.is_empty() {
            return Vec::new();
        }
        let put = |(ray, sum): (usize, &mut Vec3)| {
            let InFront { left, radiance } = self.in_front(wave, ray, 1.0);
            if left < 1.0 {
                *sum = left * *sum + radiance;
            }
            left
        };
        sums.par_iter_mut().enumerate().map(put).collect()
    }

    /// Calls `take` with each light in front of what a ray sees, and what it shows of it, from the nearest on. Returns how much is left of what
    /// is behind.
    #[inline(always)]
    pub(crate) fn each(&self, wave: &HostWave, ray: usize, times: f32, take: impl FnMut(u32, Vec3)) -> f32 {
        if self.is_empty() { 1.0 } else { self.each_of(wave, ray, times, take) }
    }

    #[inline(never)]
    fn each_of(&self, wave: &HostWave, ray: usize, times: f32, mut take: impl FnMut(u32, Vec3)) -> f32 {
        let (list, hit) = (wave.rays, &wave.hits[ray]);
        let (along, from_camera) = (&list.rays[ray], list.depth == 0);
        let beam = Beam {
            origin: along.origin,
            direction: along.direction,
            cone: list.cone_of(ray),
            times: times * list.samples_of(ray).sqrt(),
            end: if hit.is_some() { hit.t } else { f32::INFINITY },
            limits: list.limits(ray),
        };
        let shown = list.lights_share(ray);
        // 3. From the nearest on.
        let (mut left, mut last) = (1.0, (-1.0, 0));
        while left > 0.0 {
            let mut nearest: Option<(u32, Seen)> = None;
            for &(index, light, visible) in &self.0 {
                if from_camera && !visible {
                    continue;
                }
                let Some(seen) = beam.sees(light) else { continue };
                let is_left = seen.distance > last.0 || seen.distance == last.0 && index > last.1;
                if is_left && nearest.as_ref().is_none_or(|(_, nearest)| seen.distance < nearest.distance) {
                    nearest = Some((index, seen));
                }
            }
            let Some((index, seen)) = nearest else { break };
            take(index, (left * seen.share * shown) * seen.radiance);
            left *= 1.0 - seen.share;
            last = (seen.distance, index);
        }
        left
    }
}

impl Beam {
    /// What is seen of a light, if anything is.
    fn sees(&self, light: &Light) -> Option<Seen> {
        let seen = match light.kind {
            LightKind::Directional { direction, angle } => self.sees_sun(light, direction, disk_radius(angle)),
            LightKind::Sphere { position, radius } | LightKind::Spot { position, radius, .. } => {
                self.sees_ball(light, position, radius)
            }
            LightKind::Disk { position, normal, radius } => self.sees_disc(light, position, normal, radius),
            LightKind::Rectangle { position, half_u, half_v } => self.sees_rectangle(light, position, half_u, half_v),
            LightKind::Point { .. } => None,
        };
        seen.filter(|seen| seen.share > 0.0)
    }

    /// How wide the ray is after a distance.
    #[inline(always)]
    fn width(&self, distance: f32) -> f32 {
        (self.cone.width + self.cone.spread * distance).abs() * self.times
    }

    /// Whether a light at this distance is seen.
    #[inline(always)]
    fn is_met_at(&self, distance: f32) -> bool {
        distance > self.limits.start && distance <= self.end * SAME_DISTANCE && distance <= self.limits.end
    }

    /// Where the ray meets a plane, from the light's centre, and at which distance, if that is before a surface; and the cosine between them.
    #[inline(always)]
    fn meets(&self, light: &Light, center: Vec3, normal: Vec3) -> Option<(Vec3, f32, f32)> {
        // 1. Along the plane that is anywhere, but the light is not.
        let (way, toward) = (center - self.origin, normal.dot(self.direction));
        let on_plane = normal.dot(way) / toward;
        let distance = on_plane.min(way.dot(self.direction) + size(light, 1.0));
        let is_met = on_plane > 0.0 && on_plane < f32::INFINITY && self.is_met_at(distance);
        let shines = light.surface.is_none_or(|front| front.dot(self.direction) < 0.0);
        (is_met && shines).then_some((on_plane * self.direction - way, distance, toward.abs()))
    }

    #[inline(always)]
    fn sees_rectangle(&self, light: &Light, center: Vec3, half_u: Vec3, half_v: Vec3) -> Option<Seen> {
        let across = half_u.cross(half_v);
        let quarter = across.length();
        let (place, distance, cosine) = self.meets(light, center, across / quarter)?;
        // 2.
        let (width, least) = (self.width(distance), cosine.max(MIN_SEEN_COSINE));
        let within = |half: Vec3| {
            let square = half.dot(half);
            let length = square.sqrt();
            let slope = self.direction.dot(half) / length / least;
            overlap(place.dot(half) / square, 0.5 * width * (1.0 + slope * slope).sqrt() / length)
        };
        let share = within(half_u) * within(half_v);
        Some(Seen { distance, share, radiance: shining(light, distance, cosine, 4.0 * quarter) })
    }

    #[inline(always)]
    fn sees_disc(&self, light: &Light, center: Vec3, normal: Vec3, radius: f32) -> Option<Seen> {
        let (place, distance, cosine) = self.meets(light, center, light.surface.unwrap_or(normal))?;
        // 2.
        let aside = place.length();
        let slope = if aside > 0.0 { self.direction.dot(place) / aside / cosine.max(MIN_SEEN_COSINE) } else { 0.0 };
        let share = within_circle(radius, aside, self.width(distance) * (1.0 + slope * slope).sqrt());
        Some(Seen { distance, share, radiance: shining(light, distance, cosine, PI * (radius * radius)) })
    }

    #[inline(always)]
    fn sees_ball(&self, light: &Light, center: Vec3, radius: f32) -> Option<Seen> {
        // 1. Not from inside.
        let (way, square) = (center - self.origin, radius * radius);
        let (along, all) = (way.dot(self.direction), way.dot(way));
        let aside = (way - along * self.direction).length();
        let before = if aside < radius { (square - aside * aside).sqrt() } else { 0.0 };
        let distance = along - before;
        if !(all > square && self.is_met_at(distance)) {
            return None;
        }
        // 2.
        let share = within_circle(radius, aside, self.width(along));
        let strength = cone(light, self.direction);
        if strength <= 0.0 {
            return None;
        }
        let per = if light.falloff == Falloff::InverseSquare { FRAC_1_PI } else { all };
        Some(Seen { distance, share, radiance: (strength * (per / square)) * light.intensity })
    }

    #[inline(always)]
    fn sees_sun(&self, light: &Light, direction: Vec3, radius: f32) -> Option<Seen> {
        // 1. Behind everything.
        let cosine = -direction.dot(self.direction);
        if !(self.end == f32::INFINITY && cosine > 0.0) {
            return None;
        }
        // 2.
        let aside = (self.direction / cosine + direction).length();
        let share = within_circle(radius, aside, self.cone.spread.abs() * self.times);
        let square = radius * radius;
        let per = if light.falloff == Falloff::InverseSquare { FRAC_1_PI } else { 1.0 };
        let radiance = (per * (1.0 + square) / square) * light.intensity;
        Some(Seen { distance: f32::INFINITY, share, radiance })
    }
}

/// The radiance of a flat light.
#[inline(always)]
fn shining(light: &Light, distance: f32, cosine: f32, area: f32) -> Vec3 {
    let per = if light.falloff == Falloff::InverseSquare { 1.0 } else { PI * (distance * distance) };
    let seen = if light.surface.is_some() { area } else { area * cosine.max(MIN_SHINING_COSINE) };
    (per / seen) * light.intensity
}

/// The share of what is within `half` of a place that lies between −1 and 1.
#[inline(always)]
fn overlap(place: f32, half: f32) -> f32 {
    let place = place.abs();
    if place + half <= 1.0 {
        return 1.0;
    }
    if place - half >= 1.0 {
        return 0.0;
    }
    // Of no width, it lies at the edge.
    let inside = (place + half).min(1.0) - (place - half).max(-1.0);
    if half > 0.0 { (inside / (2.0 * half)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The share of a circle `aside` from its centre, if its edge is `width` wide: one that falls off evenly where there would be the same light within a
/// sharp edge, and a fainter cone where that is wider than the circle.
#[inline(always)]
fn within_circle(radius: f32, aside: f32, width: f32) -> f32 {
    let (square, wide) = (radius * radius, width * width);
    if wide <= 3.0 * square {
        let edge = (square - wide * (1.0 / 12.0)).sqrt();
        let inside = edge - aside;
        if width > 0.0 {
            return (inside / width + 0.5).clamp(0.0, 1.0);
        }
        return if inside >= 0.0 { 1.0 } else { 0.0 };
    }
    (3.0 * square / wide) * (1.0 - aside / width).clamp(0.0, 1.0)
}
