//! What one surface point sees of one light: the emitter as a flat shape on which samples lie in [rows](super::rows). Twin:
//! `projected_light.cuh`.
//!
//! Seen from a point, a ball is the disc through its centre that faces the point, evenly bright; so is a point light with a spread, and a
//! sun of an angular size. An emissive ball is the disc that covers the same directions [before it](crate::sampling::before_body): it hides none of its own light.
//! Disks and rectangles are what they are. A light without a size is a single sample.
//!
//! All vectors are multiplied by a power of two, [`scale`], so that products with triangles, three lengths each, stay in the middle of
//! the range of single precision.

use fearless_simd::f32x8;
use fearless_simd::prelude::*;
use glam::Vec3;
use lightmesh_layout::constants::{ASIDE_OF_BODY, ENLARGEMENT, GAMMA_32, SHADOW_MARGIN, SHIFT_STEPS};
use lightmesh_layout::scene::SampleRows;
use lightmesh_scene::{Bounds, Light, LightKind};
use lightmesh_trace::accel::Region;
use lightmesh_trace::simd::{Axes, difference, dot, scaled, splat};

use super::ShadowTarget;
use super::rows::Rows;
use super::terminator::ShadowPoint;
use crate::data::wave::HostWave;
use crate::prepared::PreparedGeometry;
use crate::sampling::{body, covered_by_body, disk_radius, light_center, random_bits, seen_center};
use crate::surface::SurfacePoint;

/// The form of a light's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// The centre alone.
    Point,
    /// Rows of a disc.
    Disc,
    /// Rows of a rectangle.
    Rectangle,
}

impl Shape {
    /// Of a light that rays are aimed at.
    pub(crate) fn of(target: &ShadowTarget, light: &Light) -> Shape {
        match light.kind {
            _ if !target.is_spread_over(light) => Shape::Point,
            LightKind::Rectangle { .. } => Shape::Rectangle,
            _ => Shape::Disc,
        }
    }

    /// Its sets of samples; none for a point.
    pub(crate) fn sets(self, rows: &Rows) -> &[SampleRows] {
        match self {
            Shape::Point => &[],
            Shape::Disc => &rows.disc,
            Shape::Rectangle => &rows.rectangle,
        }
    }
}

/// A light, and how its samples are arranged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Emitter<'a> {
    index: usize,
    light: &'a Light,
    shape: Shape,
    /// Its samples; none for a point.
    pub(crate) sets: &'a [SampleRows],
    scale: f32,
    /// No sample of a disc is farther from the centre; of a directional light, at distance 1.
    spread: f32,
    samples: u32,
    seed: u64,
}

