//! Solids as triangles, in double precision.
//!
//! Boxes and rectangles are exact. Spheres and cylinders are inscribed: every vertex lies on the true surface and has its true
//! normal; with n segments the facets lie up to r (1 − cos(π/n)) inside it, 0.05 % of the radius for 96.
//!
//! A texture image covers every face once, upright seen from outside: each side of a box, the lateral surface of a cylinder and
//! each of its ends, a sphere from its north pole (Y) to its south pole. Where it wraps around, it begins and ends at +X.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3, Vec2, Vec3};

use crate::MeshPart;

/// Default number of segments around a sphere or cylinder.
pub(crate) const DEFAULT_SEGMENTS: u32 = 96;

/// Triangles of one solid, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// Normals by vertex.
    pub normals: Vec<Vec3>,
    /// Three vertices per triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates of the corners of each triangle.
    pub corners: Vec<[Vec2; 3]>,
    /// Texture coordinates by vertex, if requested.
    pub uvs: Vec<Vec2>,
}

impl Shape {
    /// The mesh part for [`SceneBuilder::add`](crate::SceneBuilder::add).
    pub(crate) fn part(&self) -> MeshPart<'_> {
        MeshPart {
            positions: &self.positions,
            normals: &self.normals,
            uvs: &self.uvs,
            triangles: &self.triangles,
            ..Default::default()
        }
    }

    /// The shape with texture coordinates. Vertices with several positions in the image are duplicated.
    pub fn textured(self) -> Shape {
        let mut shape = Shape { corners: self.corners, ..Shape::default() };
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        for (triangle, uvs) in self.triangles.iter().zip(&shape.corners) {
            shape.triangles.push(std::array::from_fn(|corner| {
                let (vertex, uv) = (triangle[corner], uvs[corner]);
                *known.entry((vertex, uv.to_array().map(f32::to_bits))).or_insert_with(|| {
                    shape.positions.push(self.positions[vertex as usize]);
                    shape.normals.extend(self.normals.get(vertex as usize));
                    shape.uvs.push(uv);
                    shape.positions.len() as u32 - 1
                })
            }));
        }
        shape
    }

    fn add(&mut self, triangle: [u32; 3], corners: [Vec2; 3]) {
        self.triangles.push(triangle);
        self.corners.push(corners);
    }

    /// Two triangles; `corners` in order around the border.
    fn add_quad(&mut self, [a, b, c, d]: [u32; 4], [ta, tb, tc, td]: [Vec2; 4]) {
        self.add([a, b, c], [ta, tb, tc]);
        self.add([a, c, d], [ta, tc, td]);
    }

    /// A triangle with a flat surface.
    pub(crate) fn triangle(corners: [DVec3; 3], uvs: [Vec2; 3]) -> Shape {
        Shape { positions: corners.to_vec(), triangles: vec![[0, 1, 2]], corners: vec![uvs], ..Shape::default() }
    }

    /// A parallelogram around `center` with the edges `u` and `v`; its front is the side of u × v.
    pub fn rectangle(center: DVec3, u: DVec3, v: DVec3) -> Shape {
        let corner = |a: f64, b: f64| center + 0.5 * (a * u + b * v);
        let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let mut shape = Shape { positions, ..Shape::default() };
        shape.add_quad([0, 1, 2, 3], [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]);
        shape
    }

    /// A box between two corners.
    pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
        let pick = |bit: usize, low: f64, high: f64| if bit == 0 { low } else { high };
        let corner =
            |i: usize| DVec3::new(pick(i & 1, min.x, max.x), pick(i & 2, min.y, max.y), pick(i & 4, min.z, max.z));
        // Corner i has its x, y and z at max if bit 0, 1 and 2 of i are set.
        const FACES: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut shape = Shape { positions: (0..8).map(corner).collect(), ..Shape::default() };
        for (face, corners) in FACES.iter().enumerate() {
            shape.add_quad(
                *corners,
                corners.map(|i| uv_of_box(face, (i as usize & 1, i as usize >> 1 & 1, i as usize >> 2))),
            );
        }
        shape
    }

    /// A sphere with `segments` triangles around and half as many rings from pole to pole, with poles at the top and bottom (Y).
    pub fn sphere(center: DVec3, radius: f64, segments: u32) -> Shape {
        let rings = (segments / 2).max(2);
        let mut directions = vec![DVec3::Y];
        for ring in 1..rings {
            let (sin, cos) = (PI * f64::from(ring) / f64::from(rings)).sin_cos();
            directions.extend(circle(segments).map(|(x, z)| DVec3::new(sin * x, cos, sin * z)));
        }
        directions.push(DVec3::NEG_Y);

        let at = |ring: u32, segment: u32| 1 + (ring - 1) * segments + segment % segments;
        let last = directions.len() as u32 - 1;
        let uv = |ring: u32, s: f32| Vec2::new(1.0 - s / segments as f32, ring as f32 / rings as f32);
        let mut shape = Shape {
            positions: directions.iter().map(|&direction| center + radius * direction).collect(),
            normals: directions.iter().map(|direction| direction.as_vec3()).collect(),
            ..Shape::default()
        };
        for s in 0..segments {
            let (here, middle, there) = (s as f32, s as f32 + 0.5, s as f32 + 1.0);
            shape.add([0, at(1, s + 1), at(1, s)], [uv(0, middle), uv(1, there), uv(1, here)]);
            for ring in 1..rings - 1 {
                shape.add_quad(
                    [at(ring, s), at(ring, s + 1), at(ring + 1, s + 1), at(ring + 1, s)],
                    [uv(ring, here), uv(ring, there), uv(ring + 1, there), uv(ring + 1, here)],
                );
            }
            let ring = rings - 1;
            shape.add([last, at(ring, s), at(ring, s + 1)], [uv(rings, middle), uv(ring, here), uv(ring, there)]);
        }
        shape
    }

    /// A cylinder from the centre of one end to the centre of the other, which must not coincide; with `caps` its ends are closed.
    pub fn cylinder(base: DVec3, top: DVec3, radius: f64, segments: u32, caps: bool) -> Shape {
        let axis = (top - base).normalize();
        let turn = DQuat::from_rotation_arc(DVec3::Y, axis);
        let spokes: Vec<DVec3> = circle(segments).map(|(x, z)| turn * DVec3::new(x, 0.0, z)).collect();
        let mut shape = Shape::default();
        shape.add_ring(base, radius, &spokes, |spoke| spoke);
        shape.add_ring(top, radius, &spokes, |spoke| spoke);
        for s in 0..segments {
            let next = (s + 1) % segments;
            let [a, b, c, d] = [s, next, segments + next, segments + s];
            let uv = |s: u32, v: f32| Vec2::new(1.0 - s as f32 / segments as f32, v);
            let [ta, tb, tc, td] = [uv(s, 1.0), uv(s + 1, 1.0), uv(s + 1, 0.0), uv(s, 0.0)];
            shape.add([a, c, b], [ta, tc, tb]);
            shape.add([a, d, c], [ta, td, tc]);
        }
        if caps {
            shape.add_cap(base, -axis, radius, &spokes, -1.0);
            shape.add_cap(top, axis, radius, &spokes, 1.0);
        }
        shape
    }

    fn add_ring(&mut self, center: DVec3, radius: f64, spokes: &[DVec3], normal: impl Fn(DVec3) -> DVec3) {
        self.positions.extend(spokes.iter().map(|&spoke| center + radius * spoke));
        self.normals.extend(spokes.iter().map(|&spoke| normal(spoke).as_vec3()));
    }

    /// A fan around the centre of an end. It has its own vertices, as its normals differ from the side's. `upright` is -1 if the
    /// image is seen from below.
    fn add_cap(&mut self, center: DVec3, axis: DVec3, radius: f64, spokes: &[DVec3], upright: f64) {
        let middle = self.positions.len() as u32;
        self.positions.push(center);
        self.normals.push(axis.as_vec3());
        self.add_ring(center, radius, spokes, |_| axis);
        let segments = spokes.len() as u32;
        // The spokes run clockwise seen from where the side's axis points.
        let outward = axis.dot(spokes[0].cross(spokes[1])) > 0.0;
        let rim: Vec<Vec2> = circle(segments)
            .map(|(x, z)| 0.5 * DVec2::new(1.0 + x, 1.0 + upright * z))
            .map(|uv| uv.as_vec2())
            .collect();
        for s in 0..segments {
            let next = (s + 1) % segments;
            let [(a, ta), (b, tb)] = [s, next].map(|s| (middle + 1 + s, rim[s as usize]));
            match outward {
                true => self.add([middle, a, b], [Vec2::splat(0.5), ta, tb]),
                false => self.add([middle, b, a], [Vec2::splat(0.5), tb, ta]),
            }
        }
    }
}

/// Texture coordinates of a box's corner, which is at max where x, y or z is 1, on one of its faces: -X, +X, -Y, +Y, -Z, +Z.
fn uv_of_box(face: usize, (x, y, z): (usize, usize, usize)) -> Vec2 {
    let (u, v) = match face {
        0 => (z, 1 - y),
        1 => (1 - z, 1 - y),
        2 => (x, 1 - z),
        3 => (x, z),
        4 => (1 - x, 1 - y),
        _ => (x, 1 - y),
    };
    Vec2::new(u as f32, v as f32)
}

/// Two directions that span the plane with this unit normal, right-handed with it: the first is horizontal; for a normal along
/// Y it is +X.
pub fn tangents(normal: DVec3) -> (DVec3, DVec3) {
    let u = DVec3::Y.cross(normal).try_normalize().filter(|_| normal.y.abs() < 1.0 - 1e-12).unwrap_or(DVec3::X);
    (u, normal.cross(u))
}

/// Points of the unit circle, evenly spaced, as (x, z).
fn circle(segments: u32) -> impl Iterator<Item = (f64, f64)> {
    (0..segments).map(move |s| {
        let (sin, cos) = (TAU * f64::from(s) / f64::from(segments)).sin_cos();
        (cos, sin)
    })
}
