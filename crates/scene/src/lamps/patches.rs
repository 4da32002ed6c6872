//! Triangles of a lamp that face a similar way are a patch: an emitter in one plane. Those that lie behind each other, and are not connected by
//! others of the patch, are patches of their own: the inner sides of a trough shine into it, the outer ones away from it.
//!
//! Which way a patch shines: all sides of a closed lamp shine outwards, an open one shines to both sides, and so does one without anything else, in
//! front of which nothing is: the walls of a room. If a material is
//! [one-sided](crate::Material::one_sided), as in glTF, the order of corners decides instead.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::connected::{Lamp, Triangle, firsts, is_lit};
use super::glow::Glow;
use super::pieces::Piece;
use super::{Extent, pieces};
use crate::{Falloff, Geometry, Light, LightKind};

/// Patches of a lamp, at most.
const PATCHES: usize = 14;
/// Patches that give less than this share of the largest one's light are left out: the others shine for them.
const SMALL: f64 = 0.05;
/// Edges of a patch along which a rectangle is tried.
const EDGES: usize = 64;
/// How much of its rectangle a patch fills that is one.
const FILLED: f64 = 0.98;
/// The share of its square that a disc fills, and how much that may differ, also between its widths.
const DISC: (f64, f64) = (std::f64::consts::FRAC_PI_4, 0.06);
/// How far lights lie in front of their surface, relative to its size and to the scene's.
pub(super) const RAISED: [f64; 2] = [1e-5, 1e-5];
/// Parts of a patch whose heights differ less, as a share of the lamp's size, are at one height.
const LEVEL: f64 = 1e-3;
/// What lies less in front of a lamp than this share of the scene's diagonal is beside it, as the ceiling is in which a lamp is set.
const BESIDE: f64 = 1e-4;

/// Triangles that face a similar way.
#[derive(Clone)]
pub(super) struct Patch<'l> {
    pub(super) triangles: Vec<&'l Triangle>,
    /// The sum of their normals, weighted by twice the area.
    outward: DVec3,
}

/// A rectangle in the plane of a patch.
pub(super) struct Shape {
    pub(super) middle: DVec2,
    pub(super) half: DVec2,
    /// The direction of the first side.
    pub(super) along: DVec2,
}

