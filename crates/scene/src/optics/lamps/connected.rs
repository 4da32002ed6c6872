//! Triangles that share corners are one lamp.

use std::collections::{HashMap, HashSet};

use glam::{DVec3, Vec3};

use super::{extent::Extent, glow::Glow};
use crate::{Bounds, Geometry, Mesh};

/// A lamp surrounds the scene if it is larger than this share of the scene's diagonal,
const AROUND: f64 = 0.5;
/// and covers this share of half of the view from its middle: more than a plane can.
const COVERED: f64 = 0.95;

/// Corners that are nearer than about this share of the scene's diagonal are one.
const WELDED: f64 = 1e-6;
/// Triangles that emit less than this share of the brightest one's radiance are dark: the black parts of an image.
const DARK: f32 = 1.0 / 256.0;

/// A triangle that emits light.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [DVec3; 3],
    /// Where it is stored.
    pub(super) stored: usize,
    /// The mean over its channels and texels of what it emits.
    pub(super) radiance: f64,
    is_instanced: bool,
    /// Its corners as numbers: equal ones are one.
    places: [Place; 3],
}

/// Triangles that share corners.
#[derive(Debug, Default)]
pub(super) struct Lamp {
    pub(super) triangles: Vec<Triangle>,
    /// Whether only the front emits: where corners are counter-clockwise.
    pub(super) one_sided: bool,
}

/// A corner, rounded.
type Place = [i64; 3];

/// The lamps of each material that is marked, in the order of materials.
pub(super) fn lamps(geometry: &Geometry, scene: &Extent) -> Vec<(u32, Vec<Lamp>)> {
    let mut triangles: Vec<Vec<Triangle>> = geometry.materials.iter().map(|_| Vec::new()).collect();
    let glows: Vec<Option<Glow>> = (0..geometry.materials.len() as u32)
        .map(|number| geometry.materials[number as usize].lamp.then(|| Glow::of(geometry, number)))
        .collect();
    each_triangle(geometry, |stored, corners, is_instanced| {
        let material = geometry.mesh.materials[stored] as usize;
        if let Some(glow) = &glows[material] {
            let radiance = glow.of_triangle(&geometry.mesh, stored).element_sum() / 3.0;
            let place = |corner: DVec3| (corner / (WELDED * scene.diagonal)).round().to_array().map(|axis| axis as i64);
            triangles[material].push(Triangle { corners, stored, radiance, is_instanced, places: corners.map(place) });
        }
    });
    let of_material = |(number, mut triangles): (usize, Vec<Triangle>)| {
        let most = triangles.iter().map(|triangle| triangle.radiance).fold(0.0, f64::max);
        triangles.retain(|triangle| triangle.radiance > f64::from(DARK) * most);
        let one_sided = geometry.materials[number].one_sided;
        (!triangles.is_empty()).then(|| (number as u32, connected(triangles, one_sided)))
    };
    triangles.into_iter().enumerate().filter_map(of_material).collect()
}

/// All triangles of materials that are marked, in the local frame: stored ones, and those of instances in their places.
fn each_triangle(geometry: &Geometry, mut take: impl FnMut(usize, [DVec3; 3], bool)) {
    let mesh = &geometry.mesh;
    let is_marked = |&index: &usize| geometry.materials[mesh.materials[index] as usize].lamp;
    for index in mesh.own_triangles().filter(is_marked) {
        take(index, mesh.corners(index).map(|corner| corner.as_dvec3()), false);
    }
    let mut shapes: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for instance in mesh.instances.list() {
        let range = instance.triangles.clone();
        let marked = || (range.start as usize..range.end as usize).filter(is_marked).collect();
        for &index in shapes.entry((range.start, range.end)).or_insert_with(marked).iter() {
            take(index, mesh.corners(index).map(|corner| instance.place.point(corner).as_dvec3()), true);
        }
    }
}

/// The lamps that these triangles form.
fn connected(triangles: Vec<Triangle>, one_sided: bool) -> Vec<Lamp> {
    let firsts = firsts(triangles.iter());
    let mut lamps: Vec<Lamp> = Vec::new();
    let mut numbers: HashMap<usize, usize> = HashMap::new();
    for (triangle, first) in triangles.into_iter().zip(firsts) {
        let number = *numbers.entry(first).or_insert_with(|| {
            lamps.push(Lamp { one_sided, ..Lamp::default() });
            lamps.len() - 1
        });
        lamps[number].triangles.push(triangle);
    }
    lamps
}

/// Of each triangle, the number of the first of those with which corners connect it.
pub(super) fn firsts<'t>(triangles: impl ExactSizeIterator<Item = &'t Triangle>) -> Vec<usize> {
    let mut leaders: Vec<usize> = (0..triangles.len()).collect();
    let mut at: HashMap<Place, usize> = HashMap::new();
    for (index, triangle) in triangles.enumerate() {
        for place in triangle.places {
            let other = *at.entry(place).or_insert(index);
            let (a, b) = (leader(&mut leaders, other), leader(&mut leaders, index));
            leaders[a.max(b)] = a.min(b);
        }
    }
    (0..leaders.len()).map(|index| leader(&mut leaders, index)).collect()
}

