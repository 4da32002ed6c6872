//! Building blocks of the built-in scenes: boxes, prisms, tubes, balls, and the list that they are added to.
//!
//! Every object is built around its own zero, Y up, and put in place by [`Parts::put`]. Faces are wound counter-clockwise
//! seen from outside.

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
            emission: Vec3::ZERO,
        });
        self.0.len() as Paint - 1
    }
}

/// Where an object goes: scaled, turned about Y, moved.
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

    /// Turned by `degrees` about Y, from +Z towards +X.
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

/// Faces of a box that [`Parts::cuboid`] leaves out, because nobody can see them.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Open {
    Nothing,
    Bottom,
    TopAndBottom,
}

/// The triangles of a scene while it grows.
#[derive(Default)]
pub(super) struct Parts {
    mesh: Mesh,
}

impl Parts {
    pub(super) fn finish(self) -> Mesh {
        self.mesh
    }

    /// Number of triangles so far.
    pub(super) fn count(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Puts what `build` adds at `place`.
    pub(super) fn put(&mut self, place: Place, build: impl FnOnce(&mut Parts)) {
        let first = self.mesh.positions.len();
        build(self);
        self.mesh.positions[first..].iter_mut().for_each(|position| *position = place.point(*position));
        self.mesh.normals[first..].iter_mut().for_each(|normal| *normal = place.direction(*normal));
    }

    /// Adds a vertex that its triangles share; a zero `normal` shades them flat.
    pub(super) fn vertex(&mut self, position: Vec3, normal: Vec3) -> u32 {
        self.mesh.positions.push(position);
        self.mesh.normals.push(normal.normalize_or_zero());
        self.mesh.positions.len() as u32 - 1
    }

    pub(super) fn face(&mut self, corners: [u32; 3], paint: Paint) {
        self.mesh.triangles.push(corners);
        self.mesh.materials.push(paint);
    }

    /// A flat convex polygon as a fan about its first corner.
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

    /// A square bar from `from` to `to`, `width` across and `height` along the direction nearest to up.
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

    /// A surface of revolution about Y through `profile`, points (radius, height) from bottom to top. A radius of 0 closes the
    /// end in a point.
    pub(super) fn lathe(&mut self, profile: &[Vec2], sides: u32, smooth: bool, paint: Paint) {
        let rings: Vec<Vec<u32>> =
            (0..profile.len()).map(|index| self.lathe_ring(profile, index, sides, smooth)).collect();
        for pair in rings.windows(2) {
            self.band(&pair[0], &pair[1], paint);
        }
    }

    /// A faceted [lathe](Parts::lathe) that stands at `foot`.
    pub(super) fn lathe_at(&mut self, foot: Vec3, profile: &[Vec2], sides: u32, paint: Paint) {
        self.put(Place::at(foot.x, foot.y, foot.z), |parts| parts.lathe(profile, sides, false, paint));
    }

    fn lathe_ring(&mut self, profile: &[Vec2], index: usize, sides: u32, smooth: bool) -> Vec<u32> {
        let Vec2 { x: radius, y: height } = profile[index];
        let slope = profile[(index + 1).min(profile.len() - 1)] - profile[index.saturating_sub(1)];
        let count = if radius == 0.0 { 1 } else { sides };
        (0..count)
            .map(|side| {
                let Vec2 { x, y: z } = around((side as f32 + 0.5) / sides as f32);
                let outward = Vec3::new(x * slope.y, -slope.x, z * slope.y);
                let tip = if radius == 0.0 { Vec3::Y * outward.y } else { outward };
                self.vertex(Vec3::new(x * radius, height, z * radius), if smooth { tip } else { Vec3::ZERO })
            })
            .collect()
    }

    /// Joins two rings of vertices; a ring of one vertex is a tip. Seen from outside with the first ring below, vertices run
    /// to the left.
    fn band(&mut self, below: &[u32], above: &[u32], paint: Paint) {
        let sides = below.len().max(above.len());
        for side in 0..sides {
            let at = |ring: &[u32], index: usize| ring[index % ring.len()];
            let [a, b] = [at(below, side), at(below, side + 1)];
            let [d, c] = [at(above, side), at(above, side + 1)];
            if a != b {
                self.face([a, d, b], paint);
            }
            if c != d {
                self.face([b, d, c], paint);
            }
        }
    }

    /// A round pipe along `path`, with a radius for each of its points; its ends stay open.
    pub(super) fn tube(&mut self, path: &[Vec3], radius: impl Fn(usize) -> f32, sides: u32, paint: Paint) {
        let last = path.len() - 1;
        let tangent = |index: usize| (path[(index + 1).min(last)] - path[index.saturating_sub(1)]).normalize();
        let mut side = normal_plane(tangent(0)).0;
        let mut previous: Option<Vec<u32>> = None;
        for (index, &point) in path.iter().enumerate() {
            let along = tangent(index);
            side = (side - along * side.dot(along)).normalize();
            let across = side.cross(along);
            let ring: Vec<u32> = (0..sides)
                .map(|step| {
                    let circle = around(step as f32 / sides as f32);
                    let normal = side * circle.x + across * circle.y;
                    self.vertex(point + normal * radius(index), normal)
                })
                .collect();
            if let Some(below) = previous.replace(ring.clone()) {
                self.band(&below, &ring, paint);
            }
        }
    }

    /// A straight pipe.
    pub(super) fn rod(&mut self, from: Vec3, to: Vec3, radius: f32, sides: u32, paint: Paint) {
        self.tube(&[from, to], |_| radius, sides, paint);
    }

    /// A flat round lid facing up or, with `up` false, down.
    pub(super) fn disk(&mut self, center: Vec3, radius: f32, sides: u32, up: bool, paint: Paint) {
        let corner = |side: u32| {
            let Vec2 { x, y: z } = around((side as f32 + 0.5) / sides as f32);
            center + Vec3::new(x, 0.0, z) * radius
        };
        let rim: Vec<Vec3> = (0..sides).map(|side| corner(if up { sides - 1 - side } else { side })).collect();
        self.polygon(&rim, paint);
    }

    /// A smooth ball with poles on Y.
    pub(super) fn ball(&mut self, center: Vec3, radius: f32, rings: u32, paint: Paint) {
        self.globe(rings, |direction| (center + radius * direction, direction), paint);
    }

    /// A curved sheet through rows of equally many points, each with its normal.
    pub(super) fn sheet(&mut self, rows: &[Vec<(Vec3, Vec3)>], paint: Paint) {
        let rows: Vec<Vec<u32>> =
            rows.iter().map(|row| row.iter().map(|&(point, normal)| self.vertex(point, normal)).collect()).collect();
        for pair in rows.windows(2) {
            for (low, high) in pair[0].windows(2).zip(pair[1].windows(2)) {
                self.face([low[0], low[1], high[1]], paint);
                self.face([low[0], high[1], high[0]], paint);
            }
        }
    }

    /// A lump: an ellipsoid with poles on Y, its flat facets pushed in or out by the factor that `bulge` returns for each vertex.
    pub(super) fn lump(&mut self, center: Vec3, radii: Vec3, rings: u32, mut bulge: impl FnMut() -> f32, paint: Paint) {
        self.globe(rings, |d| (center + radii * d * bulge(), Vec3::ZERO), paint);
    }

    /// Spans a sphere of unit directions by `rings` bands of `2 rings` sides and takes the vertex of each from `vertex`.
    fn globe(&mut self, rings: u32, mut vertex: impl FnMut(Vec3) -> (Vec3, Vec3), paint: Paint) {
        let mut previous: Option<Vec<u32>> = None;
        for ring in 0..=rings {
            let Vec2 { x: y, y: radius } = around(0.5 - 0.5 * ring as f32 / rings as f32);
            let pole = ring == 0 || ring == rings;
            let count = if pole { 1 } else { 2 * rings };
            let next: Vec<u32> = (0..count)
                .map(|side| {
                    let Vec2 { x, y: z } = around(side as f32 / (2 * rings) as f32);
                    let (position, normal) =
                        vertex(if pole { Vec3::Y * y } else { Vec3::new(x * radius, y, z * radius) });
                    self.vertex(position, normal)
                })
                .collect();
            if let Some(below) = previous.replace(next.clone()) {
                self.band(&below, &next, paint);
            }
        }
    }

    /// A height field over the rectangle from `min` to `max` (x, z) with `cells` cells; smooth.
    pub(super) fn terrain(
        &mut self,
        min: Vec2,
        max: Vec2,
        cells: [u32; 2],
        height: impl Fn(f32, f32) -> f32,
        paint: impl Fn(f32, f32) -> Paint,
    ) {
        let cell = (max - min) / Vec2::new(cells[0] as f32, cells[1] as f32);
        let at = |i: u32, j: u32| min + cell * Vec2::new(i as f32, j as f32);
        let first = self.mesh.positions.len() as u32;
        for (j, i) in (0..=cells[1]).flat_map(|j| (0..=cells[0]).map(move |i| (j, i))) {
            let Vec2 { x, y: z } = at(i, j);
            let rise = |dx: f32, dz: f32| height(x + dx, z + dz) - height(x - dx, z - dz);
            let reach = 0.25 * cell;
            let normal = Vec3::new(-rise(reach.x, 0.0) / reach.x, 2.0, -rise(0.0, reach.y) / reach.y);
            self.vertex(Vec3::new(x, height(x, z), z), normal);
        }
        for (j, i) in (0..cells[1]).flat_map(|j| (0..cells[0]).map(move |i| (j, i))) {
            let center = at(i, j) + 0.5 * cell;
            let paint = paint(center.x, center.y);
            let row = cells[0] + 1;
            let a = first + j * row + i;
            self.face([a, a + row, a + row + 1], paint);
            self.face([a, a + row + 1, a + 1], paint);
        }
    }
}

/// Two unit vectors that span the plane at right angles to the unit vector `along`: one to the side, one nearest to up, such
/// that side × up = along.
fn normal_plane(along: Vec3) -> (Vec3, Vec3) {
    let helper = if along.y.abs() > 0.99 { Vec3::Z } else { Vec3::Y };
    let side = helper.cross(along).normalize();
    (side, along.cross(side))
}

/// The points of a cubic Bézier curve at `count` equal steps of its parameter, ends included.
pub(super) fn bezier(control: [Vec3; 4], count: usize) -> Vec<Vec3> {
    let [a, b, c, d] = control;
    let point = |step: usize| {
        let t = step as f32 / (count - 1) as f32;
        let s = 1.0 - t;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    };
    (0..count).map(point).collect()
}