impl<'a> Emitter<'a> {
    /// The lights of a wave that rays are aimed at.
    pub(crate) fn all(wave: &HostWave<'a>, target: &ShadowTarget, rows: &'a Rows) -> Vec<Emitter<'a>> {
        let geometry = &wave.scene.geometry;
        let emitter = |(index, light): (usize, &'a Light)| {
            let shape = Shape::of(target, light);
            let sets = shape.sets(rows);
            let (samples, seed) = (target.samples(light), wave.context.sampling.seed);
            Emitter { index, light, shape, sets, scale: scale(geometry, light), spread: spread(light), samples, seed }
        };
        let lights = wave.group();
        wave.lights().iter().enumerate().take(lights.end).skip(lights.start).map(emitter).collect()
    }

    /// The light, and the form of its samples.
    pub(crate) fn light(&self) -> (&'a Light, Shape) {
        (self.light, self.shape)
    }

    /// Whether its centre is the only sample.
    pub(crate) fn is_point(&self) -> bool {
        self.shape == Shape::Point
    }

    /// The power of two by which vectors to it are multiplied.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// Whether its samples are those of a disc.
    pub(crate) fn is_disc(&self) -> bool {
        self.shape == Shape::Disc
    }

    /// The surface point from which it is looked for.
    #[inline(always)]
    pub(crate) fn seen_from(&self, geometry: &PreparedGeometry, point: &ShadowPoint) -> SurfacePoint {
        point.toward(self.light, geometry)
    }

    /// As the surface point of ray number `ray` sees it.
    #[inline(always)]
    pub(crate) fn projected(&self, wave: &HostWave, ray: usize, point: &SurfacePoint) -> ProjectedLight {
        let reach = wave.scene.geometry.sun_distance(point.origin);
        let lines = self.sets.first().map_or(1, |set| set.lines);
        let random = (self.seed, wave.rays.key(ray));
        ProjectedLight::new((self.index, self.light), (self.shape, lines), point, random, (reach, self.scale))
    }

    /// Which of eight surface points all of a disc is in front of, and which it is behind: a bit each, none where neither is certain.
    #[inline(always)]
    pub(crate) fn heights<S: Simd>(
        &self,
        simd: S,
        geometry: &PreparedGeometry,
        origin: Axes<S>,
        normal: Axes<S>,
    ) -> (u32, u32) {
        let (way, spread) = match self.light.kind {
            LightKind::Directional { direction, .. } => {
                let (center, far) = geometry.sun_distance_parameters();
                let away = difference(origin, splat(simd, center));
                let reach = (away[0].abs() + away[1].abs() + away[2].abs()) * 2.0 + far;
                (scaled(reach, splat(simd, -direction)), reach * self.spread)
            }
            _ => {
                let center = light_center(self.light, Vec3::ZERO, 0.0);
                (difference(splat(simd, center), origin), f32x8::splat(simd, self.spread))
            }
        };
        let height = dot(normal, way);
        let room = spread * ENLARGEMENT + (way[0].abs() + way[1].abs() + way[2].abs()) * (ENLARGEMENT - 1.0);
        (height.simd_gt(room).to_bitmask() as u32, height.simd_lt(-room).to_bitmask() as u32)
    }

    /// Calls `take` with each sample as the surface point of ray number `ray` sees it.
    #[inline(always)]
    pub(crate) fn each_target(&self, wave: &HostWave, ray: usize, point: &SurfacePoint, mut take: impl FnMut(Vec3)) {
        self.each_target_of_set(wave, ray, point, |_, target| take(target));
    }

    /// The same with the number of the set that each sample belongs to.
    #[inline(always)]
    pub(crate) fn each_target_of_set(
        &self,
        wave: &HostWave,
        ray: usize,
        point: &SurfacePoint,
        mut take: impl FnMut(u32, Vec3),
    ) {
        if self.is_point() {
            take(0, seen_center(self.light, point.origin, wave.scene.geometry.sun_distance(point.origin)));
            return;
        }
        let projected = self.projected(wave, ray, point);
        for (number, set) in (0..).zip(self.sets) {
            for row in 0..set.rows as usize {
                let mut rest = projected.valid(set, row);
                while rest != 0 {
                    take(number, point.origin + projected.sample(set, row, rest.trailing_zeros(), self.scale));
                    rest &= rest - 1;
                }
            }
        }
    }

    /// Where everything is that may hide it from a point of `origins`.
    ///
    /// A triangle that is found to hide a sample comes within about 16 ε of the segment's length of that segment, unless an edge of it
    /// passes by the surface point at a small fraction of that; the margin is two hundred times as large.
    pub(crate) fn region(&self, geometry: &PreparedGeometry, origins: &Bounds) -> Region {
        let emitter = self.bounds(geometry, origins);
        let all = Bounds { min: origins.min.min(emitter.min), max: origins.max.max(emitter.max) };
        let margin = SHADOW_MARGIN * all.extent().max_element();
        let grown = |bounds: &Bounds| Bounds { min: bounds.min - margin, max: bounds.max + margin };
        Region::shaft(grown(origins), grown(&emitter))
    }

    /// A box around its samples as seen from `origins`. A directional light is as far away as from the point where it is farthest.
    pub(crate) fn bounds(&self, geometry: &PreparedGeometry, origins: &Bounds) -> Bounds {
        let (center, far) = geometry.sun_distance_parameters();
        let apart = (origins.min - center).abs().max((origins.max - center).abs());
        let reach = far + 2.0 * apart.element_sum();
        let half = if self.is_point() { Vec3::ZERO } else { half_extent(self.light, reach) };
        let middle = match self.light.kind {
            LightKind::Directional { direction, .. } => {
                let way = reach * direction;
                Bounds { min: origins.min - way, max: origins.max - way }
            }
            _ => {
                let center = light_center(self.light, origins.min, 0.0);
                Bounds { min: center, max: center }
            }
        };
        Bounds { min: middle.min - half, max: middle.max + half }
    }

    /// The radius of an emissive ball that it stands for: what lies in it hides nothing. 0 if there is none.
    pub(crate) fn body(&self) -> f32 {
        body(self.light)
    }

    /// No sample is farther from the middle of the box; infinite if the box says more.
    pub(crate) fn radius(&self) -> f32 {
        match self.light.kind {
            LightKind::Sphere { radius, .. } if body(self.light) > 0.0 => ASIDE_OF_BODY * radius,
            LightKind::Point { spread: radius, .. } | LightKind::Sphere { radius, .. } => radius,
            LightKind::Spot { radius, .. } if radius > 0.0 => radius,
            _ => f32::INFINITY,
        }
    }

    /// Number of its samples.
    pub(crate) fn samples(&self) -> u32 {
        self.samples
    }

    /// The share of `seen` of its samples: exactly 1 for all of them.
    #[inline(always)]
    pub(crate) fn share(&self, seen: u32) -> f32 {
        if seen == self.samples { 1.0 } else { seen as f32 / self.samples as f32 }
    }
}

