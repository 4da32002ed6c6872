use glam::{DVec3, Vec3};
use lightmesh_scene::{Camera, Light, Projection, Scene, SceneBuilder};

fn scene() -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("test");
    scene.geometry_mut().origin = DVec3::new(1000.0, 0.0, 0.0);
    scene.geometry_mut().mesh.positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    scene.geometry_mut().mesh.triangles = vec![[0, 1, 2]];
    let sun = Light::directional(Vec3::NEG_Y).unwrap();
    scene.lights.list =
        vec![Light::point(Vec3::Z).with_intensity(Vec3::splat(0.1)), sun.clone(), sun.with_angle(0.5f32.to_radians())];
    let camera = Camera::look_to(Vec3::Z, Vec3::NEG_Z, Vec3::Y, 50.0).unwrap().named("main");
    let plan = Projection::Orthographic { height: 4.0 };
    scene.cameras = vec![camera.clone(), camera.with_projection(plan)];
    scene
}

#[test]
fn the_json_is_in_world_coordinates_and_degrees() {
    let json = serde_json::to_value(scene().info()).unwrap();
    let expected = serde_json::json!({
        "triangles": 1,
        "normals": 0,
        "smooth_normals": 0,
        "bounds": {"min": [1000.0, 0.0, 0.0], "max": [1001.0, 1.0, 0.0]},
        "lights": [
            {"kind": "point", "position": [1000.0, 0.0, 1.0], "direction": null, "intensity": [0.1, 0.1, 0.1],
             "falloff": "none"},
            {"kind": "directional", "position": null, "direction": [0.0, -1.0, 0.0], "intensity": [1.0, 1.0, 1.0],
             "falloff": "none"},
            {"kind": "directional", "position": null, "direction": [0.0, -1.0, 0.0], "intensity": [1.0, 1.0, 1.0],
             "falloff": "none", "angle": 0.5},
        ],
        "cameras": [
            {"name": "main", "position": [1000.0, 0.0, 1.0], "direction": [0.0, 0.0, -1.0], "up": [0.0, 1.0, 0.0],
             "vfov": 50.0},
            {"name": "main", "position": [1000.0, 0.0, 1.0], "direction": [0.0, 0.0, -1.0], "up": [0.0, 1.0, 0.0],
             "vfov": null, "height": 4.0},
        ],
        "materials": 0,
        "cut_outs": 0,
        "instances": 0,
        "see_through": 0,
        "textures": 0,
        "up": {"axis": "y", "reason": "its cameras are oriented that way"},
        "animation": null,
        "warnings": [],
    });
    assert_eq!(json, expected);
}

#[test]
fn people_read_the_same() {
    let text = scene().info().to_string();
    assert!(text.contains("light   point, at 1000 0 1, intensity 0.1 0.1 0.1, falloff none\n"), "{text}");
    assert!(text.contains("light   directional, along 0 -1 0, intensity 1 1 1, falloff none, angle 0.5\n"), "{text}");
    assert!(text.contains("camera  `main` at 1000 0 1, along 0 0 -1, vfov 50°"), "{text}");
    assert!(!text.contains("normals"), "{text}");
    assert!(text.contains("0 materials\n") && text.contains("up      y: its cameras are oriented that way"), "{text}");
}

#[test]
fn normals_are_counted() {
    let mut scene = scene();
    scene.geometry_mut().mesh.normals = vec![Vec3::Z, Vec3::ZERO, Vec3::Z];
    assert!(scene.info().to_string().contains("\nnormals 2\n"));
    scene.smooth_normals = 1;
    assert!(scene.info().to_string().contains("\nnormals 2, 1 of them made from the triangles\n"));
}

#[test]
fn an_empty_scene_has_no_bounds() {
    let info = SceneBuilder::new().finish_scene("empty").info();
    assert_eq!(info.bounds, None);
}
