//! Cameras and lights.

use glam::{Vec2, Vec3};
use lightmesh_scene::{Falloff, Fov, LightKind, Projection};
use serde_json::{Value, json};

use super::*;

#[test]
fn cameras_and_lights_follow_their_nodes() {
    let scene = open(&furnished());
    let [top, plan] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!((top.name.as_str(), top.position), ("top", Vec3::new(0.0, 5.0, 0.0)));
    assert!(top.direction.distance(Vec3::NEG_Y) < 1e-6 && top.up.distance(Vec3::NEG_Z) < 1e-6, "{top:?}");
    assert_eq!(top.projection, Projection::Perspective(Fov::Vertical(90.0)));
    assert_eq!((plan.direction, plan.projection), (Vec3::NEG_Z, Projection::Orthographic { height: 4.0 }));

    let position = Vec3::new(1.0, 2.0, 3.0);
    let [point, sun, spot] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
    assert_eq!(point.kind, LightKind::Point { position, spread: 0.0 });
    assert_eq!(point.intensity, Vec3::new(40.0, 20.0, 10.0));
    let LightKind::Directional { direction, angle } = sun.kind else { panic!("{sun:?}") };
    assert!(direction.distance(Vec3::NEG_Y) < 1e-6 && angle == 0.0);
    assert_eq!(spot.kind, LightKind::Spot { position, direction: Vec3::NEG_Z, inner: 0.25, outer: 0.5, radius: 0.0 });
}

#[test]
fn cameras_and_lights_that_say_too_little_are_refused_or_completed() {
    let mut document = furnished();
    document["cameras"][0].as_object_mut().unwrap().remove("perspective");
    assert!(error(&document).contains("; "));
    let mut document = furnished();
    document["cameras"][1]["orthographic"]["ymag"] = json!(0);
    assert!(error(&document).contains("camera 1 has ymag = 0"), "{}", error(&document));
    let mut document = furnished();
    document["extensions"]["KHR_lights_punctual"]["lights"][2]["spot"]["innerConeAngle"] = json!(2);
    assert!(error(&document).contains("light 2 has a cone"), "{}", error(&document));
}

fn lights(document: &mut Value) -> &mut Value {
    &mut document["extensions"]["KHR_lights_punctual"]["lights"]
}

#[test]
fn a_camera_needs_neither_aspect_nor_far_plane() {
    let mut document = furnished();
    document["cameras"][0]["perspective"] = json!({"yfov": 1.0, "aspectRatio": 0.5, "znear": 5});
    let camera = &open(&document).cameras[0];
    assert_eq!(camera.projection, Projection::Perspective(Fov::Vertical(1f64.to_degrees() as f32)));
}

#[test]
fn a_camera_behind_its_picture_is_set_right() {
    let mut document = furnished();
    document["cameras"][1]["orthographic"]["ymag"] = json!(-2);
    assert_eq!(open(&document).cameras[1].projection, Projection::Orthographic { height: 4.0 });
}

#[test]
fn cameras_may_have_a_shift() {
    let mut document = furnished();
    document["cameras"][0]["extras"] = json!({"lightmesh": {"shift": [0.25, -0.5]}});
    document["cameras"][1]["extras"] = json!({"lightmesh": {"shift": [0, 1]}});
    let [top, plan] = &open(&document).cameras[..] else { panic!() };
    assert_eq!((top.shift, plan.shift), (Vec2::new(0.25, -0.5), Vec2::Y));
    assert_eq!(top.projection, Projection::Perspective(Fov::Vertical(90.0)));
    for shift in [1001.0, -1e300] {
        document["cameras"][1]["extras"]["lightmesh"]["shift"][0] = json!(shift);
        assert!(error(&document).contains("camera 1 has extras.lightmesh.shift = ["), "{}", error(&document));
    }
}

/// What other programs write is for their depth buffers.
#[test]
fn clip_planes_are_those_of_the_extras() {
    let mut document = furnished();
    document["cameras"][0]["perspective"]["znear"] = json!(2.5);
    document["cameras"][0]["perspective"]["zfar"] = json!(3.5);
    document["cameras"][1]["extras"] = json!({"lightmesh": {"near": 0.5, "far": 9.0}});
    let [top, plan] = &open(&document).cameras[..] else { panic!() };
    assert_eq!([[top.near, top.far], [plan.near, plan.far]], [[0.0, f32::INFINITY], [0.5, 9.0]]);
    for (near, far) in [(-1.0, 9.0), (9.0, 9.0), (9.5, 9.0)] {
        document["cameras"][1]["extras"]["lightmesh"] = json!({"near": near, "far": far});
        assert!(error(&document).contains("camera 1 has extras.lightmesh.near and far = ["), "{}", error(&document));
    }
}

