use super::*;

#[test]
fn a_light_is_built_in_one_expression() {
    let lamp = Light::point(Vec3::Y).with_intensity([1.0, 2.0, 3.0]).with_spread(0.5).named("lamp");
    assert_eq!(lamp.kind, LightKind::Point { position: Vec3::Y, spread: 0.5 });
    assert_eq!((lamp.name.as_str(), lamp.intensity), ("lamp", Vec3::new(1.0, 2.0, 3.0)));
    let sun = Light::directional(Vec3::new(0.0, -2.0, 0.0)).unwrap().with_falloff(Falloff::InverseSquare);
    assert_eq!((sun.kind, sun.falloff), (LightKind::Directional { direction: Vec3::NEG_Y }, Falloff::InverseSquare));
    let ball = Light::sphere(Vec3::Y, 0.5).unwrap();
    assert_eq!(ball.clone().with_spread(2.0), ball);
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
