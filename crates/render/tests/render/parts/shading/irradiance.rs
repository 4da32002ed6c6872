//! Closed forms of irradiance against sums in double precision.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use lightmesh_render::internals::shading::{irradiance, nearness};
use lightmesh_scene::{Falloff, Light};

/// Places of a sum along each axis.
const PLACES: u32 = 128;

/// Where a surface point sees the light's centre: from far to nearer than a tenth of a light whose halves are 0.5 long.
const WAYS: [[f64; 3]; 8] = [
    [0.0, 2.0, 0.0],
    [0.3, 1.0, 0.2],
    [0.0, 0.5, 0.0],
    [0.4, 0.25, -0.3],
    [0.1, 0.1, 0.1],
    [0.9, 0.3, 0.1],
    [-0.7, 0.12, 0.4],
    [0.2, -0.3, 0.6],
];
/// Normals: facing the light, aslant, and such that a part of it is below the horizon.
const NORMALS: [[f64; 3]; 6] =
    [[0.0, 1.0, 0.0], [0.3, 0.9, 0.1], [1.0, 0.0, 0.0], [-0.6, 0.3, 0.7], [0.0, 0.05, 1.0], [0.0, -1.0, 0.2]];

/// Directions of all ways with a part of the light above the horizon of all normals.
fn each_place() -> impl Iterator<Item = (DVec3, DVec3)> {
    WAYS.into_iter()
        .flat_map(|way| NORMALS.into_iter().map(move |normal| (DVec3::from(way), DVec3::from(normal).normalize())))
}

/// The mean over a flat light of what its places give to a surface point: cosines over squared distance, over π.
fn mean_of(places: impl Iterator<Item = DVec3>, front: Option<DVec3>, normal: DVec3) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for way in places {
        let square = way.length_squared();
        let direction = way / square.sqrt();
        let emitted = front.map_or(1.0, |front| (-front.dot(direction)).max(0.0));
        sum += normal.dot(direction).max(0.0) * emitted / (PI * square);
        count += 1.0;
    }
    sum / count
}

fn middles() -> impl Iterator<Item = (f64, f64)> {
    let middle = |place: u32| (f64::from(place) + 0.5) / f64::from(PLACES);
    (0..PLACES).flat_map(move |row| (0..PLACES).map(move |column| (middle(row), middle(column))))
}

/// Compares a light with a sum at all places; the largest difference, relative to what the light gives at most there.
fn worst(light: &Light, sum: impl Fn(DVec3, DVec3) -> f64) -> f64 {
    let mut worst = 0.0f64;
    for (way, normal) in each_place() {
        let most = NORMALS.map(|normal| sum(way, DVec3::from(normal).normalize())).into_iter().fold(0.0, f64::max);
        let (found, expected) = (f64::from(irradiance(light, way.as_vec3(), normal.as_vec3())), sum(way, normal));
        if most > 0.0 {
            worst = worst.max((found - expected).abs() / most);
        } else {
            assert_eq!(found, 0.0, "{way}, {normal}");
        }
    }
    worst
}

#[test]
fn rectangles_give_what_their_points_give() {
    let (u, v) = (DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.3));
    let light = Light::rectangle(Vec3::ZERO, u.as_vec3(), v.as_vec3()).unwrap().with_falloff(Falloff::InverseSquare);
    for front in [None, Some(DVec3::NEG_Y), Some(DVec3::Y)] {
        let even = light.clone().with_one_sided(false);
        let light = front.map_or(even, |front| light.clone().with_surface(front.as_vec3()));
        let sum = |way: DVec3, normal: DVec3| {
            mean_of(middles().map(|(x, y)| way + (2.0 * x - 1.0) * u + (2.0 * y - 1.0) * v), front, normal)
        };
        let worst = worst(&light, sum);
        assert!(worst < 2e-3, "{front:?}: {worst}");
    }
}

