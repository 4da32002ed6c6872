//! Motion, skeletons and morph targets.

use glam::{DVec3, Vec3};
use lightmesh_scene::{LightKind, LoadError};

use super::*;

/// Adds keys of node `node` at 0 s and 2 s.
pub(super) fn animate(document: &mut Value, name: &str, node: usize, path: &str, values: &[f32], interpolation: &str) {
    let times = add_accessor(document, &bytes_of(&[0.0, 2.0]), 5126, "SCALAR", 2);
    let parts = if interpolation == "CUBICSPLINE" { 6 } else { 2 };
    let (kind, count) = match path {
        "rotation" => ("VEC4", parts),
        "weights" => ("SCALAR", values.len()),
        _ => ("VEC3", parts),
    };
    let output = add_accessor(document, &bytes_of(values), 5126, kind, count);
    let animation = json!({
        "name": name,
        "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
        "samplers": [{"input": times, "output": output, "interpolation": interpolation}],
    });
    match document["animations"].as_array_mut() {
        Some(animations) => animations.push(animation),
        None => document["animations"] = json!([animation]),
    }
}

fn first(scene: &Scene) -> Vec3 {
    scene.geometry.mesh.corners(0)[0]
}

#[test]
fn nodes_move_by_their_keys() {
    let mut document = triangle();
    document["nodes"] = json!([{"children": [1], "translation": [0, 9, 0]}, {"mesh": 0, "scale": [2, 2, 2]}]);
    animate(&mut document, "walk", 0, "translation", &[1.0, 0.0, 0.0, 3.0, 0.0, 0.0], "LINEAR");
    let scene = open(&document);
    assert_eq!(first(&scene), Vec3::new(0.0, 9.0, 0.0), "the scene itself is as the nodes are placed");
    let animation = scene.animation().unwrap();
    assert_eq!((animation.duration(), animation.names()), (2.0, &["walk".to_owned()][..]));
    assert!(animation.moves_surfaces());
    for (time, x) in [(-1.0, 1.0), (0.0, 1.0), (0.5, 1.5), (2.0, 3.0), (9.0, 3.0)] {
        assert_eq!(
            scene.at(time).geometry.mesh.corners(0),
            [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 2.0, 0.0, 0.0), Vec3::new(x, 2.0, 0.0)]
        );
    }
}

