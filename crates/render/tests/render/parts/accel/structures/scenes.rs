//! Triangles for the property tests.

use std::collections::HashMap;

use glam::Vec3;
use lightmesh_memory::Budget;
use lightmesh_render::accel::Triangle;
use lightmesh_render::internals::accel::AlphaMask;
use lightmesh_scene::{Geometry, Material, Mesh, Opacity, OpacityChannel, Texture, TextureUse, Wrap};

use super::Random;

/// Kinds of scenes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scene {
    Empty,
    One,
    Soup,
    /// Triangles of sizes from 1e-3 to 1e3 mixed.
    Scales,
    /// Axis-aligned boxes with whole coordinates.
    Boxes,
    /// All triangles in one axis-aligned plane: no extent on one axis.
    Flat,
    /// A slanted sheet of triangles that share edges.
    Sheet,
    Icosphere,
    /// Points, needles, repeated triangles.
    Degenerate,
    /// A soup far from the origin of coordinates.
    Offset,
}

pub(super) const ALL: [Scene; 10] = [
    Scene::Empty,
    Scene::One,
    Scene::Soup,
    Scene::Scales,
    Scene::Boxes,
    Scene::Flat,
    Scene::Sheet,
    Scene::Icosphere,
    Scene::Degenerate,
    Scene::Offset,
];

impl Scene {
    pub(super) fn triangles(self, random: &mut Random) -> Vec<Triangle> {
        let corners = match self {
            Scene::Empty => Vec::new(),
            Scene::One => soup(random, 1, |_| 1.0, Vec3::ZERO),
            Scene::Soup => soup(random, 150, |_| 0.4, Vec3::ZERO),
            Scene::Scales => soup(random, 100, |random| 10f32.powf(random.unit() * 6.0 - 3.0), Vec3::ZERO),
            Scene::Boxes => (0..15).flat_map(|_| aligned_box(random)).collect(),
            Scene::Flat => flat(random),
            Scene::Sheet => sheet(random),
            Scene::Icosphere => icosphere(2),
            Scene::Degenerate => degenerate(random),
            Scene::Offset => soup(random, 100, |_| 0.5, Vec3::new(3e4, -2e4, 1e4)),
        };
        indexed(&corners)
    }
}

/// Triangles of which, if `cut`, two of three are cut out by noise.
pub(super) fn alpha_tested(triangles: Vec<Triangle>, cut: bool, random: &mut Random) -> (Vec<Triangle>, AlphaMask) {
    let count = triangles.len() as u32;
    let texels = (0..64).map(|_| [0, 0, 0, random.below(256) as u8]).collect();
    let mesh = Mesh {
        positions: vec![Vec3::ZERO; 3 * triangles.len()],
        uvs: (0..3 * count).map(|_| 2.0 * random.signed().truncate()).collect(),
        opacities: (0..3 * count).map(|_| 0.5 + 0.5 * random.unit()).collect(),
        triangles: (0..count).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect(),
        materials: (0..count).map(|index| u32::from(cut && index % 3 != 0)).collect(),
        ..Mesh::default()
    };
    let uses = TextureUse { wrap: [Wrap::Repeat, Wrap::Mirror], ..TextureUse::new(0) };
    let leaves = Material::default().with_opacity(Opacity::by(uses, OpacityChannel::Alpha).with_cutoff(0.4));
    let textures = vec![Texture { name: String::new(), size: [16, 4], texels }].into();
    let geometry = Geometry { mesh, materials: vec![Material::default(), leaves], textures, ..Geometry::default() };
    let (alpha_mask, numbers) = AlphaMask::of(&geometry, Budget::default()).unwrap();
    assert_eq!(numbers.iter().any(|&number| number != 0), cut && count > 1);
    let number = |index: usize| numbers.get(index).copied().unwrap_or(0);
    let triangles = triangles.iter().enumerate().map(|(index, triangle)| triangle.alpha_tested(number(index)));
    (triangles.collect(), alpha_mask)
}

pub(super) fn indexed(corners: &[[Vec3; 3]]) -> Vec<Triangle> {
    corners.iter().zip(0..).map(|(&corners, index)| Triangle::new(corners, index)).collect()
}

fn soup(random: &mut Random, count: usize, size: impl Fn(&mut Random) -> f32, offset: Vec3) -> Vec<[Vec3; 3]> {
    let triangle = |_| {
        let (center, size) = (random.signed() * 3.0 + offset, size(random));
        [0; 3].map(|_| center + random.signed() * size)
    };
    (0..count).map(triangle).collect()
}

fn quad([a, b, c, d]: [Vec3; 4]) -> [[Vec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

fn aligned_box(random: &mut Random) -> Vec<[Vec3; 3]> {
    let mut whole = |count: usize| Vec3::from([0; 3].map(|_| random.below(count) as f32));
    let (low, extent) = (whole(6) - 3.0, whole(3));
    let at = |bits: usize| low + extent * Vec3::from([0, 1, 2].map(|axis| (bits >> axis & 1) as f32));
    let faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    faces.iter().flat_map(|face| quad(face.map(at))).collect()
}

fn flat(random: &mut Random) -> Vec<[Vec3; 3]> {
    let axis = random.below(3);
    let height = random.pick(&[0.0, 0.5, -7.3]);
    let mut triangles = soup(random, 60, |_| 0.5, Vec3::ZERO);
    for corner in triangles.as_flattened_mut() {
        corner[axis] = height;
    }
    triangles
}

fn sheet(random: &mut Random) -> Vec<[Vec3; 3]> {
    let (right, up) = (random.signed(), random.signed());
    let at = |x: i32, y: i32| right * x as f32 * 0.3 + up * y as f32 * 0.3;
    let cells = (-6..6).flat_map(|x| (-6..6).map(move |y| (x, y)));
    cells.flat_map(|(x, y)| quad([at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)])).collect()
}

fn degenerate(random: &mut Random) -> Vec<[Vec3; 3]> {
    let mut triangles = soup(random, 20, |_| 1.0, Vec3::ZERO);
    for index in 0..20 {
        let [a, b, c] = triangles[index];
        triangles.extend([[a; 3], [a, b, a], [a, b, a.lerp(b, 0.5)], [a, b, b + (c - b) * 1e-6], [a, b, c], [a, b, c]]);
    }
    triangles.push([Vec3::NAN; 3]);
    triangles.push([Vec3::ZERO, Vec3::X, Vec3::INFINITY]);
    triangles.push([Vec3::ZERO, Vec3::X, Vec3::Y * 1e30]);
    triangles
}

/// A closed mesh whose triangles share vertices bit for bit.
pub(super) fn icosphere(subdivisions: u32) -> Vec<[Vec3; 3]> {
    let mut triangles = octahedron();
    for _ in 0..subdivisions {
        let mut middles = HashMap::new();
        let mut middle = |a: Vec3, b: Vec3| {
            let mut key = [a.to_array().map(f32::to_bits), b.to_array().map(f32::to_bits)];
            key.sort_unstable();
            *middles.entry(key).or_insert_with(|| (a + b).normalize())
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    triangles
}

fn octahedron() -> Vec<[Vec3; 3]> {
    let sign = |octant: i32, bit: i32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
    (0..8).map(|octant| [Vec3::X * sign(octant, 0), Vec3::Y * sign(octant, 1), Vec3::Z * sign(octant, 2)]).collect()
}
