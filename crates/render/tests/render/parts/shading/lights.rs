//! Strengths of lights and the points that represent an area light. Whole images are tested in `tests/render`.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;
use lightmesh_layout::constants::LIGHT_TARGETS;
use lightmesh_render::internals::shading::{LightTargets, cone, strength};
use lightmesh_scene::{Falloff, Light};

fn spot(inner: f32, outer: f32) -> Light {
    Light::spot(Vec3::ZERO, Vec3::NEG_Y, inner, outer).unwrap()
}

/// The unit vector to the spot from a surface `angle` off its axis.
fn towards(angle: f32) -> Vec3 {
    Vec3::new(angle.sin(), angle.cos(), 0.0)
}

#[test]
fn a_cone_is_full_inside_and_nothing_outside() {
    let light = spot(0.3, 0.6);
    for angle in [-0.29, 0.0, 0.29] {
        assert_eq!(cone(&light, towards(angle)), 1.0);
    }
    for angle in [0.601, 1.5, PI] {
        assert_eq!(cone(&light, towards(angle)), 0.0);
    }
    let between: Vec<f32> = (0..10).map(|i| cone(&light, towards(0.31 + 0.03 * i as f32))).collect();
    assert!(between.is_sorted_by(|a, b| a > b), "{between:?}");
}

#[test]
fn a_cone_may_have_no_soft_border() {
    let light = spot(0.5, 0.5);
    assert_eq!((cone(&light, towards(0.49)), cone(&light, towards(0.51))), (1.0, 0.0));
}

#[test]
fn strength_falls_with_the_square_or_not_at_all() {
    let light = |falloff| Light::point(Vec3::ZERO).with_intensity([1.0, 2.0, 4.0]).with_falloff(falloff);
    let plain = strength(&light(Falloff::None), Vec3::Y, 7.0);
    assert_eq!(plain, Vec3::new(1.0, 2.0, 4.0));
    let (near, far) = (light(Falloff::InverseSquare), light(Falloff::InverseSquare));
    let ratio = strength(&near, Vec3::Y, 3.0) / strength(&far, Vec3::Y, 6.0);
    assert!((ratio - 4.0).abs().max_element() < 1e-5, "{ratio}");
    assert!((strength(&near, Vec3::Y, 1.0).x - FRAC_1_PI).abs() < 1e-7);
}

#[test]
fn only_lights_with_a_size_are_spread() {
    let sphere = Light::sphere(Vec3::Y, 0.5).unwrap();
    let targets = LightTargets::new(&vec![spot(0.1, 0.2), sphere].into());
    assert!(targets.points[0].is_empty());
    assert_eq!(targets.points[1].len(), LIGHT_TARGETS as usize);
    assert!(targets.points[1].iter().all(|point| point.distance(Vec3::Y) <= 0.5));
    let mean = targets.points[1].iter().sum::<Vec3>() / LIGHT_TARGETS as f32;
    assert!(mean.distance(Vec3::Y) < 0.1, "{mean}");
}

#[test]
fn a_directional_light_with_an_angle_is_spread_over_its_disk() {
    let sun = Light::directional(Vec3::NEG_Y).unwrap();
    let targets = LightTargets::new(&vec![sun.clone(), sun.with_angle(0.2)].into());
    assert!(targets.points[0].is_empty());
    assert_eq!(targets.points[1].len(), LIGHT_TARGETS as usize);
    for target in &targets.points[1] {
        assert!((target.y - 1.0).abs() < 1e-6 && target.distance(Vec3::Y) < 1.001 * 0.1f32.tan(), "{target}");
    }
}
