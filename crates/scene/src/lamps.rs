//! Lights for lamps: emissive surfaces that are small in their scene.
//!
//! Gather rays rarely find a small bright surface, so that it is sampled like a light. Large ones, such as a glowing ceiling, are left to what
//! gathers light: they have no blotches.
//!
//! 1. The triangles of a material that share corners form a lamp.
//! 2. Its triangles that face a similar way form a patch: an emitter in one plane.
//! 3. A patch becomes a rectangle, or a disc, of its area. A rectangle and a disc become just that.

use std::collections::HashMap;

use glam::{DVec2, DVec3, Vec3};

use crate::{Falloff, Geometry, Light, LightKind, Material, Scene};

/// A lamp is smaller than this share of its scene's diagonal.
const LARGEST: f64 = 0.25;
/// Patches of a lamp, at most.
const PATCHES: usize = 14;
/// Triangles whose normals deviate more, by cosine, begin a patch of their own. If there are too many lights, the next one counts: else small
/// lamps would lose those of their sides, and the wall behind them its light.
const SAME_PATCH: [f64; 5] = [0.85, 0.75, 0.6, 0.4, 0.2];
/// Lights that are made at most: the smallest of more are added to others.
pub const LIGHTS: usize = 32;
/// Patches that give less than this share of the largest one's light are left out: the others shine for them.
const SMALL: f64 = 0.05;
/// Edges of a patch along which a rectangle is tried.
const EDGES: usize = 64;
/// How much of its rectangle a patch fills that is one.
const FILLED: f64 = 0.98;
/// The share of its square that a disc fills, and how much that may differ, also between its widths.
const DISC: (f64, f64) = (std::f64::consts::FRAC_PI_4, 0.06);
/// An open lamp that faces the scene's middle less than this, by cosine, shines on both sides.
const ASIDE: f64 = 0.1;
/// Corners that are nearer than about this share of the scene's diagonal are one.
const WELDED: f64 = 1e-6;
/// How far lights lie in front of their surface, relative to its size and to the scene's.
const RAISED: [f64; 2] = [1e-3, 1e-5];

/// Makes lights for the lamps of a geometry, among the materials that are [marked](crate::Material::lamp). The mark of those that
/// are none, such as all that emit nothing, is taken away.
pub fn lamps(geometry: &mut Geometry) -> Vec<Light> {
    let bounds = geometry.mesh.bounds();
    let scene = Extent { middle: bounds.center().as_dvec3(), diagonal: f64::from(bounds.diagonal()) };
    let mut found: Vec<(usize, Vec<Lamp>)> = Vec::new();
    for number in 0..geometry.materials.len() {
        let material = &mut geometry.materials[number];
        material.lamp = may_be_lamp(material);
        if !material.lamp {
            continue;
        }
        let lamps = lamps_of(geometry, number as u32, &scene);
        let is_small = |lamp: &Lamp| lamp.diagonal() < LARGEST * scene.diagonal;
        let material = &mut geometry.materials[number];
        material.lamp = !lamps.is_empty() && lamps.iter().all(is_small);
        if material.lamp {
            found.push((number, lamps));
        }
    }
    let count = |alike: f64| -> usize {
        found.iter().flat_map(|(_, lamps)| lamps).map(|lamp| lamp.patches(&scene, alike).len()).sum()
    };
    let alike = SAME_PATCH.into_iter().find(|&alike| count(alike) <= LIGHTS).unwrap_or(SAME_PATCH[4]);
    let mut lights = Vec::new();
    for (number, lamps) in found {
        let material = &mut geometry.materials[number];
        let name = if material.name.is_empty() { "lamp" } else { &material.name };
        let patches = lamps.iter().flat_map(|lamp| lamp.patches(&scene, alike));
        let own: Vec<Light> = patches.map(|patch| patch.light(material.emission, name, &scene)).collect();
        material.lamp = own.iter().all(is_usable);
        if material.lamp {
            lights.extend(own);
        }
    }
    merged(lights)
}

/// Whether lights may stand for what surfaces of a material emit; what an image emits is not a lamp's.
pub(crate) fn may_be_lamp(material: &Material) -> bool {
    let plain = material.emission_tinted == Vec3::ZERO && material.emission_texture.is_none();
    material.lamp && material.emission != Vec3::ZERO && plain
}

/// Whether a light has a size and a strength in single precision.
fn is_usable(light: &Light) -> bool {
    let has_size = match light.kind {
        LightKind::Rectangle { half_u, half_v, .. } => half_u.cross(half_v).length_squared() > 0.0,
        LightKind::Disk { radius, .. } => radius > 0.0,
        _ => false,
    };
    has_size && light.intensity.is_finite()
}

impl Scene {
    /// Makes lights for lamps: emissive surfaces that are small in the scene, as opened files have them. Their
    /// [materials](crate::Material::lamp) are marked; lights that were made before are replaced.
    pub fn add_lamps(&mut self) {
        self.lights.list.retain(|light| light.surface.is_none());
        let geometry = self.geometry_mut();
        for material in &mut geometry.materials {
            material.lamp = true;
        }
        let lights = lamps(geometry);
        self.lights.list.extend(lights);
    }
}

