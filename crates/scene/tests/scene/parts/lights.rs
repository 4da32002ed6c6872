use std::f32::consts::PI;

use glam::Vec3;
use lightmesh_scene::{Bounds, Environment, Falloff, Light, Lights, Surroundings};

#[test]
fn surroundings_replace_suns_and_what_stood_for_them() {
    let sun = || Light::directional(Vec3::NEG_Y).unwrap();
    let mut lights = Lights::from(vec![sun().named("old"), Light::point(Vec3::Y)]);
    (lights.ambient, lights.background) = (Some(Vec3::ONE), Some(Vec3::Z));
    let environment = Environment::new("", [1; 2], vec![[0.25, 0.5, 1.0]], lightmesh_scene::Up::Y);
    lights.surround(Surroundings { environment, sun: Some(sun().named("new")), discs: Vec::new() });
    let names: Vec<_> = lights.iter().map(|light| light.name.as_str()).collect();
    assert_eq!(names, ["new", ""]);
    assert_eq!((lights.ambient, lights.background), (None, None));
    let bounds = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
    assert!((lights.default_ambient(&bounds) - Vec3::new(0.25, 0.5, 1.0)).length() < 1e-4);
}

#[test]
fn the_ambient_term_has_the_unit_of_the_lights() {
    let bounds = Bounds { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let ambient = |lights: Vec<Light>| Lights::from(lights).default_ambient(&bounds);
    let lamp = |distance: f32, candela: f32| {
        let light = Light::point(distance * Vec3::Y).with_intensity(Vec3::splat(candela));
        light.with_falloff(Falloff::InverseSquare)
    };
    assert_eq!(ambient(Vec::new()), Vec3::splat(0.1));
    assert_eq!(ambient(vec![Light::point(Vec3::Y), lamp(2.0, 800.0)]), Vec3::splat(0.1));
    // 800 cd at 2 m are 200 lux, of which a white surface reflects 200 / pi to each side.
    let near = |found: Vec3, expected: f32| (found - expected).abs().max_element() < 1e-5 * expected;
    assert!(near(ambient(vec![lamp(2.0, 800.0)]), 20.0 / PI));
    assert!(near(ambient(vec![lamp(2.0, 800.0), lamp(4.0, 800.0)]), 25.0 / PI));
    let sun = Light::directional(Vec3::NEG_Y).unwrap().with_intensity([1e5; 3]).with_falloff(Falloff::InverseSquare);
    assert!(near(ambient(vec![sun]), 1e4 / PI));
    assert!(ambient(vec![lamp(0.0, 800.0)]).is_finite());
}
