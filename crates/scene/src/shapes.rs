//! Solids as triangles, in double precision.
//!
//! Boxes and rectangles are exact. Spheres and cylinders are inscribed: every vertex lies on the true surface and carries
//! its true normal; with n segments the flats lie up to r (1 − cos(π/n)) inside it, 0.05 % of the radius for 96.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3, Vec3};

use crate::MeshPart;

/// Segments around a sphere or cylinder where nothing is said.
pub(crate) const DEFAULT_SEGMENTS: u32 = 96;

/// Triangles of one solid, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    positions: Vec<DVec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// For [`SceneBuilder::add`](crate::SceneBuilder::add).
    pub(crate) fn part(&self) -> MeshPart<'_> {
        MeshPart {
            positions: &self.positions,
            normals: &self.normals,
            triangles: &self.triangles,
            ..Default::default()
        }
    }

    /// A triangle with a flat surface.
    pub(crate) fn triangle(corners: [DVec3; 3]) -> Shape {
        Shape { positions: corners.to_vec(), normals: Vec::new(), triangles: vec![[0, 1, 2]] }
    }

    /// A parallelogram around `center` with the edges `u` and `v`; its front is the side of u × v.
    pub(crate) fn rectangle(center: DVec3, u: DVec3, v: DVec3) -> Shape {
        let corner = |a: f64, b: f64| center + 0.5 * (a * u + b * v);
        let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        Shape { positions, normals: Vec::new(), triangles: vec![[0, 1, 2], [0, 2, 3]] }
    }

    /// A box between two corners.
    pub(crate) fn cuboid(min: DVec3, max: DVec3) -> Shape {
        let pick = |bit: usize, low: f64, high: f64| if bit == 0 { low } else { high };
        let corner =
            |i: usize| DVec3::new(pick(i & 1, min.x, max.x), pick(i & 2, min.y, max.y), pick(i & 4, min.z, max.z));
        // Corner i has its x, y and z at max where bit 0, 1 and 2 of i are set.
        const FACES: [[u32; 4]; 6] =
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Shape {
            positions: (0..8).map(corner).collect(),
            normals: Vec::new(),
            triangles: FACES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        }
    }

    /// A sphere with `segments` triangles around and half as many rings from pole to pole, poles up and down (Y).
    pub(crate) fn sphere(center: DVec3, radius: f64, segments: u32) -> Shape {
        let rings = (segments / 2).max(2);
        let mut directions = vec![DVec3::Y];
        for ring in 1..rings {
            let (sin, cos) = (PI * f64::from(ring) / f64::from(rings)).sin_cos();
            directions.extend(circle(segments).map(|(x, z)| DVec3::new(sin * x, cos, sin * z)));
        }
        directions.push(DVec3::NEG_Y);

        let at = |ring: u32, segment: u32| 1 + (ring - 1) * segments + segment % segments;
        let last = directions.len() as u32 - 1;
        let mut triangles = Vec::with_capacity(2 * (segments * (rings - 1)) as usize);
        for s in 0..segments {
            triangles.push([0, at(1, s + 1), at(1, s)]);
            for ring in 1..rings - 1 {
                let [a, b, c, d] = [at(ring, s), at(ring, s + 1), at(ring + 1, s + 1), at(ring + 1, s)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
            triangles.push([last, at(rings - 1, s), at(rings - 1, s + 1)]);
        }
        Shape {
            positions: directions.iter().map(|&direction| center + radius * direction).collect(),
            normals: directions.iter().map(|direction| direction.as_vec3()).collect(),
            triangles,
        }
    }

    /// A cylinder from the middle of one end to the middle of the other, which must not coincide; with `caps` its ends are
    /// closed.
    pub(crate) fn cylinder(base: DVec3, top: DVec3, radius: f64, segments: u32, caps: bool) -> Shape {
        let axis = (top - base).normalize();
        let turn = DQuat::from_rotation_arc(DVec3::Y, axis);
        let spokes: Vec<DVec3> = circle(segments).map(|(x, z)| turn * DVec3::new(x, 0.0, z)).collect();
        let mut shape = Shape::default();
        shape.add_ring(base, radius, &spokes, |spoke| spoke);
        shape.add_ring(top, radius, &spokes, |spoke| spoke);
        for s in 0..segments {
            let next = (s + 1) % segments;
            let [a, b, c, d] = [s, next, segments + next, segments + s];
            shape.triangles.extend([[a, c, b], [a, d, c]]);
        }
        if caps {
            shape.add_cap(base, -axis, radius, &spokes);
            shape.add_cap(top, axis, radius, &spokes);
        }
        shape
    }

    fn add_ring(&mut self, center: DVec3, radius: f64, spokes: &[DVec3], normal: impl Fn(DVec3) -> DVec3) {
        self.positions.extend(spokes.iter().map(|&spoke| center + radius * spoke));
        self.normals.extend(spokes.iter().map(|&spoke| normal(spoke).as_vec3()));
    }

    /// A fan around the middle of an end. It has vertices of its own, as its normals differ from the side's.
    fn add_cap(&mut self, center: DVec3, axis: DVec3, radius: f64, spokes: &[DVec3]) {
        let middle = self.positions.len() as u32;
        self.positions.push(center);
        self.normals.push(axis.as_vec3());
        self.add_ring(center, radius, spokes, |_| axis);
        let segments = spokes.len() as u32;
        // The spokes run clockwise seen from where the side's axis points.
        let outward = axis.dot(spokes[0].cross(spokes[1])) > 0.0;
        self.triangles.extend((0..segments).map(|s| {
            let (a, b) = (middle + 1 + s, middle + 1 + (s + 1) % segments);
            if outward { [middle, a, b] } else { [middle, b, a] }
        }));
    }
}

/// Two directions that span the plane with this unit normal, right-handed with it: the first is horizontal; for a normal along
/// Y it is +X.
pub(crate) fn tangents(normal: DVec3) -> (DVec3, DVec3) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the signed volume, and whether every directed edge meets its opposite exactly once.
    fn volume_and_closed(shape: &Shape) -> (f64, bool) {
        use std::collections::HashSet;
        // Vertices are told apart by place, as caps have their own.
        let key = |v: u32| shape.positions[v as usize].to_array().map(|x| (x * 1e9).round() as i64);
        let mut edges = HashSet::new();
        let mut volume = 0.0;
        for &[a, b, c] in &shape.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                assert!(edges.insert((key(from), key(to))), "an edge is used twice the same way");
            }
            let [a, b, c] = [a, b, c].map(|v| shape.positions[v as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        (volume, edges.iter().all(|&(from, to)| edges.contains(&(to, from))))
    }

    #[test]
    fn a_box_has_its_volume_outside_out() {
        let (volume, closed) = volume_and_closed(&Shape::cuboid(DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 4.0, 6.0)));
        assert!(closed);
        assert!((volume - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_sphere_is_closed_and_its_vertices_lie_on_it() {
        let center = DVec3::new(3.0, -1.0, 2.0);
        let shape = Shape::sphere(center, 2.0, 96);
        let (volume, closed) = volume_and_closed(&shape);
        assert!(closed);
        assert!((volume / (4.0 / 3.0 * PI * 8.0) - 1.0).abs() < 2e-3, "{volume}");
        for (position, normal) in shape.positions.iter().zip(&shape.normals) {
            assert!((position.distance(center) - 2.0).abs() < 1e-12);
            assert!(((*position - center) / 2.0 - normal.as_dvec3()).length() < 1e-7);
        }
    }

    #[test]
    fn a_cylinder_is_closed_by_its_caps_only() {
        let [base, top] = [DVec3::new(1.0, 0.0, 2.0), DVec3::new(1.0, 3.0, 6.0)];
        let (volume, closed) = volume_and_closed(&Shape::cylinder(base, top, 0.5, 96, true));
        assert!(closed);
        assert!((volume / (PI * 0.25 * 5.0) - 1.0).abs() < 1e-3, "{volume}");
        assert!(!volume_and_closed(&Shape::cylinder(base, top, 0.5, 96, false)).1);
    }

    #[test]
    fn the_smallest_solids_are_closed_too() {
        assert!(volume_and_closed(&Shape::sphere(DVec3::ZERO, 1.0, 3)).1);
        assert!(volume_and_closed(&Shape::cylinder(DVec3::Y, DVec3::NEG_Y, 1.0, 3, true)).1);
    }

    #[test]
    fn normals_of_a_cylinder_agree_with_its_triangles() {
        let shape = Shape::cylinder(DVec3::ZERO, DVec3::new(1.0, -2.0, 0.5), 1.0, 8, true);
        for triangle in &shape.triangles {
            let [a, b, c] = triangle.map(|v| shape.positions[v as usize]);
            let face = (b - a).cross(c - a).normalize();
            assert!(triangle.iter().all(|&v| face.dot(shape.normals[v as usize].as_dvec3()) > 0.9));
        }
    }

    #[test]
    fn a_rectangle_faces_along_the_cross_of_its_edges() {
        for normal in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::Z, DVec3::new(1.0, 2.0, -1.0).normalize()] {
            let (u, v) = tangents(normal);
            assert!((u.cross(v) - normal).length() < 1e-12, "{normal}");
            let shape = Shape::rectangle(DVec3::ONE, 2.0 * u, 4.0 * v);
            let [a, b, c] = shape.triangles[0].map(|v| shape.positions[v as usize]);
            assert!(((b - a).cross(c - a) / 8.0 - normal).length() < 1e-12);
        }
    }
}