/// See [`Emitter::spread`].
pub(crate) fn spread(light: &Light) -> f32 {
    match light.kind {
        LightKind::Point { spread, .. } => spread,
        LightKind::Directional { angle, .. } => disk_radius(angle),
        LightKind::Sphere { radius, .. } | LightKind::Disk { radius, .. } | LightKind::Spot { radius, .. } => radius,
        LightKind::Rectangle { .. } => 0.0,
    }
}

/// Half the edges of the box around a light, if a directional one is `reach` away.
fn half_extent(light: &Light, reach: f32) -> Vec3 {
    match light.kind {
        LightKind::Sphere { radius, .. } if body(light) > 0.0 => Vec3::splat(ASIDE_OF_BODY * radius),
        LightKind::Point { spread: radius, .. } | LightKind::Sphere { radius, .. } | LightKind::Spot { radius, .. } => {
            Vec3::splat(radius)
        }
        LightKind::Disk { normal, radius, .. } => radius * shadow_of_disc(normal),
        LightKind::Rectangle { half_u, half_v, .. } => half_u.abs() + half_v.abs(),
        LightKind::Directional { direction, angle } => reach * disk_radius(angle) * shadow_of_disc(direction),
    }
}

/// Half the length of a unit disc's shadow on each axis: the sine of the angle between the axis and the disc's.
fn shadow_of_disc(normal: Vec3) -> Vec3 {
    (Vec3::ONE - normal * normal).max(Vec3::ZERO).map(f32::sqrt)
}

/// A light as one surface point sees it: samples are at `center + x · along + y · across`, seen from the point and scaled.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProjectedLight {
    /// Its centre.
    pub center: Vec3,
    /// From the centre to the place with x = 1: half of its width along the rows.
    pub along: Vec3,
    /// From the centre to the place with y = 1: half of its width across the rows.
    pub across: Vec3,
    /// The scale over the parameter at which segments to the light end: less than 1, to spare what lies at the light.
    pub end: f32,
    /// By how much of their distance samples are shifted along their rows; in [0, 1).
    pub shift: f32,
    /// The part of the last line that lies inside of a rectangle; in (0, 1].
    pub inside: f32,
    /// Selects the samples that are left out where a row has too many.
    pub choice: u32,
}

