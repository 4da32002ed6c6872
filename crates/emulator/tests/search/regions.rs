//! Regions, and which points lie in them, in double precision.

use std::collections::BTreeSet;

use glam::{DVec3, Vec3};
use lightmesh_render::accel::Triangle;
use lightmesh_scene::Bounds;
use lightmesh_testkit::Random;

use crate::triangles::cube;

/// What a region is built from.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub(crate) shape: RegionShape,
    pub(crate) origins: Bounds,
    /// Points of `origins` with their normals.
    pub(crate) points: Vec<(Vec3, Vec3)>,
    pub(crate) slack: f32,
    /// Whether their planes cut anything off: more than four normals are not distinguished.
    pub(crate) cut: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum RegionShape {
    Box,
    Near(f32),
    Shaft(Bounds),
}

fn pick<T: Copy>(random: &mut Random, from: &[T]) -> T {
    from[(random.unit() * from.len() as f64) as usize]
}

/// A box around a point; some boxes are flat.
fn around(center: Vec3, random: &mut Random) -> Bounds {
    let flat = pick(random, &[Vec3::ONE, Vec3::ONE, Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    let half = cube(random).abs() * pick(random, &[0.01, 0.1, 1.0]) * flat;
    Bounds { min: center - half, max: center + half }
}

/// A region not far from a point.
pub(crate) fn asked(near: Vec3, random: &mut Random) -> Asked {
    let center = near + cube(random) * pick(random, &[0.0, 0.3, 2.0]);
    let origins = around(center, random);
    let shape = match pick(random, &[0, 1, 2]) {
        0 => RegionShape::Box,
        1 => RegionShape::Near(pick(random, &[0.0, 1e-3, 0.2, 1.0, 4.0])),
        _ => {
            let away = pick(random, &[Vec3::ONE, Vec3::ONE, Vec3::X, Vec3::new(0.0, 1.0, 1.0), Vec3::ZERO]);
            let center = center + cube(random) * away * pick(random, &[1.0, 5.0, 20.0]);
            RegionShape::Shaft(around(center, random))
        }
    };
    let normals = [(); 5].map(|()| {
        let slanted = cube(random).normalize_or(Vec3::Z);
        pick(random, &[slanted, Vec3::Y, Vec3::NEG_X])
    });
    let (count, kinds) = (pick(random, &[0, 0, 1, 4, 20]), pick(random, &[1, 2, 5]));
    let points: Vec<(Vec3, Vec3)> = (0..count)
        .map(|_| {
            let share = 0.5 * (cube(random) + 1.0);
            let point = (origins.min + share * origins.extent()).clamp(origins.min, origins.max);
            (point, pick(random, &normals[..kinds]))
        })
        .collect();
    let distinct: BTreeSet<_> = points.iter().map(|(_, normal)| normal.to_array().map(f32::to_bits)).collect();
    Asked { shape, origins, points, slack: pick(random, &[0.0, 1e-3]), cut: (1..=4).contains(&distinct.len()) }
}

impl Asked {
    /// Whether one of several points of a triangle lies within.
    pub(crate) fn holds_a_point_of(&self, triangle: &Triangle, random: &mut Random) -> bool {
        let [a, b, c] = triangle.corners().map(Vec3::as_dvec3);
        (0..200).any(|number| {
            let (u, v) = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].get(number).copied().unwrap_or_else(|| {
                let (u, v) = (random.unit(), random.unit());
                if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) }
            });
            self.holds(a + u * (b - a) + v * (c - a))
        })
    }

    fn holds(&self, point: DVec3) -> bool {
        let [min, max] = [self.origins.min, self.origins.max].map(Vec3::as_dvec3);
        let held = match self.shape {
            RegionShape::Box => point.cmpge(min).all() && point.cmple(max).all(),
            RegionShape::Near(reach) => {
                (min - point).max(point - max).max(DVec3::ZERO).length_squared() <= f64::from(reach).powi(2)
            }
            RegionShape::Shaft(emitter) => {
                shaft_holds([min, max], [emitter.min.as_dvec3(), emitter.max.as_dvec3()], point)
            }
        };
        let is_above =
            |&(from, normal): &(Vec3, Vec3)| (point - from.as_dvec3()).dot(normal.as_dvec3()) >= -f64::from(self.slack);
        held && (!self.cut || self.points.is_empty() || self.points.iter().any(is_above))
    }
}

/// Whether a box, moving into another, ever holds a point.
fn shaft_holds(from: [DVec3; 2], to: [DVec3; 2], point: DVec3) -> bool {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for axis in 0..3 {
        // start + t · way <= 0, for the lower face and, mirrored, for the upper one.
        let faces = [
            (from[0][axis] - point[axis], to[0][axis] - from[0][axis]),
            (point[axis] - from[1][axis], from[1][axis] - to[1][axis]),
        ];
        for (start, way) in faces {
            match way {
                way if way > 0.0 => last = last.min(-start / way),
                way if way < 0.0 => first = first.max(-start / way),
                _ if start > 0.0 => return false,
                _ => {}
            }
        }
    }
    first <= last
}