impl Lamp {
    /// Its triangles by the way that they face, within a patch by about this cosine, and by their heights.
    pub(super) fn patches(&self, alike: f64) -> Vec<Patch<'_>> {
        self.facing(alike).into_iter().flat_map(|patch| self.at_heights(patch)).collect()
    }

    /// The parts of a patch that lie behind each other.
    fn at_heights<'l>(&self, patch: Patch<'l>) -> Vec<Patch<'l>> {
        // 1. The parts that are connected.
        let firsts = firsts(patch.triangles.iter().copied());
        if firsts.iter().all(|&first| first == 0) {
            return vec![patch];
        }
        // 2. Their heights.
        let normal = patch.normal();
        let mut parts: HashMap<usize, ([f64; 2], Vec<usize>)> = HashMap::new();
        for (index, first) in firsts.into_iter().enumerate() {
            let (ends, members) = parts.entry(first).or_insert(([f64::MAX, f64::MIN], Vec::new()));
            for corner in patch.triangles[index].corners {
                let height = normal.dot(corner);
                *ends = [ends[0].min(height), ends[1].max(height)];
            }
            members.push(index);
        }
        let mut parts: Vec<([f64; 2], Vec<usize>)> = parts.into_values().collect();
        parts.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        // 3. Those that are at one height are one.
        let level = LEVEL * self.diagonal();
        let mut levels: Vec<([f64; 2], Vec<usize>)> = Vec::new();
        for (ends, mut members) in parts {
            match levels.last_mut() {
                Some((last, all)) if ends[0] <= last[1] + level => {
                    last[1] = last[1].max(ends[1]);
                    all.append(&mut members);
                }
                _ => levels.push((ends, members)),
            }
        }
        let one = |(_, mut members): ([f64; 2], Vec<usize>)| {
            members.sort_unstable();
            let mut triangles = members.into_iter().map(|index| patch.triangles[index]);
            let first = triangles.next().expect("a part has a triangle");
            let toward = |triangle: &Triangle| {
                let outward = triangle.outward();
                if outward.dot(patch.outward) < 0.0 { -outward } else { outward }
            };
            let mut part = Patch { triangles: vec![first], outward: toward(first) };
            triangles.for_each(|triangle| part.add(triangle, toward(triangle)));
            part
        };
        levels.into_iter().map(one).collect()
    }

    /// Its triangles by the way that they face.
    fn facing(&self, alike: f64) -> Vec<Patch<'_>> {
        let mut triangles: Vec<&Triangle> = self.triangles.iter().collect();
        triangles.sort_by(|a, b| b.area().total_cmp(&a.area()));
        let volume = if self.one_sided { Some(1.0) } else { self.volume() };
        let sign = if volume.is_some_and(|volume| volume < 0.0) { -1.0 } else { 1.0 };
        let mut patches: Vec<Patch> = Vec::new();
        for triangle in triangles {
            let normal = sign * triangle.outward();
            if normal == DVec3::ZERO {
                continue;
            }
            // Both windings of an open lamp are the same patch.
            let cosine = |patch: &Patch| {
                let cosine = patch.normal().dot(normal.normalize());
                if volume.is_some() { cosine } else { cosine.abs() }
            };
            let is_full = patches.len() == PATCHES;
            let nearest = patches.iter_mut().map(|patch| (cosine(patch), patch)).max_by(|a, b| a.0.total_cmp(&b.0));
            match nearest {
                Some((cosine, patch)) if cosine >= alike || is_full => patch.add(triangle, normal),
                _ => patches.push(Patch { triangles: vec![triangle], outward: normal }),
            }
        }
        patches
    }

    /// Lights that shine as it does.
    pub(super) fn lights(&self, glow: &Glow, geometry: &Geometry, scene: &Extent, alike: f64) -> Vec<Light> {
        let mut patches = self.patches(alike);
        // 1. Without those that are much weaker than the strongest one: the others shine for them.
        let strength = |patches: &[Patch]| patches.iter().map(Patch::strength).sum::<f64>();
        let (all, strongest) = (strength(&patches), patches.iter().map(Patch::strength).fold(0.0, f64::max));
        patches.retain(|patch| patch.strength() >= SMALL * strongest);
        let brighter = all / strength(&patches);
        // 2. Of a bent surface, the image is not cut.
        let cuts_image = glow.has_image() && patches.len() <= 2;
        let is_closed = self.one_sided || self.volume().is_some();
        let is_room = is_closed
            && !self.one_sided
            && self.is_alone(&geometry.mesh)
            && !patches.iter().any(|patch| patch.is_lit(geometry, scene));
        let sides = |patch| match is_closed {
            true if is_room => both(patch).into(),
            true => vec![patch],
            false => sides(patch, geometry, scene),
        };
        let lights = |patch: Patch| patch.lights(glow, geometry, scene, (brighter, cuts_image));
        patches.into_iter().flat_map(sides).flat_map(lights).collect()
    }
}

/// A patch, and its other side.
fn both(patch: Patch<'_>) -> [Patch<'_>; 2] {
    let other = Patch { outward: -patch.outward, ..patch.clone() };
    [patch, other]
}

/// A patch that shines to both sides, each as one; one in front of which nothing is left is left out, unless that is true of both.
fn sides<'l>(patch: Patch<'l>, geometry: &Geometry, scene: &Extent) -> Vec<Patch<'l>> {
    let [patch, other] = both(patch);
    match [&patch, &other].map(|patch| patch.is_lit(geometry, scene)) {
        [true, false] => vec![patch],
        [false, true] => vec![other],
        _ => vec![patch, other],
    }
}

