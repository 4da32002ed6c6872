//! Every shared glTF and GLB file has the triangles, box, lights, cameras, textures and warnings that it should.

use std::{collections::BTreeSet, fs, path::PathBuf};

use glam::{DVec3, Vec3};
use lightmesh_scene::{Camera, Falloff, Fov, Geometry, LightKind, Projection, Scene};

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes")
}

fn open(file: &str) -> Scene {
    Scene::open(folder().join(file)).unwrap_or_else(|error| panic!("{error}"))
}

fn assert_near(what: &str, value: Vec3, expected: [f64; 3], tolerance: f32) {
    let expected = DVec3::from(expected).as_vec3();
    assert!((value - expected).abs().max_element() <= tolerance, "{what}: {value} instead of {expected}");
}

fn vertical(camera: &Camera) -> f32 {
    let Projection::Perspective(Fov::Vertical(degrees)) = camera.projection else { panic!("{camera:?}") };
    degrees
}

/// A row of the table in the folder's README: file, triangles, lowest and highest corner, lights.
struct Row {
    file: String,
    triangles: usize,
    corners: [[f64; 3]; 2],
    lights: Vec<String>,
}

/// The rows about glTF.
fn table() -> Vec<Row> {
    let text = fs::read_to_string(folder().join("README.md")).expect("the README of the shared scenes");
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let (file, triangles, corners, lights) = (cells.get(1)?, cells.get(3)?, cells.get(4)?, cells.get(5)?);
        let (min, max) = corners.split_once("..")?;
        let corner = |text: &str| -> Option<[f64; 3]> {
            let numbers: Vec<f64> = text.split_whitespace().map(|number| number.parse().ok()).collect::<Option<_>>()?;
            numbers.try_into().ok()
        };
        let is_gltf = file.ends_with(".gltf") || file.ends_with(".glb");
        is_gltf.then_some(Row {
            file: (*file).to_owned(),
            triangles: triangles.replace(',', "").parse().ok()?,
            corners: [corner(min)?, corner(max)?],
            lights: lights.split(',').map(str::trim).filter(|light| *light != "-").map(str::to_owned).collect(),
        })
    };
    text.lines().filter_map(row).collect()
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn the_table_lists_every_file() {
    let mut listed: BTreeSet<PathBuf> = table().iter().map(|row| folder().join(&row.file)).collect();
    assert_eq!(listed.len(), 12);
    for entry in fs::read_dir(folder()).unwrap().map(Result::unwrap).filter(|entry| entry.path().is_dir()) {
        for file in fs::read_dir(entry.path()).unwrap().map(|file| file.unwrap().path()) {
            if file.extension().is_some_and(|ending| ending == "gltf" || ending == "glb") {
                assert!(listed.remove(&file), "{} is not listed", file.display());
            }
        }
    }
    assert!(listed.is_empty(), "{listed:?}");
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn files_have_the_triangles_boxes_and_lights_of_the_table() {
    for Row { file, triangles, corners: [min, max], lights } in table() {
        let scene = open(&file);
        assert_eq!(scene.geometry.mesh.triangles.len(), triangles, "{file}");
        assert_eq!(scene.geometry.origin, DVec3::ZERO, "{file}");
        let bounds = scene.geometry.mesh.bounds();
        // Three decimals. Of `complete` the table's box holds lines and points too.
        if file != "complete/complete.glb" {
            assert_near(&file, bounds.min, min, 0.00051);
            assert_near(&file, bounds.max, max, 0.00051);
        } else {
            let (min, max) = (DVec3::from(min).as_vec3() - 0.001, DVec3::from(max).as_vec3() + 0.001);
            assert!(bounds.min.cmpge(min).all() && bounds.max.cmple(max).all(), "{file}: {bounds:?}");
        }
        // Lamps are none of the file's lights.
        let own = scene.lights.iter().filter(|light| !light.lamp);
        let mut kinds: Vec<&str> = own.map(|light| light.kind_name()).collect();
        kinds.sort_unstable();
        assert_eq!(kinds, lights, "{file}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn attributes_are_whole() {
    for Row { file, .. } in table() {
        let scene = open(&file);
        let Geometry { mesh, materials, textures, .. } = &*scene.geometry;
        let vertices = mesh.positions.len();
        for length in [mesh.normals.len(), mesh.uvs.len(), mesh.colors.len()] {
            assert!(length == 0 || length == vertices, "{file}");
        }
        assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "{file}");
        assert!(mesh.materials.iter().all(|&material| (material as usize) < materials.len()), "{file}");
        assert!(mesh.normals.iter().all(|n| n.length() == 0.0 || (n.length() - 1.0).abs() < 1e-5), "{file}");
        let mut used = materials.iter().filter_map(|material| material.texture);
        assert!(used.all(|used| (used.texture as usize) < textures.len()), "{file}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn lights_have_the_places_directions_and_strengths_of_the_remarks() {
    let scene = open("camera_light/geometry-camera-light.glb");
    let light = |kind: &str| scene.lights.iter().find(|light| light.kind_name() == kind).expect("such a light");
    let (point, spot) = (light("point"), light("spot"));
    assert_near("point", point.position().unwrap(), [4.08, 1.01, 5.9], 0.006);
    assert_near("spot", spot.position().unwrap(), [4.08, -2.59, 5.9], 0.006);
    // 1000 cd times the light's colour.
    assert_near("colour", point.intensity, [339.912, 627.417, 1000.0], 0.01);
    assert_eq!(spot.intensity.max_element(), 1000.0);
    let LightKind::Spot { inner, outer, .. } = spot.kind else { panic!("{spot:?}") };
    assert!((inner - 0.556).abs() < 6e-4 && (outer - 0.654).abs() < 6e-4, "{inner} {outer}");

    let scene = open("complete/complete.glb");
    let LightKind::Directional { direction, .. } = scene.lights[0].kind else { panic!("{:?}", scene.lights) };
    assert_near("sun", direction, [-0.447, -0.894, 0.0], 0.001);

    let lamp = &open("cubes/Cubes.glb").lights[0];
    assert_near("lamp", lamp.position().unwrap(), [-0.52, 3.77, -0.83], 0.006);
    assert_near("lamp", lamp.intensity, [79.6; 3], 0.05);
    assert_eq!(lamp.falloff, Falloff::InverseSquare);
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn cameras_have_the_places_and_angles_of_the_remarks() {
    let first = |file: &str| open(file).cameras[0].clone();
    let cornell = first("cornell_gltf/cornellBox.gltf");
    assert_near("cornell", cornell.position, [0.0, 0.0, 20.0], 0.01);
    assert_near("cornell", cornell.direction, [0.0, 0.0, -1.0], 0.001);
    let duck = first("duck/Duck.glb");
    assert_near("duck", duck.position, [4.0, 4.63, -4.31], 0.006);
    assert_near("duck", duck.direction, [-0.536, -0.621, 0.571], 0.001);
    let complete = first("complete/complete.glb");
    assert_near("complete", complete.position, [790.0, 400.0, 127.0], 0.5);

    let scene = open("camera_light/geometry-camera-light.glb");
    let named = |name: &str| scene.cameras.iter().find(|camera| camera.name.starts_with(name)).expect("a camera");
    let persp = named("Persp");
    assert_near("Persp", persp.position, [4.56, -7.58, 4.96], 0.006);
    assert_near("Persp", persp.direction, [-0.478, 0.724, -0.497], 0.001);
    assert!(scene.cameras.iter().any(|camera| matches!(camera.projection, Projection::Orthographic { .. })));

    for (camera, degrees) in [(&cornell, 41.1), (&duck, 37.8), (&complete, 45.0), (persp, 22.9)] {
        assert!((vertical(camera) - degrees).abs() < 0.06, "{camera:?}");
    }
    for (file, count) in [("complete/complete.glb", 2), ("camera_light/geometry-camera-light.glb", 2)] {
        assert_eq!(open(file).cameras.len(), count, "{file}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn textures_and_colours_are_there() {
    for (file, materials, textures) in [
        ("balloon/scene.gltf", 19, 17),
        ("complete/complete.glb", 2, 2),
        ("duck/Duck.glb", 1, 1),
        ("house/house.glb", 1, 1),
        ("milk_truck/CesiumMilkTruck.glb", 2, 1),
    ] {
        let scene = open(file);
        assert_eq!(scene.geometry.textures.len(), textures, "{file}: {:?}", scene.warnings);
        assert_eq!(
            scene.geometry.materials.iter().filter(|material| material.texture.is_some()).count(),
            materials,
            "{file}"
        );
        assert!(
            scene
                .geometry
                .textures
                .iter()
                .all(|texture| texture.texels.len() as u32 == texture.size[0] * texture.size[1])
        );
        assert!(!scene.geometry.mesh.uvs.is_empty(), "{file}");
    }
    assert!(!open("complete/complete.glb").geometry.mesh.colors.is_empty());
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn warnings_say_what_is_not_shown_and_nothing_else() {
    for (file, expected) in [
        ("balloon/scene.gltf", &[][..]),
        ("camera_light/geometry-camera-light.glb", &[]),
        ("chess/chess-board.glb", &["KHR_materials_clearcoat"]),
        ("complete/complete.glb", &["primitives of points or lines: ignored"]),
        ("cornell_gltf/cornellBox.gltf", &["NV_materials_mdl"]),
        ("cubes/Cubes.glb", &[]),
        ("duck/Duck.glb", &[]),
        ("house/house.glb", &[]),
        ("milk_truck/CesiumMilkTruck.glb", &[]),
        ("mountains/Mountains.gltf", &[]),
        ("node_hierarchy/02_node_hierarchy.gltf", &[]),
        ("u32_indices/01_vertex_count_32bit.gltf", &[]),
    ] {
        let warnings = open(file).warnings;
        assert_eq!(warnings.len(), expected.len(), "{file}: {warnings:?}");
        for (warning, expected) in warnings.iter().zip(expected) {
            assert!(warning.contains(expected), "{file}: {warning}");
        }
    }
}
