//! From where shared models without camera are seen, and where their lights are.

use std::path::{Path, PathBuf};

use lightmesh_scene::glam::Vec3;
use lightmesh_scene::{Added, Camera, Scene, Up, Viewpoint};

fn shared() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes")
}

/// Every model of the folder, in order.
fn models() -> Vec<PathBuf> {
    let entries = |folder: &Path| std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let is_model = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        ["obj", "ply", "stl", "gltf", "glb"].iter().any(|known| extension == *known)
    };
    let folders = entries(&shared()).filter(|path| path.is_dir());
    let mut models: Vec<PathBuf> = folders.flat_map(|folder| entries(&folder)).filter(is_model).collect();
    models.sort();
    models
}

/// Completes a model after its cameras and lights were taken away.
fn bare(path: &Path) -> (Scene, Added) {
    let mut scene = Scene::open(path).unwrap_or_else(|error| panic!("{error}"));
    (scene.cameras, scene.lights) = Default::default();
    let added = scene.complete(Up::of_file(path));
    (scene, added)
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn only_interiors_are_seen_as_such() {
    let models = models();
    assert!(models.len() >= 27, "{models:?}");
    for path in models {
        let (_, added) = bare(&path);
        let expected = match path.file_name().and_then(|name| name.to_str()) {
            Some("sponza.obj") => (Viewpoint::Inside, true),
            Some("cornell_box.obj") => (Viewpoint::OpenSide, false),
            _ => (Viewpoint::Front, false),
        };
        assert_eq!((added.viewpoint, added.lights_inside), expected, "{}", path.display());
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn cameras_of_files_keep_the_lights_outside() {
    for path in models() {
        let mut scene = Scene::open(&path).unwrap_or_else(|error| panic!("{error}"));
        if !scene.cameras.is_empty() {
            scene.lights.clear();
            assert!(!scene.complete(Up::of_file(&path)).lights_inside, "{}", path.display());
        }
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn the_cornell_box_is_seen_from_its_open_front() {
    let (scene, _) = bare(&shared().join("cornell_box/cornell_box.obj"));
    assert_eq!(scene.cameras[0].direction, Vec3::Z);
    assert!(scene.cameras[0].position.z < -500.0);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn the_court_is_lit_from_within() {
    let path = shared().join("sponza/sponza.obj");
    let mut scene = Scene::open(&path).unwrap_or_else(|error| panic!("{error}"));
    scene.cameras =
        vec![Camera::look_at(Vec3::new(-13.0, 3.0, 0.0), Vec3::new(10.0, 5.0, 0.0), Vec3::Y, 60.0).unwrap()];
    assert!(scene.complete(Up::Y).lights_inside);
    assert_eq!(scene.lights.ambient, Some(Vec3::splat(0.2)));
    let key = scene.lights[0].position().unwrap();
    // High above the floor, in the nave and ahead of the camera.
    assert!(key.y > 8.0 && key.z.abs() < 4.0 && key.x > -10.0 && key.x < 10.0, "{key}");
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn pawns_beside_the_board_do_not_make_it_small() {
    let (scene, _) = bare(&shared().join("chess/chess-board.glb"));
    let camera = &scene.cameras[0];
    let (right, up, forward) = camera.basis();
    let mesh = &scene.geometry.mesh;
    // Three lie where x is beyond 137. What is framed fills the image from one border to the other without them.
    let of_board = mesh.positions.iter().filter(|position| position.x.abs() < 137.0);
    let extents = of_board.fold([f32::NEG_INFINITY; 4], |extents, &position| {
        let way = position - camera.position;
        let scale = way.dot(forward).recip() / 20.0f32.to_radians().tan();
        let sides = [way.dot(right), -way.dot(right), way.dot(up), -way.dot(up)];
        std::array::from_fn(|side| extents[side].max(scale * sides[side]))
    });
    assert!(extents[0].min(extents[1]) > 0.9 && extents.iter().all(|&extent| extent < 0.93), "{extents:?}");
}
