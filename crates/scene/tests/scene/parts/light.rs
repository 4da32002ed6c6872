use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use lightmesh_scene::{Falloff, Light, LightError, LightKind};

#[test]
fn a_light_is_built_in_one_expression() {
    let lamp = Light::point(Vec3::Y).with_intensity([1.0, 2.0, 3.0]).with_spread(0.5).named("lamp");
    assert_eq!(lamp.kind, LightKind::Point { position: Vec3::Y, spread: 0.5 });
    assert_eq!((lamp.name.as_str(), lamp.intensity), ("lamp", Vec3::new(1.0, 2.0, 3.0)));
    let sun = Light::directional(Vec3::new(0.0, -2.0, 0.0)).unwrap().with_falloff(Falloff::InverseSquare);
    let parallel = LightKind::Directional { direction: Vec3::NEG_Y, angle: 0.0 };
    assert_eq!((&sun.kind, sun.falloff), (&parallel, Falloff::InverseSquare));
    assert_eq!(sun.with_angle(0.1).kind, LightKind::Directional { direction: Vec3::NEG_Y, angle: 0.1 });
    let ball = Light::sphere(Vec3::Y, 0.5).unwrap();
    assert_eq!(ball.clone().with_spread(2.0), ball);
    assert_eq!(ball.clone().with_angle(0.1), ball);
    assert_eq!(ball.clone().with_radius(0.1), ball);
    let spot = Light::spot(Vec3::Y, Vec3::X, 0.1, 0.2).unwrap().with_radius(0.5);
    let kind = LightKind::Spot { position: Vec3::Y, direction: Vec3::X, inner: 0.1, outer: 0.2, radius: 0.5 };
    assert_eq!(spot.kind, kind);
}

#[test]
fn area_lights_have_a_size() {
    let sun = |angle| Light::directional(Vec3::NEG_Y).unwrap().with_angle(angle);
    let spot = |radius| Light::spot(Vec3::Y, Vec3::X, 0.1, 0.2).unwrap().with_radius(radius);
    let (ball, disk) = (Light::sphere(Vec3::Y, 0.5).unwrap(), Light::disk(Vec3::Y, Vec3::X, 0.5).unwrap());
    for light in [sun(0.1), sun(1e-40), spot(0.1), ball, disk] {
        assert!(light.has_size(), "{light:?}");
    }
    let points =
        [sun(0.0), Light::point(Vec3::Y).with_spread(0.5), spot(0.0), spot(-0.1), spot(f32::NAN), spot(f32::INFINITY)];
    for light in points {
        assert!(!light.has_size(), "{light:?}");
    }
}

#[test]
fn an_angle_without_sense_becomes_the_nearest_with_some() {
    let largest = 179f64.to_radians() as f32;
    assert!(largest < std::f32::consts::PI);
    let cases = [
        (-0.1, 0.0),
        (f32::NAN, 0.0),
        (f32::NEG_INFINITY, 0.0),
        (0.0093, 0.0093),
        (largest, largest),
        (std::f32::consts::PI, largest),
        (f32::INFINITY, largest),
    ];
    for (radians, expected) in cases {
        let light = Light::directional(Vec3::NEG_Y).unwrap().with_angle(radians);
        assert_eq!(light.kind, LightKind::Directional { direction: Vec3::NEG_Y, angle: expected }, "{radians}");
    }
}

#[test]
fn shapes_without_sense_are_refused() {
    let message = |light: Result<Light, LightError>| light.unwrap_err().to_string();
    assert!(message(Light::directional(Vec3::ZERO)).contains("directional light cannot have the direction [0, 0, 0]"));
    assert!(message(Light::disk(Vec3::Y, Vec3::NAN, 1.0)).contains("normal"));
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(message(Light::sphere(Vec3::Y, radius)).contains(&format!("the radius {radius}: give")));
        assert!(Light::disk(Vec3::Y, Vec3::Y, radius).is_err());
    }
    for (inner, outer) in [(0.5, 0.4), (-0.1, 0.4), (0.0, 0.0), (0.0, 1.6), (f32::NAN, 0.4)] {
        assert!(message(Light::spot(Vec3::Y, Vec3::X, inner, outer)).contains("radians"), "{inner} {outer}");
    }
    assert!(Light::spot(Vec3::Y, Vec3::X, 0.0, FRAC_PI_2).is_ok());
    assert!(message(Light::rectangle(Vec3::Y, Vec3::X, 2.0 * Vec3::X)).contains("span an area"));
    assert!(message(Light::rectangle(Vec3::Y, Vec3::X, Vec3::ONE)).contains("right angle"));
    assert!(Light::rectangle(Vec3::Y, Vec3::X, 3.0 * Vec3::Z).is_ok());
}
