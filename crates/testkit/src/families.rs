//! Families of shapes of any size, for what must hold however triangles lie: in a row, on top of each other, within each other.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use crate::Random;

/// A shape of any number of triangles.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Its name.
    pub name: &'static str,
    triangle: fn(index: usize, count: usize) -> [DVec3; 3],
}

/// All families.
pub const FAMILIES: [Family; 13] = [
    Family { name: "strip", triangle: strip },
    Family { name: "stairs", triangle: stairs },
    Family { name: "stack", triangle: stack },
    Family { name: "pipe", triangle: pipe },
    Family { name: "nested", triangle: nested },
    Family { name: "growing", triangle: growing },
    Family { name: "coincident", triangle: coincident },
    Family { name: "one box", triangle: one_box },
    Family { name: "fan", triangle: fan },
    Family { name: "needles", triangle: needles },
    Family { name: "grid", triangle: grid },
    Family { name: "random", triangle: random },
    Family { name: "two clusters", triangle: two_clusters },
];

impl Family {
    /// The corners of `count` triangles.
    pub fn triangles(&self, count: usize) -> Vec<[Vec3; 3]> {
        (0..count).map(|index| (self.triangle)(index, count).map(|corner| corner.as_vec3())).collect()
    }
}

/// Half of the parallelogram at `corner` with these edges: the first if `index` is even.
fn half([corner, right, up]: [DVec3; 3], index: usize) -> [DVec3; 3] {
    let far = corner + right + up;
    if index.is_multiple_of(2) { [corner, corner + right, far] } else { [corner, far, corner + up] }
}

/// Unit squares in a row: every box has two neighbours that suit it equally well.
fn strip(index: usize, _: usize) -> [DVec3; 3] {
    half([DVec3::X * (index / 2) as f64, DVec3::X, DVec3::Y], index)
}

/// Treads and risers.
fn stairs(index: usize, _: usize) -> [DVec3; 3] {
    let step = (index / 4) as f64;
    let corner = DVec3::new(step, step, 0.0);
    let up = if index % 4 < 2 { DVec3::Y } else { DVec3::X };
    half([if index % 4 < 2 { corner } else { corner + DVec3::Y }, up, DVec3::Z], index)
}

/// Squares above each other.
fn stack(index: usize, count: usize) -> [DVec3; 3] {
    half([DVec3::Z * (index / 2) as f64 / count as f64, DVec3::X, DVec3::Y], index)
}

/// A long tube of twelve sides.
fn pipe(index: usize, _: usize) -> [DVec3; 3] {
    let (side, ring) = (index / 2 % 12, index / 24);
    let at = |side: usize| DVec3::new(0.0, (TAU * side as f64 / 12.0).cos(), (TAU * side as f64 / 12.0).sin());
    half([at(side) + DVec3::X * ring as f64, at(side + 1) - at(side), DVec3::X], index)
}

/// Right triangles that share a corner and grow evenly: each box holds all before it.
fn nested(index: usize, _: usize) -> [DVec3; 3] {
    let size = (index + 1) as f64;
    [DVec3::ZERO, DVec3::X * size, DVec3::Y * size]
}

/// The same with sizes of which each is a fixed multiple of the one before.
fn growing(index: usize, count: usize) -> [DVec3; 3] {
    let size = 1e6f64.powf(index as f64 / count as f64);
    [DVec3::ZERO, DVec3::X * size, DVec3::Y * size]
}

fn coincident(_: usize, _: usize) -> [DVec3; 3] {
    [DVec3::ZERO, DVec3::X, DVec3::Y]
}

/// Different triangles with the same box.
fn one_box(index: usize, count: usize) -> [DVec3; 3] {
    let share = index as f64 / count as f64;
    [DVec3::ZERO, DVec3::new(share, 1.0, 1.0 - share), DVec3::ONE.with_y(0.0)]
}

/// Triangles around a common corner.
fn fan(index: usize, count: usize) -> [DVec3; 3] {
    let at = |index: usize| {
        DVec3::new((TAU * index as f64 / count as f64).cos(), (TAU * index as f64 / count as f64).sin(), 0.0)
    };
    [DVec3::ZERO, at(index), at(index + 1)]
}

/// Long diagonals next to each other, whose boxes all overlap.
fn needles(index: usize, count: usize) -> [DVec3; 3] {
    let shift = DVec3::X * index as f64 / count as f64;
    [shift, DVec3::ONE + shift, DVec3::new(1.0, 1.0, 1.001) + shift]
}

/// A rolling landscape.
fn grid(index: usize, count: usize) -> [DVec3; 3] {
    let edge = (count as f64 / 2.0).sqrt().ceil() as usize;
    let at = |x: usize, z: usize| DVec3::new(x as f64, (0.7 * x as f64).sin() + (0.9 * z as f64).cos(), z as f64);
    let (x, z) = (index / 2 % edge, index / 2 / edge);
    if index.is_multiple_of(2) {
        [at(x, z), at(x + 1, z), at(x + 1, z + 1)]
    } else {
        [at(x, z), at(x + 1, z + 1), at(x, z + 1)]
    }
}

fn random(index: usize, count: usize) -> [DVec3; 3] {
    let mut random = Random::new(index as u64);
    let (center, size) = (random.in_cube(), (count as f64).cbrt().recip());
    [0; 3].map(|_| center + size * random.in_cube())
}

/// Two small ones a hundred thousand of their sizes apart.
fn two_clusters(index: usize, count: usize) -> [DVec3; 3] {
    random(index, count).map(|corner| if index.is_multiple_of(2) { corner } else { corner + 1e5 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_has_as_many_triangles_as_are_asked_for_and_all_are_proper() {
        for family in FAMILIES {
            let triangles = family.triangles(100);
            assert_eq!(triangles.len(), 100, "{}", family.name);
            let area = |&[a, b, c]: &[Vec3; 3]| (b - a).cross(c - a).length();
            assert!(triangles.iter().all(|triangle| area(triangle) > 0.0), "{}", family.name);
        }
    }
}