/// The scene around.
struct Extent {
    middle: DVec3,
    diagonal: f64,
}

/// Triangles that share corners.
#[derive(Default)]
struct Lamp {
    triangles: Vec<[DVec3; 3]>,
    /// Their corners as numbers: equal ones are one.
    places: Vec<[Place; 3]>,
}

/// A corner, rounded.
type Place = [i64; 3];

/// The lamps of a material.
fn lamps_of(geometry: &Geometry, material: u32, scene: &Extent) -> Vec<Lamp> {
    let mesh = &geometry.mesh;
    // Shapes in many places have no lamps.
    let own = mesh.own_triangles().filter(|&index| mesh.materials[index] == material);
    let triangles: Vec<[DVec3; 3]> = own.map(|index| mesh.corners(index).map(|corner| corner.as_dvec3())).collect();
    let place = |corner: DVec3| (corner / (WELDED * scene.diagonal)).round().to_array().map(|axis| axis as i64);
    let places: Vec<[Place; 3]> = triangles.iter().map(|corners| corners.map(place)).collect();
    // The first triangle of each lamp, found by the corners of others.
    let mut leaders: Vec<usize> = (0..triangles.len()).collect();
    let mut at: HashMap<Place, usize> = HashMap::new();
    for (index, corners) in places.iter().enumerate() {
        for corner in corners {
            let other = *at.entry(*corner).or_insert(index);
            let (a, b) = (leader(&mut leaders, other), leader(&mut leaders, index));
            leaders[a.max(b)] = a.min(b);
        }
    }
    let mut lamps: Vec<Lamp> = Vec::new();
    let mut numbers: HashMap<usize, usize> = HashMap::new();
    for (index, (corners, places)) in triangles.iter().zip(&places).enumerate() {
        let first = leader(&mut leaders, index);
        let number = *numbers.entry(first).or_insert_with(|| {
            lamps.push(Lamp::default());
            lamps.len() - 1
        });
        lamps[number].triangles.push(*corners);
        lamps[number].places.push(*places);
    }
    lamps
}

/// The first triangle of those that belong together; ways to it become shorter.
fn leader(leaders: &mut [usize], mut index: usize) -> usize {
    while leaders[index] != index {
        leaders[index] = leaders[leaders[index]];
        index = leaders[index];
    }
    index
}

