//! Building blocks of the built-in scenes: boxes, prisms, tubes, balls, and the list that they are added to.
//!
//! Every object is built around its own origin, Y up, and placed by [`Parts::put`]. Faces are wound counter-clockwise seen from
//! outside.

use glam::{Vec2, Vec3};

use super::math::around;
use crate::{Material, Mesh};

/// Index of a material in its [`Palette`].
pub(super) type Paint = u32;

/// The materials of a scene.
#[derive(Default)]
pub(super) struct Palette(pub(super) Vec<Material>);

impl Palette {
    /// A matt material of the linear colour `color`.
    pub(super) fn matt(&mut self, name: &str, color: Vec3) -> Paint {
        self.glossy(name, color, 0.0, 1.0)
    }

    /// A material with a white Phong lobe.
    pub(super) fn glossy(&mut self, name: &str, color: Vec3, ks: f32, shininess: f32) -> Paint {
        self.0.push(Material {
            name: name.into(),
            ka: color,
            kd: color,
            ks: Vec3::splat(ks),
            shininess,
            ..Material::default()
        });
        self.0.len() as Paint - 1
    }
}

/// The placement of an object: scaled, rotated about Y, translated.
#[derive(Clone, Copy)]
pub(super) struct Place {
    position: Vec3,
    turn: Vec2,
    scale: f32,
}

impl Place {
    pub(super) fn at(x: f32, y: f32, z: f32) -> Place {
        Place { position: Vec3::new(x, y, z), turn: Vec2::X, scale: 1.0 }
    }

    /// Rotated by `degrees` about Y, from +Z towards +X.
    pub(super) fn turned(self, degrees: f32) -> Place {
        Place { turn: around(degrees / 360.0), ..self }
    }

    pub(super) fn scaled(self, scale: f32) -> Place {
        Place { scale, ..self }
    }

    fn direction(&self, v: Vec3) -> Vec3 {
        let Vec2 { x: cos, y: sin } = self.turn;
        Vec3::new(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x)
    }

    fn point(&self, v: Vec3) -> Vec3 {
        self.position + self.scale * self.direction(v)
    }
}

/// Faces of a box that [`Parts::cuboid`] omits, because nobody can see them.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Open {
    Nothing,
    Bottom,
    TopAndBottom,
}

/// The triangles of a scene while it is built.
#[derive(Default)]
pub(super) struct Parts {
    mesh: Mesh,
}

impl Parts {
    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }

    /// What is added from now on belongs to the object `name`.
    pub(super) fn object(&mut self, name: &str) {
        self.mesh.objects.begin(self.count(), name);
    }

    /// Number of triangles so far.
    pub(super) fn count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Places what `build` adds at `place`.
    pub(super) fn put(&mut self, place: Place, build: impl FnOnce(&mut Parts)) {
        let first = self.mesh.positions.len();
        build(self);
        self.mesh.positions[first..].iter_mut().for_each(|position| *position = place.point(*position));
        self.mesh.normals[first..].iter_mut().for_each(|normal| *normal = place.direction(*normal));
    }

    /// Adds a vertex shared by triangles; a zero `normal` means flat shading.
    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal.normalize_or_zero());
        self.mesh.positions.len() as u32 - 1
    }

    pub(super) fn face(&mut self, corners: [u32; 3], paint: Paint) {
        self.mesh.triangles.push(corners);
        self.mesh.materials.push(paint);
    }

    /// A flat convex polygon as a fan around its first corner.
    pub(super) fn polygon(&mut self, corners: &[Vec3], paint: Paint) {
        let ids: Vec<u32> = corners.iter().map(|&corner| self.vertex(corner, Vec3::ZERO)).collect();
        for pair in ids[1..].windows(2) {
            self.face([ids[0], pair[0], pair[1]], paint);
        }
    }

    /// A box with its lowest corner `min` and highest corner `max`: 12, 10 or 8 triangles.
    pub(super) fn cuboid(&mut self, min: Vec3, max: Vec3, open: Open, paint: Paint) {
        let center = 0.5 * (min + max);
        self.hexahedron(center, 0.5 * (max - min), [Vec3::X, Vec3::Y, Vec3::Z], open, paint);
    }

    /// A square bar from `from` to `to`, with the given `width`, and `height` along the direction closest to up.
    pub(super) fn beam(&mut self, from: Vec3, to: Vec3, width: f32, height: f32, paint: Paint) {
        let along = (to - from).normalize();
        let (side, up) = normal_plane(along);
        let half = 0.5 * Vec3::new(width, height, (to - from).length());
        self.hexahedron(0.5 * (from + to), half, [side, up, along], Open::Nothing, paint);
    }

    /// A [beam](Parts::beam) whose ends are hidden and left open: 8 triangles.
    pub(super) fn bar(&mut self, from: Vec3, to: Vec3, width: f32, height: f32, paint: Paint) {
        let up = (to - from).normalize();
        let (side, across) = normal_plane(up);
        let half = 0.5 * Vec3::new(height, (to - from).length(), width);
        self.hexahedron(0.5 * (from + to), half, [across, up, side], Open::TopAndBottom, paint);
    }

    fn hexahedron(&mut self, center: Vec3, half: Vec3, axes: [Vec3; 3], open: Open, paint: Paint) {
        let corner = |bits: u32| {
            let sign = |bit: u32| if bits >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let [x, y, z] = axes;
            center + x * (sign(0) * half.x) + y * (sign(1) * half.y) + z * (sign(2) * half.z)
        };
        let first = self.mesh.positions.len() as u32;
        for bits in 0..8 {
            self.vertex(corner(bits), Vec3::ZERO);
        }
        const SIDES: [[u32; 4]; 4] = [[4, 5, 7, 6], [1, 0, 2, 3], [5, 1, 3, 7], [0, 4, 6, 2]];
        const TOP: [u32; 4] = [6, 7, 3, 2];
        const BOTTOM: [u32; 4] = [0, 1, 5, 4];
        let caps: &[[u32; 4]] = match open {
            Open::Nothing => &[TOP, BOTTOM],
            Open::Bottom => &[TOP],
            Open::TopAndBottom => &[],
        };
        for [a, b, c, d] in SIDES.iter().chain(caps).map(|side| side.map(|corner| first + corner)) {
            self.face([a, b, c], paint);
            self.face([a, c, d], paint);
        }
    }
}

/// Two unit vectors that span the plane perpendicular to the unit vector `along`: one to the side, one closest to up, such that
/// side × up = along.
pub(super) fn normal_plane(along: Vec3) -> (Vec3, Vec3) {
    let helper = if along.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    let side = helper.cross(along).normalize();
    (side, along.cross(side))
}
