//! χ of lights with and without a size. Whole pictures are judged in `tests/render`.

use glam::Vec3;
use lightmesh_scene::{Light, LightKind};

use super::faces;
use crate::surface::SurfacePoint;

#[test]
fn a_light_faces_a_surface_that_any_part_of_it_is_over() {
    let point = SurfacePoint { position: Vec3::ZERO, origin: Vec3::ZERO, normal: Vec3::Y };
    let ball = |height| Light { kind: LightKind::Sphere { position: Vec3::Y * height, radius: 1.0 }, ..lamp(0.0) };
    let cases = [(lamp(0.1), true), (lamp(-0.1), false), (lamp(0.0), false)];
    let balls = [(ball(2.0), true), (ball(0.1), true), (ball(-0.1), true), (ball(-1.1), false)];
    for (light, expected) in cases.into_iter().chain(balls) {
        assert_eq!(faces(&point, &light, 10.0), expected, "{:?}", light.kind);
    }
    let sun = |y| Light { kind: LightKind::Directional { direction: Vec3::new(0.6, y, 0.0) }, ..lamp(0.0) };
    assert!(faces(&point, &sun(-0.8), 10.0) && !faces(&point, &sun(0.8), 10.0));
}

fn lamp(height: f32) -> Light {
    Light::point(Vec3::Y * height, Vec3::ONE)
}