impl ProjectedLight {
    /// Of light number `index` from `point`; `key` selects the random pattern, `reach` is the distance of a directional light.
    #[inline(always)]
    pub(crate) fn new(
        (index, light): (usize, &Light),
        (shape, lines): (Shape, u32),
        point: &SurfacePoint,
        (seed, key): (u64, u64),
        (reach, scale): (f32, f32),
    ) -> ProjectedLight {
        let target = seen_center(light, point.origin, reach);
        let center = target - point.origin;
        // As for rays: see `long_segment`.
        let length = center.abs().max_element();
        let error = GAMMA_32 * point.origin.abs().max(target.abs()).max_element();
        let spared = if error < 0.5 * length { error / length } else { 0.5 };
        let mut projected = ProjectedLight {
            center: scale * center,
            end: scale / (1.0 - spared),
            inside: 1.0,
            ..ProjectedLight::default()
        };
        if shape == Shape::Point {
            return projected;
        }
        let random = random_bits(seed, key, index);
        projected.shift = (random as u32 & 0xffff) as f32 / SHIFT_STEPS;
        projected.choice = (random >> 16) as u32 & 0xffff;
        let aside = projected.choice as f32 / SHIFT_STEPS;
        if let (Shape::Rectangle, LightKind::Rectangle { half_u, half_v, .. }) = (shape, &light.kind) {
            let (u, v) = longest_first(scale * *half_u, scale * *half_v);
            let step = v / lines as f32;
            projected.inside = 1.0 - aside;
            projected.center += 2.0 * aside * step;
            (projected.along, projected.across) = (u + step, v);
            return projected;
        }
        let (tangent, bitangent, radius) = disc_of(light, center, reach);
        // A quarter turn to either side: rows look the same from both ends.
        let turn = ((random >> 32) as u32 & 0xffff) as f32 / (0.5 * SHIFT_STEPS) - 1.0;
        let square = turn * turn;
        let (cos, sin) = ((1.0 - square) / (1.0 + square), 2.0 * turn / (1.0 + square));
        let radius = scale * radius;
        projected.along = radius * (cos * tangent + sin * bitangent);
        projected.across = radius * (cos * bitangent - sin * tangent);
        if lines == 1 {
            let y = middle_row(2.0 * aside - 1.0);
            projected.center += y * projected.across;
            projected.along *= (1.0 - y * y).max(0.0).sqrt();
        }
        projected
    }

    /// The sample at place `place` of row number `row`, seen from the point and not scaled.
    #[inline(always)]
    pub(crate) fn sample(&self, rows: &SampleRows, row: usize, place: u32, scale: f32) -> Vec3 {
        let x = (place as f32 - self.offset(rows, row)) / rows.density[row];
        (self.center + x * self.along + rows.y[row] * self.across) / scale
    }

    /// The sample at place `place` of row number `row`, in which x = 0 is at `offset`, seen from the point and scaled.
    #[inline(always)]
    pub(crate) fn scaled_sample(&self, rows: &SampleRows, row: usize, place: f32, offset: f32) -> Vec3 {
        self.center + (place - offset) / rows.density[row] * self.along + rows.y[row] * self.across
    }

    /// The place of x = 0 in a row of samples.
    #[inline(always)]
    pub fn offset(&self, rows: &SampleRows, row: usize) -> f32 {
        rows.half[row] - self.shift_of(rows, row)
    }

    #[inline(always)]
    fn shift_of(&self, rows: &SampleRows, row: usize) -> f32 {
        let shift = self.shift + rows.shift[row];
        if shift >= 1.0 { shift - 1.0 } else { shift }
    }