/// Along the normal of a triangle; its length is twice the area.
fn outward([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

impl Lamp {
    fn corners(&self) -> impl Iterator<Item = DVec3> + Clone {
        self.triangles.iter().flatten().copied()
    }

    fn diagonal(&self) -> f64 {
        let least = self.corners().fold(DVec3::INFINITY, DVec3::min);
        let most = self.corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        (most - least).length()
    }

    /// Six times the volume that a closed lamp encloses, negative if its triangles face inwards; `None` for an open one.
    fn volume(&self) -> Option<f64> {
        let mut edges: HashMap<[Place; 2], i32> = HashMap::new();
        for corners in &self.places {
            for edge in 0..3 {
                let [a, b] = [corners[edge], corners[(edge + 1) % 3]];
                // The triangles at the poles of balls are often needles.
                if a == b {
                    continue;
                }
                *edges.entry(if a < b { [a, b] } else { [b, a] }).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let is_closed = edges.values().all(|&sum| sum == 0);
        let middle = self.corners().sum::<DVec3>() / (3 * self.triangles.len()) as f64;
        let part = |[a, b, c]: &[DVec3; 3]| (*a - middle).dot((*b - middle).cross(*c - middle));
        is_closed.then(|| self.triangles.iter().map(part).sum())
    }

    /// Its triangles by the way that they face: within a patch by about this cosine.
    fn patches(&self, scene: &Extent, alike: f64) -> Vec<Patch> {
        let mut triangles: Vec<&[DVec3; 3]> = self.triangles.iter().collect();
        triangles.sort_by(|a, b| outward(b).length().total_cmp(&outward(a).length()));
        let volume = self.volume();
        // All sides of a closed lamp shine outwards.
        let sign = if volume.is_some_and(|volume| volume < 0.0) { -1.0 } else { 1.0 };
        let mut patches: Vec<Patch> = Vec::new();
        for triangle in triangles {
            let normal = sign * outward(triangle);
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
                _ => patches.push(Patch { triangles: vec![*triangle], outward: normal, brighter: 1.0 }),
            }
        }
        join_small(&mut patches);
        if volume.is_some() { patches } else { patches.into_iter().flat_map(|patch| patch.sides(scene)).collect() }
    }
}

/// Leaves out patches that are much smaller than the largest one: the others shine for them.
fn join_small(patches: &mut Vec<Patch>) {
    let largest = patches.iter().map(|patch| patch.outward.length()).fold(0.0, f64::max);
    let (kept, small): (Vec<Patch>, Vec<Patch>) =
        patches.drain(..).partition(|patch| patch.outward.length() >= SMALL * largest);
    let area = |patches: &[Patch]| patches.iter().map(|patch| patch.outward.length()).sum::<f64>();
    let brighter = 1.0 + area(&small) / area(&kept);
    patches.extend(kept);
    patches.iter_mut().for_each(|patch| patch.brighter = brighter);
}

/// Triangles that face a similar way.
#[derive(Clone)]
struct Patch {
    triangles: Vec<[DVec3; 3]>,
    /// The sum of their normals, weighted by twice the area.
    outward: DVec3,
    /// By what its light is multiplied, for what it stands for.
    brighter: f64,
}

/// A shape in the plane of a patch.
struct Shape {
    middle: DVec2,
    half: DVec2,
    /// The direction of the first side.
    along: DVec2,
}

impl Patch {
    fn add(&mut self, triangle: &[DVec3; 3], normal: DVec3) {
        self.triangles.push(*triangle);
        self.outward += if normal.dot(self.outward) < 0.0 { -normal } else { normal };
    }

    fn normal(&self) -> DVec3 {
        self.outward.normalize_or(DVec3::Y)
    }

    /// Twice its area: it gives all the light of its surface, also where that is curved.
    fn surface(&self) -> f64 {
        self.triangles.iter().map(|triangle| outward(triangle).length()).sum()
    }

    fn middle(&self) -> DVec3 {
        let weighted = |triangle: &[DVec3; 3]| outward(triangle).length() * triangle.iter().sum::<DVec3>() / 3.0;
        self.triangles.iter().map(weighted).sum::<DVec3>() / self.surface()
    }

    /// The sides of an open lamp that shine: that to the scene's middle, or both.
    fn sides(self, scene: &Extent) -> Vec<Patch> {
        let cosine = self.normal().dot((scene.middle - self.middle()).normalize_or_zero());
        let other = Patch { outward: -self.outward, ..self.clone() };
        match cosine {
            _ if cosine > ASIDE => vec![self],
            _ if cosine < -ASIDE => vec![other],
            _ => vec![self, other],
        }
    }

    fn light(&self, emission: Vec3, name: &str, scene: &Extent) -> Light {
        let normal = self.normal();
        let [u, v] = [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())];
        let flat = |corner: DVec3| DVec2::new(u.dot(corner), v.dot(corner));
        // As seen from its front.
        let area: f64 = self.triangles.iter().map(|triangle| 0.5 * outward(triangle).dot(normal).abs()).sum();
        let shape = self.rectangle(flat);
        let filled = area / (4.0 * shape.half.x * shape.half.y);
        let height = self.triangles.iter().flatten().map(|corner| normal.dot(*corner)).fold(f64::MIN, f64::max);
        let raised = height + RAISED[0] * area.sqrt() + RAISED[1] * scene.diagonal;
        let at = |middle: DVec2| (middle.x * u + middle.y * v + raised * normal).as_vec3();
        let is_disc = (filled - DISC.0).abs() < DISC.1 && (shape.half.x / shape.half.y - 1.0).abs() < DISC.1;
        let kind = if is_disc {
            let radius = (area / std::f64::consts::PI).sqrt() as f32;
            LightKind::Disk { position: at(shape.middle), normal: normal.as_vec3(), radius }
        } else {
            let (middle, share) =
                if filled > FILLED { (shape.middle, 1.0) } else { (flat(self.middle()), filled.sqrt()) };
            let along = share * shape.half.x * (shape.along.x * u + shape.along.y * v);
            let across = share * shape.half.y * (shape.along.x * v - shape.along.y * u);
            LightKind::Rectangle { position: at(middle), half_u: along.as_vec3(), half_v: across.as_vec3() }
        };
        Light::new(kind)
            .with_intensity((self.brighter * 0.5 * self.surface()) as f32 * emission)
            .with_falloff(Falloff::InverseSquare)
            .with_surface(normal.as_vec3())
            .named(name)
    }

    /// The smallest rectangle around it along one of its edges.
    fn rectangle(&self, flat: impl Fn(DVec3) -> DVec2) -> Shape {
        let corners: Vec<DVec2> = self.triangles.iter().flatten().map(|corner| flat(*corner)).collect();
        let edges = self.triangles.iter().take(EDGES).flat_map(|[a, b, c]| [b - a, c - b, a - c]);
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

/// The largest of the lights, which give what others would: each that of the nearest.
fn merged(mut lights: Vec<Light>) -> Vec<Light> {
    lights.sort_by(|a, b| b.intensity.element_sum().total_cmp(&a.intensity.element_sum()));
    let others = lights.split_off(lights.len().min(LIGHTS));
    for other in others {
        let distance = |light: &Light| match (light.position(), other.position()) {
            (Some(a), Some(b)) => a.distance(b),
            _ => f32::INFINITY,
        };
        if let Some(nearest) = lights.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            nearest.intensity += other.intensity;
        }
    }
    lights
}