#[test]
fn angles_that_no_camera_has_are_refused() {
    for yfov in [0.0, -1.0, 3.2, 1e300] {
        let mut document = furnished();
        document["cameras"][0]["perspective"]["yfov"] = json!(yfov);
        assert!(error(&document).contains("camera 0 has yfov = "), "{yfov}");
    }
}

#[test]
fn cameras_and_lights_that_are_not_there_are_named() {
    let mut document = furnished();
    document["nodes"][1]["camera"] = json!(7);
    assert!(error(&document).contains("there is no camera 7"));
    let mut document = furnished();
    document["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = json!(3);
    assert!(error(&document).contains("there is no light 3"));
}

#[test]
fn an_extension_that_is_named_without_lights_is_nothing() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    let scene = open(&document);
    assert!(scene.lights.is_empty() && scene.warnings.is_empty(), "{:?}", scene.warnings);
    document["extensions"] = json!({"KHR_lights_punctual": {}});
    assert!(open(&document).lights.is_empty());
}

#[test]
fn a_light_that_says_nothing_is_white_and_one_candela() {
    let mut document = furnished();
    *lights(&mut document) = json!([{"type": "point"}, {"type": "directional"}, {"type": "spot"}]);
    let scene = open(&document);
    assert!(scene.lights.iter().all(|light| light.intensity == Vec3::ONE && light.falloff == Falloff::InverseSquare));
    let LightKind::Spot { inner, outer, .. } = scene.lights[2].kind else { panic!("{:?}", scene.lights) };
    assert_eq!((inner, outer), (0.0, std::f32::consts::FRAC_PI_4));
}

#[test]
fn lights_keep_their_ratio() {
    let mut document = furnished();
    lights(&mut document)[0]["intensity"] = json!(1e9);
    lights(&mut document)[1]["intensity"] = json!(120_000);
    let scene = open(&document);
    assert_eq!(scene.lights[0].intensity, Vec3::new(1e9, 5e8, 2.5e8));
    assert_eq!(scene.lights[1].intensity, Vec3::splat(120_000.0));
}

#[test]
fn a_light_of_an_unknown_type_is_counted() {
    let mut document = furnished();
    lights(&mut document)[0]["type"] = json!("area");
    assert_eq!(open(&document).lights.len(), 2);
    assert!(warnings(&document).contains("1 light of an unknown type: ignored"));
}

#[test]
fn a_directional_light_may_have_an_angle() {
    let largest = 179f64.to_radians() as f32;
    for (written, expected) in [(0.1, 0.1), (-1.0, 0.0), (7.0, largest), (1e300, largest)] {
        let mut document = furnished();
        lights(&mut document)[1]["extras"] = json!({"lightmesh": {"angle": written}});
        let sun = &open(&document).lights[1];
        assert!(matches!(sun.kind, LightKind::Directional { angle, .. } if angle == expected), "{written}: {sun:?}");
    }
}

#[test]
fn a_spot_may_have_a_radius() {
    for (written, expected) in [(0.1, 0.3), (0.0, 0.0), (-1.0, 0.0), (1e300, 0.0)] {
        let mut document = furnished();
        lights(&mut document)[2]["extras"] = json!({"lightmesh": {"radius": written}});
        let spot = document["nodes"].as_array_mut().unwrap().iter_mut();
        let is_spot = |node: &&mut Value| node["extensions"]["KHR_lights_punctual"]["light"] == json!(2);
        spot.filter(is_spot).for_each(|node| node["scale"] = json!([3, 3, 3]));
        let spot = &open(&document).lights[2];
        let LightKind::Spot { radius, .. } = spot.kind else { panic!("{spot:?}") };
        assert!((radius - expected).abs() < 1e-6, "{written}: {spot:?}");
    }
}

#[test]
fn light_that_takes_away_is_refused() {
    for (key, value) in [("intensity", json!(-1)), ("color", json!([1, -0.5, 1])), ("intensity", json!(1e300))] {
        let mut document = furnished();
        lights(&mut document)[0][key] = value;
        assert!(error(&document).contains("light 0 has the intensity"), "{}", error(&document));
    }
}

#[test]
fn a_camera_or_a_sun_in_a_node_of_no_size_is_refused() {
    for node in [1, 4] {
        let mut document = furnished();
        document["nodes"][node]["scale"] = json!([0, 0, 0]);
        assert!(error(&document).contains(&format!("node {node} has a camera or light but no orientation")));
    }
}

#[test]
fn nothing_is_named_after_an_empty_name() {
    let mut document = furnished();
    document["cameras"][0]["name"] = json!("");
    assert_eq!(open(&document).cameras[0].name, "top");
}
