//! Every shared model loads with the triangles, box, lights and cameras listed in the table next to it.

use std::path::PathBuf;

use crate::builtin_files::triangles;
use glam::{DVec3, Vec3};
use lightmesh_scene::{Falloff, Fov, LightKind, Projection, Scene};

/// File, triangles, lowest and highest corner.
#[rustfmt::skip]
const MODELS: [(&str, usize, [f64; 3], [f64; 3]); 27] = [
    ("balloon/scene.gltf", 35_698, [-0.141, 0.213, -0.286], [0.438, 0.908, 0.292]),
    ("beetle/beetle.obj", 2_053, [-0.217, 0.306, -0.254], [0.144, 0.609, 0.638]),
    ("bunny/bunny.ply", 69_451, [-0.095, 0.033, -0.062], [0.061, 0.187, 0.059]),
    ("bunny/stanford-bunny.obj", 69_451, [-0.095, 0.033, -0.062], [0.061, 0.187, 0.059]),
    ("camera_light/geometry-camera-light.glb", 14, [-7.102, -7.102, -1.04], [7.102, 7.102, 1.0]),
    ("chess/chess-board.glb", 178_848, [-157.491, -1.346, -136.49], [179.57, 42.249, 136.49]),
    ("cornell_box/cornell_box.obj", 34, [0.0, 0.0, 0.0], [556.0, 548.8, 559.2]),
    ("cornell_gltf/cornellBox.gltf", 16_732, [-5.05, -5.05, -5.05], [5.05, 5.05, 5.0]),
    ("cubes/Cubes.glb", 36, [-4.284, -1.938, -2.994], [4.603, 3.591, 3.639]),
    ("cycloidal/cycloidal.ply", 43_368, [0.24, -0.339, 0.811], [2.115, 1.536, 1.918]),
    ("duck/Duck.glb", 4_212, [-0.693, 0.099, -0.613], [0.962, 1.64, 0.539]),
    ("featuretype/featuretype.STL", 3_476, [-2.5, -1.25, 0.0], [2.5, 1.25, 1.375]),
    ("house/house.glb", 10_497, [-0.251, -0.002, -0.252], [0.251, 0.185, 0.252]),
    ("milk_truck/CesiumMilkTruck.glb", 3_624, [-2.431, 0.001, -1.396], [2.438, 2.584, 1.396]),
    ("mountains/Mountains.gltf", 25_600, [-1.0, -0.086, -1.0], [1.002, 0.249, 1.006]),
    ("node_hierarchy/02_node_hierarchy.gltf", 60, [-1.0, -1.0, -1.0], [5.0, 5.0, 1.0]),
    ("ogre/ogre.obj", 124_008, [-15.61, -0.008, -5.456], [15.61, 32.03, 4.267]),
    ("spider/spider.obj", 1_368, [-92.655, -42.234, -106.691], [57.936, 37.504, 86.691]),
    ("spider/spider_ascii.stl", 1_368, [-3.115, -4.0, -1.649], [3.115, 4.0, 1.649]),
    ("spider/spider_binary.stl", 1_368, [-3.115, -4.0, -1.649], [3.115, 4.0, 1.649]),
    ("sponza/sponza.obj", 66_450, [-17.403, -0.907, -7.799], [17.417, 15.653, 7.801]),
    ("spot/spot.obj", 5_856, [-0.472, -0.737, -0.669], [0.472, 0.954, 1.049]),
    ("suzanne/suzanne.obj", 968, [-3.861, 0.267, 3.252], [-1.127, 2.236, 4.955]),
    ("suzanne/suzanne.ply", 968, [-1.367, 0.284, -0.895], [1.367, 2.252, 0.808]),
    ("teapot/teapot.obj", 6_320, [-3.0, 0.0, -2.0], [3.434, 3.15, 2.0]),
    ("teapot/teapot.ply", 2_256, [-3.0, -2.0, 0.0], [3.43, 2.0, 3.15]),
    ("u32_indices/01_vertex_count_32bit.gltf", 130_380, [-1.0, -1.0, -2.627], [1.0, 1.0, 2.8]),
];

fn open(file: &str) -> Scene {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes").join(file);
    Scene::open(&path).unwrap_or_else(|error| panic!("{error}"))
}