/// The first triangle of those that belong together; ways to it become shorter.
fn leader(leaders: &mut [usize], mut index: usize) -> usize {
    while leaders[index] != index {
        leaders[index] = leaders[leaders[index]];
        index = leaders[index];
    }
    index
}

impl Triangle {
    /// Along its normal; the length is twice the area.
    pub(super) fn outward(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    pub(super) fn area(&self) -> f64 {
        0.5 * self.outward().length()
    }

    /// The solid angle that it covers, negative if it shows its back (Van Oosterom and Strackee 1983).
    fn solid_angle(&self, from: DVec3) -> f64 {
        let [a, b, c] = self.corners.map(|corner| (corner - from).normalize_or_zero());
        let divisor = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        -2.0 * a.dot(b.cross(c)).atan2(divisor)
    }
}

impl Lamp {
    pub(super) fn corners(&self) -> impl Iterator<Item = DVec3> + Clone {
        self.triangles.iter().flat_map(|triangle| triangle.corners)
    }

    pub(super) fn diagonal(&self) -> f64 {
        let least = self.corners().fold(DVec3::INFINITY, DVec3::min);
        let most = self.corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        (most - least).length()
    }

    /// Whether most of the scene is inside of it, and gather rays cannot miss it. Materials of instances cannot be told apart.
    pub(super) fn surrounds(&self, geometry: &Geometry, scene: &Extent) -> bool {
        let is_large = || self.diagonal() > AROUND * scene.diagonal;
        let covered = || -> f64 {
            let angles = self.triangles.iter().map(|triangle| triangle.solid_angle(scene.middle));
            angles.map(|angle| if self.one_sided { angle.max(0.0) } else { angle.abs() }).sum()
        };
        let is_own = self.triangles.iter().all(|triangle| !triangle.is_instanced);
        is_own && is_large() && covered() > COVERED * std::f64::consts::TAU && self.contains_most(&geometry.mesh)
    }

    /// Whether the box around it contains most other triangles, and there are any.
    fn contains_most(&self, mesh: &Mesh) -> bool {
        let own: HashSet<usize> = self.triangles.iter().map(|triangle| triangle.stored).collect();
        let bounds = Bounds::around(self.corners().map(|corner| corner.as_vec3()));
        let is_within = |corner: Vec3| corner.cmpge(bounds.min).all() && corner.cmple(bounds.max).all();
        let others = mesh.own_triangles().filter(|index| !own.contains(index));
        let others = others.map(|index| mesh.corners(index).into_iter().all(is_within));
        let placed = mesh.instances.list().iter();
        let placed = placed.map(|instance| is_within(instance.bounds.min) && is_within(instance.bounds.max));
        let (within, all) = others.chain(placed).fold((0, 0), |(within, all), is| (within + usize::from(is), all + 1));
        2 * within > all
    }

    /// Whether there is nothing else.
    pub(super) fn is_alone(&self, mesh: &Mesh) -> bool {
        let own: HashSet<usize> = self.triangles.iter().map(|triangle| triangle.stored).collect();
        let mut stored = mesh.own_triangles();
        let mut placed = mesh.instances.list().iter().flat_map(|instance| instance.triangles.clone());
        stored.all(|index| own.contains(&index)) && placed.all(|index| own.contains(&(index as usize)))
    }

    /// Six times the volume that a closed lamp encloses, negative if its triangles face inwards; `None` for an open one.
    pub(super) fn volume(&self) -> Option<f64> {
        let mut edges: HashMap<[Place; 2], i32> = HashMap::new();
        for Triangle { places, .. } in &self.triangles {
            for edge in 0..3 {
                let [a, b] = [places[edge], places[(edge + 1) % 3]];
                // The triangles at the poles of balls are often needles.
                if a == b {
                    continue;
                }
                *edges.entry(if a < b { [a, b] } else { [b, a] }).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let is_closed = edges.values().all(|&sum| sum == 0);
        let middle = self.corners().sum::<DVec3>() / (3 * self.triangles.len()) as f64;
        let part = |[a, b, c]: [DVec3; 3]| (a - middle).dot((b - middle).cross(c - middle));
        is_closed.then(|| self.triangles.iter().map(|triangle| part(triangle.corners)).sum())
    }
}

/// Whether a vertex of the scene is farther than `height` along `normal`: then something may get light that goes there.
pub(super) fn is_lit(mesh: &Mesh, bounds: &Bounds, normal: DVec3, height: f64) -> bool {
    let corner = DVec3::select(normal.cmpgt(DVec3::ZERO), bounds.max.as_dvec3(), bounds.min.as_dvec3());
    if normal.dot(corner) <= height {
        return false;
    }
    let is_far = |point: DVec3| normal.dot(point) > height;
    let mut own = mesh.own_triangles();
    let mut placed = mesh.instances.list().iter();
    own.any(|index| mesh.corners(index).iter().any(|corner| is_far(corner.as_dvec3())))
        || placed.any(|instance| {
            let Bounds { min, max } = instance.bounds;
            is_far(DVec3::select(normal.cmpgt(DVec3::ZERO), max.as_dvec3(), min.as_dvec3()))
        })
}
