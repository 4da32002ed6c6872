//! Meshes in many places: stored once, or copied.

use glam::{Vec2, Vec3};
use lightmesh_scene::{FIRST_INSTANCED, Instancing, Light, Mesh};

use super::animations::animate;
use super::geometry::instanced;
use super::*;

/// The document read in both ways: with meshes stored once, and copied.
fn both(document: &Value) -> [Scene; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.gltf");
    fs::write(&path, document.to_string()).unwrap();
    let read = |instancing| Scene::open_with(&path, &LoadOptions::default().with_instancing(instancing)).unwrap();
    [Instancing::Always, Instancing::Never].map(read)
}

/// All triangles with what belongs to them, in no order.
fn triangles(mesh: &Mesh) -> Vec<String> {
    let rounded = |v: Vec3| (v * 1e4).round() + 0.0;
    let triangle = |index: usize| {
        let vertices = mesh.triangles[index];
        let corners = mesh.corners(index).map(rounded);
        let normals = vertices.map(|vertex| mesh.normals.get(vertex as usize).map(|&normal| rounded(normal)));
        let uvs = vertices.map(|vertex| mesh.uvs.get(vertex as usize).copied().map(|uv: Vec2| uv.to_array()));
        let object = mesh.objects.name(mesh.object_of(index as u32));
        format!("{corners:?} {normals:?} {uvs:?} {} {object}", mesh.materials[index])
    };
    let mut all: Vec<String> = (0..mesh.triangles.len()).map(triangle).collect();
    all.sort();
    all
}

/// Checks that both are the same scene, now and over time. Returns the number of instances.
fn same(document: &Value) -> usize {
    let [shared, copied] = both(document);
    assert!(copied.geometry.mesh.instances.is_empty());
    for time in [None, Some(0.0), Some(0.7), Some(2.0)] {
        let at = |scene: &Scene| time.map_or_else(|| scene.clone(), |time| scene.at(time));
        let (one, other) = (at(&shared), at(&copied));
        let flat = one.geometry.mesh.flattened().unwrap();
        assert_eq!(triangles(&flat), triangles(&other.geometry.mesh), "at {time:?}");
        let (a, b) = (one.geometry.mesh.bounds(), other.geometry.mesh.bounds());
        assert!(a.min.distance(b.min) < 1e-4 && a.max.distance(b.max) < 1e-4, "{a:?} {b:?}");
    }
    shared.geometry.mesh.instances.list().len()
}

/// The triangle, with normals and texture coordinates, in several nodes.
fn several() -> Value {
    let mut document = triangle();
    let normals = add_floats(&mut document, &[0.0, 0.6, 0.8, 0.0, 0.0, 1.0, 0.8, 0.0, 0.6], "VEC3", 3);
    let uvs = add_floats(&mut document, &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0], "VEC2", 3);
    let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
    (attributes["NORMAL"], attributes["TEXCOORD_0"]) = (json!(normals), json!(uvs));
    document["nodes"] = json!([
        {"mesh": 0, "name": "first"},
        {"mesh": 0, "name": "moved", "translation": [3, 0, 1], "rotation": [0, 0.6, 0, 0.8]},
        {"mesh": 0, "name": "mirrored", "scale": [-1, 2, 0.5], "translation": [0, 4, 0]},
        {"name": "parent", "translation": [0, 0, 5], "rotation": [0.6, 0, 0, 0.8], "children": [4]},
        {"mesh": 0, "name": "child", "scale": [1, 3, 1]},
    ]);
    document["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    document
}

#[test]
fn nodes_share_a_mesh() {
    assert_eq!(same(&several()), 4);
    let [shared, _] = both(&several());
    let mesh = &shared.geometry.mesh;
    // Once as it is, and once with its corners in reverse order.
    assert_eq!((mesh.triangles.len(), mesh.triangle_count(), mesh.own_triangles().count()), (2, 4, 0));
    assert_eq!(
        mesh.instances.list().iter().map(|instance| instance.first - FIRST_INSTANCED).collect::<Vec<_>>(),
        [0, 1, 2, 3]
    );
    let info = shared.info();
    assert_eq!((info.triangles, info.instances), (4, 4));
}

#[test]
fn instances_of_a_node_share_its_mesh() {
    assert_eq!(same(&instanced()), 2);
}

#[test]
fn few_triangles_are_copied_unless_asked_for() {
    assert!(open(&several()).geometry.mesh.instances.is_empty());
}

#[test]
fn instances_go_with_nodes_that_move() {
    let mut document = several();
    animate(&mut document, "way", 1, "translation", &[3.0, 0.0, 1.0, 5.0, 1.0, 1.0], "LINEAR");
    animate(&mut document, "turn", 3, "rotation", &[0.6, 0.0, 0.0, 0.8, 0.0, 0.6, 0.0, 0.8], "LINEAR");
    assert_eq!(same(&document), 4);
    let mut document = instanced();
    animate(&mut document, "way", 0, "translation", &[10.0, 0.0, 0.0, 12.0, 1.0, 0.0], "LINEAR");
    assert_eq!(same(&document), 2);
}

#[test]
fn what_is_enlarged_over_time_is_copied() {
    let mut document = several();
    animate(&mut document, "grow", 3, "scale", &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], "LINEAR");
    assert_eq!(same(&document), 3);
}

#[test]
fn flat_places_are_copied() {
    let mut document = several();
    document["nodes"][1]["scale"] = json!([1, 0, 1]);
    assert_eq!(same(&document), 3);
}

#[test]
fn lamps_shine_in_each_place() {
    let mut document = several();
    document["materials"] = json!([{"emissiveFactor": [1, 1, 1]}]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    assert_eq!(same(&document), 4);
    animate(&mut document, "way", 1, "translation", &[3.0, 0.0, 1.0, 5.0, 1.0, 1.0], "LINEAR");
    let lights = |scene: &Scene| -> Vec<String> {
        let rounded = |v: Vec3| (v * 1e3).round() + 0.0;
        let light = |light: &Light| {
            let place = rounded(light.position().unwrap());
            format!("{place} {} {}", rounded(light.surface.unwrap()), rounded(light.intensity))
        };
        let mut all: Vec<String> = scene.lights.iter().map(light).collect();
        all.sort();
        all
    };
    let [shared, copied] = both(&document);
    assert!(!shared.lights.is_empty() && lights(&shared) != lights(&shared.at(1.0)));
    for time in [0.0, 1.0] {
        assert_eq!(lights(&shared.at(time)), lights(&copied.at(time)));
    }
}