impl Patch<'_> {
    pub(super) fn normal(&self) -> DVec3 {
        self.outward.normalize_or(DVec3::Y)
    }

    /// Its light, over π: that of all its surface, also where that is curved.
    fn strength(&self) -> f64 {
        self.triangles.iter().map(|triangle| triangle.radiance * triangle.area()).sum()
    }

    /// Whether anything is in front of it.
    fn is_lit(&self, geometry: &Geometry, scene: &Extent) -> bool {
        let height = self.height() + BESIDE * scene.diagonal;
        is_lit(&geometry.mesh, &scene.bounds, self.normal(), height)
    }

    fn height(&self) -> f64 {
        let normal = self.normal();
        self.triangles
            .iter()
            .flat_map(|triangle| triangle.corners)
            .map(|corner| normal.dot(corner))
            .fold(f64::MIN, f64::max)
    }

    fn lights(
        &self,
        glow: &Glow,
        geometry: &Geometry,
        scene: &Extent,
        (brighter, cuts_image): (f64, bool),
    ) -> Vec<Light> {
        let normal = self.normal();
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let shape = self.rectangle(|corner| DVec2::new(u.dot(corner), v.dot(corner)));
        let axes = [shape.along.x * u + shape.along.y * v, shape.along.x * v - shape.along.y * u];
        let start = shape.middle.x * u + shape.middle.y * v;
        let pieces = pieces::pieces(self, glow, geometry, (start, axes, shape.half), scene, cuts_image);
        // The surface of all is what it is, whatever is lost at the edges of pieces.
        let surface: f64 = self.triangles.iter().map(|triangle| triangle.area()).sum();
        let brighter = brighter * surface / pieces.iter().map(|piece| piece.surface).sum::<f64>();
        let light = |piece: Piece| -> Light {
            let raised = piece.height + RAISED[0] * piece.area.sqrt() + RAISED[1] * scene.diagonal;
            let at = |[a, b]: [f64; 2]| (start + a * axes[0] + b * axes[1] + raised * normal).as_vec3();
            let filled = piece.area / (4.0 * piece.half.x * piece.half.y);
            let is_square = (piece.half.x / piece.half.y - 1.0).abs() < DISC.1;
            let kind = if piece.is_whole && is_square && (filled - DISC.0).abs() < DISC.1 {
                let radius = (piece.area / std::f64::consts::PI).sqrt() as f32;
                LightKind::Disk { position: at(piece.center.to_array()), normal: normal.as_vec3(), radius }
            } else {
                let is_full = filled > FILLED;
                let (middle, share) = if is_full { (piece.center, 1.0) } else { (piece.middle, filled.sqrt()) };
                let half_u = (share * piece.half.x * axes[0]).as_vec3();
                let half_v = (share * piece.half.y * axes[1]).as_vec3();
                LightKind::Rectangle { position: at(middle.to_array()), half_u, half_v }
            };
            Light::new(kind)
                .with_intensity((brighter * piece.strength).as_vec3())
                .with_falloff(Falloff::InverseSquare)
                .with_surface(normal.as_vec3())
                .with_lamp(true)
                .named(glow.name)
        };
        pieces.into_iter().map(light).collect()
    }

    /// The smallest rectangle around it along one of its edges.
    fn rectangle(&self, flat: impl Fn(DVec3) -> DVec2) -> Shape {
        let corners: Vec<DVec2> = self.triangles.iter().flat_map(|triangle| triangle.corners).map(&flat).collect();
        let edges = self.triangles.iter().take(EDGES).flat_map(|triangle| {
            let [a, b, c] = triangle.corners;
            [b - a, c - b, a - c]
        });
        let around = |edge: DVec3| {
            let along = flat(edge).normalize_or(DVec2::X);
            let turned = |corner: &DVec2| DVec2::new(along.dot(*corner), along.perp_dot(*corner));
            let least = corners.iter().map(turned).fold(DVec2::INFINITY, DVec2::min);
            let most = corners.iter().map(turned).fold(DVec2::NEG_INFINITY, DVec2::max);
            let middle = 0.5 * (least + most);
            Shape { middle: middle.x * along + middle.y * along.perp(), half: 0.5 * (most - least), along }
        };
        let area = |shape: &Shape| shape.half.x * shape.half.y;
        edges.map(around).min_by(|a, b| area(a).total_cmp(&area(b))).expect("a patch has a triangle")
    }
}

impl<'l> Patch<'l> {
    fn add(&mut self, triangle: &'l Triangle, normal: DVec3) {
        self.triangles.push(triangle);
        self.outward += if normal.dot(self.outward) < 0.0 { -normal } else { normal };
    }
}