#[test]
fn what_stands_still_is_shared() {
    let mut document = triangle();
    document["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
    document["scenes"] = json!([{"nodes": [0, 1]}]);
    document["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]);
    animate(&mut document, "", 1, "translation", &[0.0, 0.0, 4.0, 0.0, 2.0, 4.0], "STEP");
    let scene = open(&document);
    let later = scene.at(2.0);
    assert!(std::sync::Arc::ptr_eq(&scene.geometry, &later.geometry));
    assert_eq!((later.cameras[0].position, scene.at(1.9).cameras[0].position.y), (Vec3::new(0.0, 2.0, 4.0), 0.0));
    assert_eq!(scene.animation().unwrap().names(), ["animation 0"]);
}

#[test]
fn a_node_may_move_what_is_below_it() {
    let mut document = triangle();
    document["nodes"] = json!([
        {"children": [1, 2]},
        {"camera": 0, "translation": [1, 0, 0]},
        {"translation": [2, 0, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"mesh": 0}
    ]);
    document["scenes"] = json!([{"nodes": [0, 3]}]);
    document["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}]);
    document["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}});
    document["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    // A quarter turn about Y in 2 s.
    let half = 0.5f32.sqrt();
    animate(&mut document, "turn", 0, "rotation", &[0.0, 0.0, 0.0, 1.0, 0.0, half, 0.0, half], "LINEAR");
    let turned = open(&document).at(2.0);
    let camera = &turned.cameras[0];
    assert!((camera.position - Vec3::new(0.0, 0.0, -1.0)).length() < 1e-6);
    assert!((camera.direction - Vec3::NEG_X).length() < 1e-6 && (camera.up - Vec3::Y).length() < 1e-6);
    let LightKind::Spot { position, direction, .. } = turned.lights[0].kind else { panic!() };
    assert!((position - Vec3::new(0.0, 0.0, -2.0)).length() < 1e-6 && (direction - Vec3::NEG_X).length() < 1e-6);
}

#[test]
fn cubic_splines_follow_the_slopes_of_the_file() {
    let mut document = triangle();
    // From 0 to 4 with the slope 0 at both keys, per second.
    let mut values = [0.0; 18];
    values[12] = 4.0;
    animate(&mut document, "", 0, "translation", &values, "CUBICSPLINE");
    let scene = open(&document);
    let at = |time| first(&scene.at(time)).x;
    assert_eq!([at(0.0), at(1.0), at(2.0)], [0.0, 2.0, 4.0]);
    assert!((at(0.5) - 4.0 * (3.0 / 16.0 - 2.0 / 64.0)).abs() < 1e-6);
}

#[test]
fn triangles_keep_their_front_when_they_are_mirrored() {
    let mut document = triangle();
    animate(&mut document, "", 0, "scale", &[1.0, 1.0, 1.0, -1.0, 1.0, 1.0], "LINEAR");
    let scene = open(&document);
    for time in [0.0, 0.9, 1.1, 2.0] {
        let [a, b, c] = scene.at(time).geometry.mesh.corners(0);
        assert!((b - a).cross(c - a).z > 0.0, "{time}");
    }
}

#[test]
fn of_animations_of_one_thing_one_is_played() {
    let mut document = triangle();
    document["nodes"] = json!([{"mesh": 0}, {"mesh": 0}]);
    document["scenes"] = json!([{"nodes": [0, 1]}]);
    let east = [1.0, 0.0, 0.0, 3.0, 0.0, 0.0];
    animate(&mut document, "walk", 0, "translation", &east, "LINEAR");
    animate(&mut document, "run", 0, "translation", &east.map(|x| 2.0 * x), "LINEAR");
    animate(&mut document, "door", 1, "translation", &east, "LINEAR");
    let scene = open(&document);
    let animation = scene.animation().unwrap();
    assert_eq!((animation.names(), animation.others()), (&["walk".to_owned(), "door".into()][..], &["run".into()][..]));

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.gltf");
    fs::write(&path, document.to_string()).unwrap();
    let play = |name: &str| Scene::open_with(&path, &LoadOptions::default().with_animation(name.to_owned()));
    assert_eq!(first(&play("run").unwrap().at(2.0)).x, 6.0);
    match play("fly") {
        Err(LoadError::UnknownAnimation { name, known, .. }) => {
            assert_eq!((name.as_str(), known.len()), ("fly", 3));
        }
        other => panic!("{other:?}"),
    }
}

/// A triangle whose second vertex goes with joint 2, and the others with joint 1.
fn skinned() -> Value {
    let mut document = triangle();
    document["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [50, 50, 50]},
        {"children": [2], "translation": [0, 0, 1]},
        {"translation": [1, 0, 0]}
    ]);
    document["scenes"] = json!([{"nodes": [0, 1]}]);
    let joints = add_accessor(&mut document, &[0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], 5121, "VEC4", 3);
    let weights = add_accessor(&mut document, &bytes_of(&[1.0, 0.0, 0.0, 0.0].repeat(3)), 5126, "VEC4", 3);
    let mut matrices = Vec::new();
    for x in [0.0, -1.0] {
        matrices.extend([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, 0.0, 0.0, 1.0]);
    }
    let matrices = add_accessor(&mut document, &bytes_of(&matrices), 5126, "MAT4", 2);
    let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    document["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": matrices}]);
    document
}

#[test]
fn skins_bend_by_their_joints_alone() {
    let mut document = skinned();
    // The place of the node with the mesh does not count.
    let [a, b, c] = [DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z].map(|corner| corner.as_vec3());
    let still = open(&document);
    assert_eq!(still.geometry.mesh.corners(0), [a, b, c]);
    assert!(still.animation().is_none());
    animate(&mut document, "bow", 2, "translation", &[1.0, 0.0, 0.0, 1.0, -2.0, 0.0], "LINEAR");
    let scene = open(&document);
    assert_eq!(scene.geometry.mesh.corners(0), [a, b, c]);
    assert_eq!(scene.at(1.0).geometry.mesh.corners(0), [a, b - Vec3::Y, c]);
}

#[test]
fn morph_targets_are_blended() {
    let mut document = triangle();
    let up = add_accessor(&mut document, &bytes_of(&[0.0, 0.0, 4.0].repeat(3)), 5126, "VEC3", 3);
    document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": up}]);
    document["meshes"][0]["weights"] = json!([0.25]);
    assert_eq!(first(&open(&document)), Vec3::Z);
    document["nodes"][0]["weights"] = json!([0.5]);
    assert_eq!(first(&open(&document)), 2.0 * Vec3::Z);
    animate(&mut document, "breathe", 0, "weights", &[0.0, 1.0], "LINEAR");
    let scene = open(&document);
    assert_eq!([0.0, 1.0, 2.0].map(|time| first(&scene.at(time)).z), [0.0, 2.0, 4.0]);
    document["nodes"][0]["scale"] = json!([-1, 1, 1]);
    let [a, b, c] = open(&document).at(1.0).geometry.mesh.corners(0);
    assert!((b - a).cross(c - a).z > 0.0);
}

#[test]
fn damaged_motion_is_an_error() {
    let mut document = triangle();
    animate(&mut document, "", 0, "translation", &[0.0; 6], "LINEAR");
    let change = |path: &[&str], value: Value| {
        let mut document = document.clone();
        let pointer: String = path.iter().map(|key| format!("/{key}")).collect();
        *document.pointer_mut(&pointer).unwrap() = value;
        error(&document)
    };
    let message = change(&["animations", "0", "samplers", "0", "interpolation"], json!("BEZIER"));
    assert!(message.contains("sampler 0 of animation 0 has the interpolation `BEZIER`"), "{message}");
    let message = change(&["animations", "0", "channels", "0", "sampler"], json!(7));
    assert!(message.contains("sampler 7 of animation 0 does not exist"), "{message}");
    let message = change(&["accessors", "2", "count"], json!(1));
    assert!(message.contains("does not have one value for each key"), "{message}");

    let mut document = skinned();
    document["skins"][0]["joints"] = json!([1]);
    let message = error(&document);
    assert!(message.contains("joint 1 of 1"), "{message}");
    document["skins"][0]["joints"] = json!([1, 9]);
    assert!(error(&document).contains("joint 9, which is no node"), "{}", error(&document));
}

#[test]
fn what_cannot_move_is_named() {
    let mut document = triangle();
    document["nodes"][0]["name"] = json!("door");
    animate(&mut document, "a", 0, "scale", &[1.0, f32::NAN, 1.0, 2.0, 2.0, 2.0], "LINEAR");
    animate(&mut document, "b", 999, "translation", &[0.0, 0.0, 0.0, 9.0, 9.0, 9.0], "LINEAR");
    let warnings = warnings(&document);
    let expected = [
        "model.gltf: node 999: an animation moves it, but the file does not contain it: ignored",
        "model.gltf: node 0 (`door`): an animation has keys with infinite or undefined values: what they move stays at rest",
    ];
    assert!(expected.iter().all(|warning| warnings.contains(warning)), "{warnings}");
    let (scene, still) = (open(&document), open(&triangle()));
    let moved = scene.at(1.0);
    assert_eq!(moved.geometry.mesh.corners(0), still.geometry.mesh.corners(0));
}

#[test]
fn vertices_that_no_joint_holds_are_named() {
    for weight in [0.0, f32::NAN] {
        let mut document = skinned();
        assert!(!warnings(&document).contains("weights of joints"));
        let weights = [weight, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
        let weights = add_accessor(&mut document, &bytes_of(&weights), 5126, "VEC4", 3);
        document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
        let warnings = warnings(&document);
        let expected = "model.gltf: node 0: vertices have weights of joints that are all 0 or undefined: they go with the first joint";
        assert!(warnings.contains(expected), "{weight}: {warnings}");
    }
}
