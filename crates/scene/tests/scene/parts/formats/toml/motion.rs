//! What moves in a scene file.

use super::*;

const OBJECTS: &str = r#"
    [[sphere]]
    center = [5, 0, 0]
    radius = 1
    motion = { key = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [0, 2, 0] }, { time = 4, translate = [0, 8, 0] }] }
    [[mesh]]
    file = "one.obj"
    translate = [10, 0, 0]
    [mesh.motion]
    interpolation = "linear"
    key = [{ time = 1, rotate = [0, 0, 0] }, { time = 3, rotate = [0, 720, 0], scale = 3 }]
    [[plane]]
    point = [0, -1, 0]
    normal = [0, 1, 0]
    size = [50, 50]
"#;

fn middle(scene: &Scene, object: &str) -> Vec3 {
    let mesh = &scene.geometry.mesh;
    let own = (0..mesh.triangles.len()).filter(|&index| mesh.objects.name(mesh.objects.of(index as u32)) == object);
    lightmesh_scene::Bounds::around(own.flat_map(|index| mesh.corners(index))).center()
}

#[test]
fn objects_move_relative_to_their_place() {
    let scene = open(OBJECTS);
    assert_eq!(scene.animation().unwrap().duration(), 4.0);
    // The mesh comes first: it is larger from its only key with a scale on, and before.
    assert_eq!(scene.at(0.0).geometry.mesh.positions[3..], scene.geometry.mesh.positions[3..]);
    for (time, y) in [(0.5, 1.0), (2.5, 5.0), (4.0, 8.0)] {
        let found = middle(&scene.at(time), "sphere 1");
        assert!((found - Vec3::new(5.0, y, 0.0)).length() < 1e-5, "{time} {found}");
    }
    assert_eq!(middle(&scene.at(3.0), "plane 1"), Vec3::new(0.0, -1.0, 0.0));
}

#[test]
fn keys_may_be_several_turns_apart() {
    let scene = open(OBJECTS);
    // Two turns in two seconds about its `translate`, three times as large at once: only one key has a scale.
    let corner = |time| {
        let scene = scene.at(time);
        let mesh = &scene.geometry.mesh;
        let index = (0..mesh.triangles.len()).find(|&index| mesh.objects.name(mesh.objects.of(index as u32)) == "one");
        mesh.corners(index.unwrap())[1]
    };
    let places = [(0.0, [13.0, 0.0]), (1.25, [10.0, -3.0]), (1.5, [7.0, 0.0]), (2.0, [13.0, 0.0]), (3.0, [13.0, 0.0])];
    for (time, [x, z]) in places {
        assert!((corner(time) - Vec3::new(x, 0.0, z)).length() < 1e-4, "{time} {}", corner(time));
    }
}

#[test]
fn cameras_follow_their_targets_and_lights_their_keys() {
    let scene = open(
        r#"
        [camera]
        position = [0, 0, 8]
        target = [0, 0, 0]
        [camera.motion]
        interpolation = "linear"
        key = [{ time = 0, position = [0, 0, 8], vfov = 40 }, { time = 2, position = [8, 0, 0], vfov = 60, shift = [0, 0.5] }, { time = 3, shift = [1, 0.5] }]
        [[light]]
        kind = "sphere"
        position = [0, 5, 0]
        radius = 1
        name = "sun"
        [light.motion]
        key = [{ time = 0, intensity = 0 }, { time = 1, intensity = [1, 0.5, 0], radius = 2 }]
        [[light]]
        kind = "spot"
        position = [0, 5, 0]
        direction = [0, -1, 0]
        [light.motion]
        key = [{ time = 0, radius = 0 }, { time = 1, radius = 2 }]
        [[triangle]]
        a = [0, 0, 0]
        b = [1, 0, 0]
        c = [0, 1, 0]
        "#,
    );
    assert!(!scene.animation().unwrap().moves_surfaces());
    let half = scene.at(1.0);
    let camera = &half.cameras[0];
    assert_eq!(camera.position, Vec3::new(4.0, 0.0, 4.0));
    assert!((camera.direction + Vec3::new(0.5f32.sqrt(), 0.0, 0.5f32.sqrt())).length() < 1e-6);
    assert_eq!(camera.projection, Projection::Perspective(Fov::Vertical(50.0)));
    assert_eq!((camera.shift, scene.at(2.5).cameras[0].shift), (Vec2::new(0.0, 0.5), Vec2::new(0.5, 0.5)));
    let light = &half.lights[0];
    assert_eq!((light.intensity, light.name.as_str()), (Vec3::new(1.0, 0.5, 0.0), "sun"));
    assert_eq!(light.kind, LightKind::Sphere { position: Vec3::new(0.0, 5.0, 0.0), radius: 2.0 });
    assert_eq!(scene.at(0.5).lights[0].intensity.x, 0.5);
    assert!(matches!(scene.at(0.5).lights[1].kind, LightKind::Spot { radius: 1.0, .. }));
}

#[test]
fn lamps_move_with_their_surfaces() {
    let scene = open(
        r#"
        [[material]]
        name = "glow"
        emission = 5
        [[box]]
        center = [0, 4, 0]
        size = [0.5, 0.1, 0.5]
        material = "glow"
        motion = { key = [{ time = 0, translate = [0, 0, 0] }, { time = 1, translate = [3, 0, 0] }] }
        [[plane]]
        point = [0, 0, 0]
        normal = [0, 1, 0]
        size = [20, 20]
        "#,
    );
    let place = |scene: &Scene| scene.lights.iter().find_map(|light| light.surface.and(light.position())).unwrap();
    let (before, after) = (place(&scene), place(&scene.at(1.0)));
    assert!((after - before - Vec3::new(3.0, 0.0, 0.0)).length() < 0.01, "{before} {after}");
    assert_eq!(scene.lights.len(), scene.at(1.0).lights.len());
}

#[test]
fn mistakes_of_keys_are_named() {
    let camera = |key: &str| {
        error(&format!(
            "[camera]\nposition = [0, 0, 8]\ntarget = [0, 0, 0]\n[camera.motion]\nkey = [{{ time = 1 }},\n{key}]"
        ))
    };
    for (key, problem) in [
        ("{ time = 1 }", "room.toml:6"),
        ("{ time = 2, direction = [0, 0, 1] }", "the table itself must have `direction`, too"),
        ("{ time = 2, target = [0, 0, 8] }", "is the camera's own position"),
        ("{ time = 2, vfov = 0 }", "room.toml:6"),
        ("{ time = -2 }", "time"),
        ("{ time = 2, speed = 3 }", "unknown key `speed`"),
    ] {
        let message = camera(key);
        assert!(message.contains(problem), "{message}");
    }
}