#[test]
fn discs_give_what_their_points_give() {
    let axis = DVec3::new(0.2, -1.0, 0.1).normalize();
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let light = Light::disk(Vec3::ZERO, axis.as_vec3(), 0.4).unwrap().with_falloff(Falloff::InverseSquare);
    for front in [None, Some(axis), Some(-axis)] {
        let even = light.clone().with_one_sided(false);
        let light = front.map_or(even, |front| light.clone().with_surface(front.as_vec3()));
        let sum = |way: DVec3, normal: DVec3| {
            let place = |(x, y): (f64, f64)| {
                let (sin, cos) = (2.0 * PI * x).sin_cos();
                way + 0.4 * y.sqrt() * (cos * tangent + sin * bitangent)
            };
            mean_of(middles().map(place), front, normal)
        };
        let worst = worst(&light, sum);
        assert!(worst < 5e-3, "{front:?}: {worst}");
    }
}

/// The irradiance of directions within an angle of `way`, of radiance 1.
fn sum_of_cap(way: DVec3, cosine: f64, normal: DVec3) -> f64 {
    let (tangent, bitangent) = way.any_orthonormal_pair();
    let direction = |(x, y): (f64, f64)| {
        let z = cosine + x * (1.0 - cosine);
        let (sin, cos) = (2.0 * PI * y).sin_cos();
        z * way + (1.0 - z * z).sqrt() * (cos * tangent + sin * bitangent)
    };
    let solid = 2.0 * PI * (1.0 - cosine) / f64::from(PLACES * PLACES);
    middles().map(|place| normal.dot(direction(place)).max(0.0)).sum::<f64>() * solid
}

#[test]
fn balls_shine_evenly_from_their_surfaces() {
    let radius = 0.09f32;
    let light = Light::sphere(Vec3::ZERO, radius).unwrap().with_falloff(Falloff::InverseSquare);
    let square = f64::from(radius).powi(2);
    let sum = |way: DVec3, normal: DVec3| {
        let cosine = (1.0 - square / way.length_squared()).sqrt();
        sum_of_cap(way.normalize(), cosine, normal) / (PI * PI * square)
    };
    let worst = worst(&light, sum);
    assert!(worst < 1e-3, "{worst}");
    // From inside, from all sides.
    let inside = irradiance(&light, Vec3::Y * 0.5 * radius, Vec3::Y) * (std::f32::consts::PI * radius).powi(2);
    assert!((inside - std::f32::consts::PI).abs() < 1e-5, "{inside}");
}

#[test]
fn suns_shine_as_strongly_however_wide() {
    for degrees in [4.0f32, 30.0, 60.0, 90.0, 120.0, 150.0, 179.0] {
        let sun = Light::directional(Vec3::NEG_Y).unwrap().with_angle(degrees.to_radians());
        assert_eq!(nearness(&sun, Vec3::Y), 1.0);
        let facing = irradiance(&sun, Vec3::Y, Vec3::Y);
        assert!((facing - 1.0).abs() < 1e-5, "{degrees}°: {facing}");
        let half = 0.5 * f64::from(degrees).to_radians();
        for tilt in [30.0f64, 45.0, 80.0, 100.0, 170.0] {
            let normal = DVec3::new(tilt.to_radians().sin(), tilt.to_radians().cos(), 0.0);
            let expected = sum_of_cap(DVec3::Y, half.cos(), normal) / (PI * half.sin().powi(2));
            let found = f64::from(irradiance(&sun, Vec3::Y, normal.as_vec3()));
            assert!((found - expected).abs() < 1e-3, "{degrees}°, {tilt}°: {found}, not {expected}");
        }
    }
    let sun = Light::directional(Vec3::NEG_Y).unwrap().with_angle(0.0093);
    assert_eq!(nearness(&sun, Vec3::Y), 0.0);
}

#[test]
fn lights_come_near_bit_by_bit() {
    let lamp = Light::sphere(Vec3::ZERO, 1.0).unwrap();
    let far = |light: &Light, distance: f32| nearness(light, distance * Vec3::Z);
    assert!([0.5, 2.0, 20.0].iter().all(|&distance| far(&lamp, distance) == 0.0), "the thesis' lights are points");
    let lamp = lamp.with_falloff(Falloff::InverseSquare);
    let values = [0.0, 2.0, 4.0, 5.0, 7.0, 8.0, 100.0].map(|distance| far(&lamp, distance));
    assert!(values.is_sorted_by(|a, b| a >= b), "{values:?}");
    assert_eq!((values[0], values[2], values[5], values[6]), (1.0, 1.0, 0.0, 0.0));
    assert!(values[3] < 1.0 && values[4] > 0.0);
}
