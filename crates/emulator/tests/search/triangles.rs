//! Triangles that are hard to search.

use glam::Vec3;
use lightmesh_testkit::Random;

/// Kinds of scenes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    Empty,
    Soup,
    /// Triangles of sizes from 1e-3 to 1e2 mixed.
    Scales,
    /// A slanted strip of triangles that share edges.
    Strip,
    /// All triangles in one axis-aligned plane.
    Flat,
    /// A few, each many times.
    Coincident,
    /// A soup far from the origin of coordinates.
    Far,
}

pub(crate) const ALL: [Kind; 7] =
    [Kind::Soup, Kind::Scales, Kind::Strip, Kind::Flat, Kind::Coincident, Kind::Far, Kind::Empty];

/// The corners of such triangles.
pub(crate) fn triangles(kind: Kind, random: &mut Random) -> Vec<[Vec3; 3]> {
    let soup = |random: &mut Random, count, size: fn(&mut Random) -> f32| -> Vec<[Vec3; 3]> {
        let triangle = |_| {
            let (center, size) = (3.0 * cube(random), size(random));
            [(); 3].map(|()| center + size * cube(random))
        };
        (0..count).map(triangle).collect()
    };
    match kind {
        Kind::Empty => Vec::new(),
        Kind::Soup => soup(random, 120, |_| 0.5),
        Kind::Scales => soup(random, 80, |random| 10f32.powf(random.unit() as f32 * 5.0 - 3.0)),
        Kind::Strip => {
            let (onward, aside) = (0.2 * cube(random), 0.3 * cube(random));
            let at = |place: i32| (place - 40) as f32 * onward + if place % 2 == 0 { aside } else { -aside };
            (0..80).map(|place| [at(place), at(place + 1), at(place + 2)]).collect()
        }
        Kind::Flat => {
            let axis = (3.0 * random.unit()) as usize;
            let mut all = soup(random, 60, |_| 0.6);
            all.as_flattened_mut().iter_mut().for_each(|corner| corner[axis] = -7.3);
            all
        }
        Kind::Coincident => soup(random, 4, |_| 1.0).into_iter().flat_map(|corners| vec![corners; 40]).collect(),
        Kind::Far => {
            let offset = Vec3::new(1e6, -1e6, 5e5);
            soup(random, 90, |_| 0.7).into_iter().map(|corners| corners.map(|corner| corner + offset)).collect()
        }
    }
}

/// A point of the cube [-1, 1)³.
pub(crate) fn cube(random: &mut Random) -> Vec3 {
    random.in_cube().as_vec3()
}