fn assert_near(what: &str, value: Vec3, expected: [f64; 3], tolerance: f32) {
    let expected = DVec3::from(expected).as_vec3();
    assert!((value - expected).abs().max_element() <= tolerance, "{what}: {value} instead of {expected}");
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn models_have_their_triangles_and_boxes() {
    for (file, triangles, min, max) in MODELS {
        let scene = open(file);
        assert_eq!(scene.geometry.mesh.triangles.len(), triangles, "{file}");
        assert_eq!(scene.geometry.mesh.materials.len(), triangles, "{file}");
        let bounds = scene.geometry.mesh.bounds();
        // The table has three decimals; the local frame of these models is the world's.
        assert_eq!(scene.geometry.origin, DVec3::ZERO, "{file}");
        assert_near(file, bounds.min, min, 0.00051);
        assert_near(file, bounds.max, max, 0.00051);
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn models_are_whole() {
    for (file, ..) in MODELS {
        let scene = open(file);
        let (mesh, vertices) = (&scene.geometry.mesh, scene.geometry.mesh.positions.len());
        assert!(mesh.normals.is_empty() || mesh.normals.len() == vertices, "{file}");
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices, "{file}");
        assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "{file}");
        assert!(mesh.materials.iter().all(|&material| (material as usize) < scene.geometry.materials.len()), "{file}");
        assert!(mesh.normals.iter().all(|n| n.length() == 0.0 || (n.length() - 1.0).abs() < 1e-5), "{file}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn a_point_and_a_spot_light_stand_where_the_file_says() {
    let scene = open("camera_light/geometry-camera-light.glb");
    let [point, spot] = [&scene.lights[0], &scene.lights[1]].map(Clone::clone);
    let (point, spot) = if point.kind_name() == "point" { (point, spot) } else { (spot, point) };
    assert_near("point", point.position().unwrap(), [4.08, 1.01, 5.9], 0.01);
    assert_near("spot", spot.position().unwrap(), [4.08, -2.59, 5.9], 0.01);
    // 1000 cd times the light's colour.
    assert_near("intensity", point.intensity, [339.912, 627.417, 1000.0], 0.01);
    assert_eq!((point.falloff, spot.falloff), (Falloff::InverseSquare, Falloff::InverseSquare));
    let LightKind::Spot { inner, outer, direction, .. } = spot.kind else { panic!("{spot:?}") };
    assert!((inner - 0.556).abs() < 1e-3 && (outer - 0.654).abs() < 1e-3, "{inner} {outer}");
    assert!((direction.length() - 1.0).abs() < 1e-6);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn cameras_stand_where_the_file_says() {
    let perspective = |file: &str, position, tolerance, vfov: f32| {
        let camera = open(file).cameras[0].clone();
        assert_near(file, camera.position, position, tolerance);
        let Projection::Perspective(Fov::Vertical(degrees)) = camera.projection else { panic!("{camera:?}") };
        assert!((degrees - vfov).abs() < 0.06, "{file}: {degrees}");
        camera.direction
    };
    let direction = perspective("cornell_gltf/cornellBox.gltf", [0.0, 0.0, 19.992], 0.001, 41.1);
    assert_near("cornell_gltf", direction, [0.0, 0.0, -1.0], 0.001);
    let direction = perspective("duck/Duck.glb", [4.0, 4.63, -4.31], 0.006, 37.8);
    assert_near("duck", direction, [-0.536, -0.621, 0.571], 0.001);
    perspective("complete/complete.glb", [790.0, 400.0, 127.0], 0.5, 45.0);

    let scene = open("camera_light/geometry-camera-light.glb");
    let camera = scene.cameras.iter().find(|camera| camera.name.starts_with("Persp")).expect("a camera named Persp");
    assert_near("Persp", camera.position, [4.56, -7.58, 4.96], 0.006);
    assert_near("Persp", camera.direction, [-0.478, 0.724, -0.497], 0.001);
    let orthographic = |projection| matches!(projection, Projection::Orthographic { .. });
    assert!(scene.cameras.iter().any(|camera| orthographic(camera.projection)));
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn a_directional_light_points_where_the_file_says_and_lines_are_left_out() {
    let scene = open("complete/complete.glb");
    assert_eq!(scene.geometry.mesh.triangles.len(), 19_930);
    let LightKind::Directional { direction, .. } = scene.lights[0].kind else { panic!("{:?}", scene.lights) };
    assert_near("direction", direction, [-0.447, -0.894, 0.0], 0.001);
    assert!(scene.warnings.iter().any(|warning| warning.contains("points or lines")), "{:?}", scene.warnings);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn a_light_whose_extension_is_required_is_read() {
    let scene = open("cubes/Cubes.glb");
    assert_near("position", scene.lights[0].position().unwrap(), [-0.52, 3.77, -0.83], 0.006);
    assert_near("intensity", scene.lights[0].intensity, [79.6; 3], 0.05);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn a_missing_material_library_is_a_warning() {
    let scene = open("beetle/beetle.obj");
    assert!(scene.warnings.iter().any(|warning| warning.contains(".mtl")), "{:?}", scene.warnings);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn materials_of_an_obj_come_from_its_library() {
    let scene = open("cornell_box/cornell_box.obj");
    assert_eq!(scene.geometry.materials.len(), 5);
    let light =
        scene.geometry.materials.iter().find(|material| material.name == "light").expect("a material named light");
    assert_eq!(light.ka, Vec3::splat(20.0));
    assert_eq!(open("sponza/sponza.obj").geometry.materials.len(), 20);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn models_survive_being_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    for (file, ..) in MODELS.iter().filter(|(_, triangles, ..)| *triangles < 70_000) {
        let scene = open(file);
        for name in ["copy.glb", "copy.toml"] {
            let path = folder.path().join(name);
            scene.export(&path).unwrap();
            let copy = Scene::open(&path).unwrap_or_else(|error| panic!("{file}, {name}: {error}"));
            assert!(triangles(&copy) == triangles(&scene), "{file}, {name}");
            assert_eq!(copy.geometry.materials, scene.geometry.materials, "{file}, {name}");
            assert_eq!(copy.lights.len(), scene.lights.len(), "{file}, {name}");
            assert_eq!(copy.cameras, scene.cameras, "{file}, {name}");
        }
    }
}
