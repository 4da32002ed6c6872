//! Triangles of a lamp that face a similar way are a patch: an emitter in one plane. Those that lie behind each other, and are not connected by
//! others of the patch, are patches of their own: the inner sides of a trough shine into it, the outer ones away from it.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::connected::{Lamp, Triangle, firsts};

/// Patches of a lamp, at most.
const PATCHES: usize = 14;
/// Edges of a patch along which a rectangle is tried.
const EDGES: usize = 64;
/// Parts of a patch whose heights differ less, as a share of the lamp's size, are at one height.
const LEVEL: f64 = 1e-3;

/// Triangles that face a similar way.
#[derive(Clone)]
pub(super) struct Patch<'l> {
    pub(super) triangles: Vec<&'l Triangle>,
    /// The sum of their normals, weighted by twice the area.
    pub(super) outward: DVec3,
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
}

impl Patch<'_> {
    pub(super) fn normal(&self) -> DVec3 {
        self.outward.normalize_or(DVec3::Y)
    }

    /// That of its highest corner, along the normal.
    pub(super) fn height(&self) -> f64 {
        let normal = self.normal();
        self.triangles
            .iter()
            .flat_map(|triangle| triangle.corners)
            .map(|corner| normal.dot(corner))
            .fold(f64::MIN, f64::max)
    }

    /// The smallest rectangle around it along one of its edges.
    pub(super) fn rectangle(&self, flat: impl Fn(DVec3) -> DVec2) -> Shape {
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