    /// The samples of a word that count.
    #[inline(always)]
    pub(crate) fn valid_word(&self, rows: &SampleRows, word: usize) -> u32 {
        let first = if word == 0 { 0 } else { rows.ends[word - 1] as usize };
        (first..rows.ends[word] as usize).fold(0, |bits, row| bits | self.valid(rows, row) << rows.place[row])
    }

    /// The samples of a row that count, as the lowest bits.
    #[inline(always)]
    pub(crate) fn valid(&self, rows: &SampleRows, row: usize) -> u32 {
        let count = rows.count[row];
        let mut bits = (1u32 << count) - 1;
        // What enters a rectangle, and what leaves it.
        if row as u32 == rows.entering || row as u32 == rows.leaving {
            let inside = (self.inside * count as f32 - self.shift_of(rows, row)).ceil().max(0.0) as u32;
            let before = (1u32 << inside.min(count)) - 1;
            bits &= if row as u32 == rows.leaving { before } else { !before };
        }
        // Some rows, one after the other from any, have a sample less.
        if (rows.line[row] + self.choice) % rows.lines < rows.surplus {
            bits &= !(1 << ((rows.line[row] + self.choice / rows.lines) % count));
        }
        bits
    }
}

/// The longer of two half sides first: rows lie along it.
#[inline(always)]
fn longest_first(u: Vec3, v: Vec3) -> (Vec3, Vec3) {
    if u.length_squared() >= v.length_squared() { (u, v) } else { (v, u) }
}

/// Two perpendicular unit vectors in the plane of a light's disc, and its radius. `center` is the way to the middle of the disc.
#[inline(always)]
pub(crate) fn disc_of(light: &Light, center: Vec3, reach: f32) -> (Vec3, Vec3, f32) {
    match light.kind {
        LightKind::Disk { normal, radius, .. } => {
            let (tangent, bitangent) = normal.any_orthonormal_pair();
            (tangent, bitangent, radius)
        }
        LightKind::Point { spread: radius, .. } | LightKind::Sphere { radius, .. } | LightKind::Spot { radius, .. } => {
            let (tangent, bitangent) = facing(center);
            let body = body(light);
            (tangent, bitangent, if body > 0.0 { covered_by_body(body, center.length()) } else { radius })
        }
        LightKind::Directional { direction, angle } => {
            let (tangent, bitangent) = direction.any_orthonormal_pair();
            (tangent, bitangent, reach * disk_radius(angle))
        }
        LightKind::Rectangle { .. } => (Vec3::X, Vec3::Y, 0.0),
    }
}

/// Two unit vectors perpendicular to `way` and to each other (Duff et al.: *Building an Orthonormal Basis, Revisited*, JCGT 2017).
#[inline(always)]
fn facing(way: Vec3) -> (Vec3, Vec3) {
    let length = way.length();
    let n = if length > 0.0 { way / length } else { Vec3::Z };
    let sign = if n.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// The place of a disc's only row that is as likely to be below `share` of the disc as above, for `share` in [−1, 1]: the quantile of
/// the length of chords, within 0.01.
#[inline(always)]
fn middle_row(share: f32) -> f32 {
    let square = share * share;
    share * (0.79 + square * (0.05 + 0.15 * square * square))
}

/// The power of two by which vectors to `light` are multiplied.
pub(crate) fn scale(geometry: &PreparedGeometry, light: &Light) -> f32 {
    let (center, far) = geometry.sun_distance_parameters();
    let away = light.position().map_or(4.0 * far, |position| (position - center).abs().max_element() + far);
    let exponent = |length: f32| (length.max(f32::MIN_POSITIVE).to_bits() >> 23) as i32 - 127;
    let exponent = (-2 * exponent(far) - exponent(away)).clamp(-120, 120);
    f32::from_bits(((exponent + 127) as u32) << 23)
}
