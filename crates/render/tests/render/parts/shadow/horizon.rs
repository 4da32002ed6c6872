//! χ of area lights and of lights without an area. Whole images are tested in `tests/render`.

use glam::Vec3;
use lightmesh_render::SurfacePoint;
use lightmesh_render::internals::shadow::above_horizon;
use lightmesh_scene::Light;

#[test]
fn a_light_counts_as_far_as_it_stands_above_the_horizon() {
    let point = SurfacePoint { position: Vec3::ZERO, origin: Vec3::ZERO, normal: Vec3::Y };
    for (light, expected) in [(lamp(0.1), 1.0), (lamp(-0.1), 0.0), (lamp(0.0), 0.0)] {
        assert_eq!(above_horizon(&point, &light, 10.0), expected, "{:?}", light.kind);
    }
    let sun = |y| Light::directional(Vec3::new(0.6, y, 0.0)).unwrap();
    assert_eq!((above_horizon(&point, &sun(-0.8), 10.0), above_horizon(&point, &sun(0.8), 10.0)), (1.0, 0.0));

    // A chord at distance t from the centre of a disk of radius 1 cuts off (acos t − t √(1 − t²)) / π of it.
    let disk = |elevation: f32| {
        let direction = Vec3::new(elevation.cos(), -elevation.sin(), 0.0);
        Light::directional(direction).unwrap().with_angle(10f32.to_radians())
    };
    for degrees in [80.0f32, 6.0, 4.0, 2.0, 0.5, -0.5, -3.0, -6.0] {
        let chord = (-degrees.to_radians().tan() / 5f32.to_radians().tan()).clamp(-1.0, 1.0);
        let expected = (chord.acos() - chord * (1.0 - chord * chord).sqrt()) / std::f32::consts::PI;
        for reach in [0.1, 10.0, 1e6] {
            let found = above_horizon(&point, &disk(degrees.to_radians()), reach);
            assert!((found - expected).abs() < 0.04, "at {degrees}°, {reach}: {found}, not {expected}");
            assert!((5.0 < degrees.abs()) <= (found == expected), "at {degrees}°, {reach}: {found}");
        }
    }

    // A cap of height t of a ball of radius 1 holds t²(3 − t)/4 of it.
    let ball = |height| Light::sphere(Vec3::Y * height, 1.0).unwrap();
    for height in [2.0, 1.0, 0.6, 0.1, -0.1, -0.6, -1.0, -1.1] {
        let cap = (1.0f32 + height).clamp(0.0, 2.0);
        let (found, expected) = (above_horizon(&point, &ball(height), 10.0), 0.25 * cap * cap * (3.0 - cap));
        assert!((found - expected).abs() < 0.04, "at {height}: {found}, not {expected}");
        assert!((0.0 < height.abs() - 1.0) <= (found == expected), "at {height}: {found}");
    }
}

fn lamp(height: f32) -> Light {
    Light::point(Vec3::Y * height)
}
