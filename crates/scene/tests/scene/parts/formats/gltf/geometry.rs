//! Accessors, primitives, nodes and instances.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec3, Vec2, Vec3};
use serde_json::json;

use super::*;

#[test]
fn a_data_uri_with_byte_indices_is_read() {
    let scene = open(&triangle());
    assert_eq!(scene.geometry.mesh.triangles.len(), 1);
    assert_eq!(scene.geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    // glTF's default material is a white rough metal.
    assert_eq!((scene.geometry.materials.len(), scene.geometry.materials[0].kd), (1, Vec3::ONE));
}

#[test]
fn a_mesh_without_indices_is_read() {
    let mut document = triangle();
    document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}});
    assert_eq!(open(&document).geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn nested_nodes_keep_the_digits_of_the_file() {
    let mut document = triangle();
    document["scenes"][0]["nodes"] = json!([1]);
    document["nodes"] = json!([
        {"mesh": 0, "scale": [2, 2, 2]},
        {"children": [2], "translation": [1000000.125, -300000.0625, 0]},
        {"children": [0], "rotation": [0, 0, (FRAC_PI_2 / 2.0).sin(), (FRAC_PI_2 / 2.0).cos()]},
    ]);
    let scene = open(&document);
    let corners =
        scene.geometry.mesh.corners(0).map(|c| scene.to_world(c) - DVec3::new(1_000_000.125, -300_000.062_5, 0.0));
    let expected = [DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)];
    for (corner, expected) in corners.iter().zip(expected) {
        assert!(corner.distance(expected) < 1e-6, "{corners:?}");
    }
}

#[test]
fn a_mirroring_node_keeps_the_front() {
    let mut document = triangle();
    document["nodes"][0]["scale"] = json!([1, 1, -1]);
    let [a, b, c] = open(&document).geometry.mesh.corners(0);
    assert!((b - a).cross(c - a).z < 0.0);
}

#[test]
fn quantized_positions_are_read() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let bytes: Vec<u8> = [0u16, 0, 0, 65535, 0, 0, 0, 65535, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    document["buffers"][0] = json!({"byteLength": 18, "uri": format!("data:;base64,{}", STANDARD.encode(bytes))});
    document["bufferViews"] = json!([{"buffer": 0, "byteLength": 18}]);
    document["accessors"] = json!([{"bufferView": 0, "componentType": 5123, "normalized": true, "count": 3,
        "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]);
    document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0}});
    assert_eq!(open(&document).geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn indices_of_all_widths_are_read() {
    for (component, bytes) in [
        (UNSIGNED_BYTE, vec![2, 0, 1]),
        (UNSIGNED_SHORT, vec![2, 0, 0, 0, 1, 0]),
        (UNSIGNED_INT, vec![2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]),
    ] {
        let mut document = triangle();
        let indices = add_accessor(&mut document, &bytes, component, "SCALAR", 3);
        document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        assert_eq!(open(&document).geometry.mesh.corners(0), [Vec3::Y, Vec3::ZERO, Vec3::X], "{component}");
    }
}

#[test]
fn indices_that_lie_askew_are_read() {
    let mut document = triangle();
    let indices = add_accessor(&mut document, &[9, 2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0], UNSIGNED_INT, "SCALAR", 3);
    document["accessors"][indices]["byteOffset"] = json!(1);
    document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    assert_eq!(open(&document).geometry.mesh.triangles, [[2, 0, 1]]);
}

#[test]
fn strips_and_fans_are_cut_with_and_without_indices() {
    let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];
    for (mode, expected) in [(4, vec![[0, 1, 2]]), (5, vec![[0, 1, 2], [1, 3, 2]]), (6, vec![[1, 2, 0], [2, 3, 0]])] {
        let mut document = triangle();
        let positions = add_floats(&mut document, &corners, "VEC3", 4);
        document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": positions}, "mode": mode});
        assert_eq!(open(&document).geometry.mesh.triangles, expected);
        let indices = add_accessor(&mut document, &[0, 1, 2, 3], UNSIGNED_BYTE, "SCALAR", 4);
        document["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        assert_eq!(open(&document).geometry.mesh.triangles, expected);
    }
}

#[test]
fn interleaved_attributes_are_read() {
    let mut document = triangle();
    let vertex = |x: f32, y: f32| [x, y, 0.0, 0.0, 0.0, 2.0, x, 1.0 - y];
    let numbers = [vertex(0.0, 0.0), vertex(1.0, 0.0), vertex(0.0, 1.0)].concat();
    let position = add_floats(&mut document, &numbers, "VEC3", 3);
    let view = document["accessors"][position]["bufferView"].clone();
    document["bufferViews"][view.as_u64().unwrap() as usize]["byteStride"] = json!(32);
    for (kind, offset) in [("VEC3", 12), ("VEC2", 24)] {
        let accessors = document["accessors"].as_array_mut().unwrap();
        accessors
            .push(json!({"bufferView": view, "componentType": FLOAT, "count": 3, "type": kind, "byteOffset": offset}));
    }
    document["meshes"][0]["primitives"][0]["attributes"] =
        json!({"POSITION": position, "NORMAL": position + 1, "TEXCOORD_0": position + 2});
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!(mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.uvs, [Vec2::Y, Vec2::ONE, Vec2::ZERO]);
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut document = triangle();
    let indices = add_view(&mut document, &[1]);
    let values = add_view(&mut document, &bytes_of(&[5.0, 6.0, 7.0]));
    document["accessors"][0]["sparse"] = json!({"count": 1, "values": {"bufferView": values},
        "indices": {"bufferView": indices, "componentType": UNSIGNED_BYTE}});
    assert_eq!(open(&document).geometry.mesh.corners(0), [Vec3::ZERO, Vec3::new(5.0, 6.0, 7.0), Vec3::Y]);
}

#[test]
fn sparse_indices_replace_indices() {
    let mut document = triangle();
    let at = add_view(&mut document, &[0, 0, 2, 0]);
    let values = add_view(&mut document, &[2, 0]);
    document["accessors"][1]["sparse"] = json!({"count": 2, "values": {"bufferView": values},
        "indices": {"bufferView": at, "componentType": UNSIGNED_SHORT}});
    assert_eq!(open(&document).geometry.mesh.triangles, [[2, 1, 0]]);
}

#[test]
fn an_accessor_without_a_view_is_zeros_where_nothing_replaces_it() {
    let mut document = triangle();
    let indices = add_view(&mut document, &[1, 2]);
    let values = add_view(&mut document, &bytes_of(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    document["accessors"][0] = json!({"componentType": FLOAT, "count": 3, "type": "VEC3", "sparse": {"count": 2,
        "values": {"bufferView": values}, "indices": {"bufferView": indices, "componentType": UNSIGNED_BYTE}}});
    assert_eq!(open(&document).geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn normals_and_coordinates_may_be_quantized() {
    let mut document = triangle();
    let normals = add_accessor(&mut document, &[0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0], BYTE, "VEC3", 3);
    let view = document["accessors"][normals]["bufferView"].as_u64().unwrap() as usize;
    document["bufferViews"][view]["byteStride"] = json!(4);
    document["accessors"][normals]["normalized"] = json!(true);
    let shorts: Vec<u8> = [0i16, 16384, 32767, 0, -32768, 1].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uvs = add_accessor(&mut document, &shorts, SHORT, "VEC2", 3);
    document["accessors"][uvs]["normalized"] = json!(true);
    document["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0, "NORMAL": normals, "TEXCOORD_0": uvs});
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(mesh.uvs[1..], [Vec2::X, Vec2::new(-1.0, 1.0 / 32767.0)]);
}

#[test]
fn quantized_positions_need_not_be_normalized() {
    let mut document = triangle();
    let positions = add_accessor(&mut document, &[0, 0, 0, 200, 0, 0, 0, 100, 0], UNSIGNED_BYTE, "VEC3", 3);
    document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(positions);
    document["nodes"][0]["scale"] = json!([0.01, 0.01, 0.01]);
    let corners = open(&document).geometry.mesh.corners(0);
    assert!(corners[1].distance(2.0 * Vec3::X) < 1e-6 && corners[2].distance(Vec3::Y) < 1e-6, "{corners:?}");
}

#[test]
fn one_mesh_in_two_nodes_is_there_twice() {
    let mut document = triangle();
    document["scenes"][0]["nodes"] = json!([0, 1]);
    document["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 5]}]);
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.corners(1)[0], 5.0 * Vec3::Z);
}

#[test]
fn a_matrix_is_read_by_columns() {
    let mut document = triangle();
    document["nodes"][0]["matrix"] = json!([0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 7, 8, 9, 1]);
    let corners = open(&document).geometry.mesh.corners(0);
    assert_eq!(corners, [Vec3::new(7.0, 8.0, 9.0), Vec3::new(7.0, 10.0, 9.0), Vec3::new(5.0, 8.0, 9.0)]);
}

#[test]
fn a_matrix_that_is_transposed_is_told() {
    let mut document = triangle();
    document["nodes"][0]["matrix"] = json!([1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9, 0, 0, 0, 1]);
    let warnings = open(&document).warnings;
    assert!(warnings.iter().any(|warning| warning.contains("node 0 ends in the row [7, 8, 9, 1]")), "{warnings:?}");
}

/// The triangle in a node with instances.
pub(super) fn instanced() -> serde_json::Value {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    document["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let translation = add_floats(&mut document, &[0.0, 0.0, 0.0, 0.0, 0.0, 3.0], "VEC3", 2);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let rotation = add_floats(&mut document, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half], "VEC4", 2);
    let scale = add_floats(&mut document, &[1.0, 1.0, 1.0, 2.0, 4.0, 1.0], "VEC3", 2);
    let attributes = json!({"TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale, "_ID": 0});
    document["nodes"] = json!([{"mesh": 0, "translation": [10, 0, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}]);
    document
}

#[test]
fn instances_stand_below_their_node() {
    let mesh = open(&instanced()).geometry.mesh.clone();
    assert_eq!(mesh.triangles.len(), 2);
    let node = 10.0 * Vec3::X;
    assert_eq!(mesh.corners(0), [node, node + Vec3::X, node + Vec3::Y]);
    // Scaled by (2, 4), turned from x to y, moved by 3 along z.
    let expected = [Vec3::new(10.0, 0.0, 3.0), Vec3::new(10.0, 2.0, 3.0), Vec3::new(6.0, 0.0, 3.0)];
    for (corner, expected) in mesh.corners(1).into_iter().zip(expected) {
        assert!(corner.distance(expected) < 1e-5, "{corner}");
    }
}

#[test]
fn rotations_of_instances_may_be_quantized() {
    let mut document = instanced();
    let rotation = add_accessor(&mut document, &[0, 0, 0, 127, 0, 0, 90, 90], BYTE, "VEC4", 2);
    document["accessors"][rotation]["normalized"] = json!(true);
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = json!(rotation);
    assert!(open(&document).geometry.mesh.corners(1)[1].distance(Vec3::new(10.0, 2.0, 3.0)) < 1e-5);
}

#[test]
fn instances_by_unequal_attributes_are_refused() {
    let mut document = instanced();
    let scale = document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"].as_u64().unwrap();
    document["accessors"][scale as usize]["count"] = json!(1);
    assert!(error(&document).contains("the instances of node 0 are 2 by one attribute and 1 by another"));
}

#[test]
fn instances_without_a_place_show_as_one() {
    let mut document = instanced();
    document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json!({"_ID": 0});
    assert_eq!(open(&document).geometry.mesh.triangles.len(), 1);
}

#[test]
fn a_chain_of_very_many_nodes_is_no_recursion() {
    const LENGTH: usize = 100_000;
    let mut document = triangle();
    let mut nodes: Vec<_> = (1..LENGTH).map(|child| json!({"children": [child], "translation": [0.5, 0, 0]})).collect();
    nodes.push(json!({"mesh": 0}));
    document["nodes"] = json!(nodes);
    let scene = open(&document);
    assert_eq!(scene.to_world(scene.geometry.mesh.corners(0)[0]), DVec3::new(0.5 * (LENGTH - 1) as f64, 0.0, 0.0));
}

#[test]
fn a_file_without_scenes_shows_all_roots() {
    let mut document = triangle();
    document.as_object_mut().unwrap().retain(|key, _| key != "scene" && key != "scenes");
    document["nodes"] = json!([{"mesh": 0}, {"children": [0], "translation": [1, 0, 0]}, {"mesh": 0}]);
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!((mesh.triangles.len(), mesh.corners(0)[0]), (2, Vec3::X));
}

#[test]
fn of_several_scenes_the_named_one_is_read() {
    let mut document = triangle();
    document["scenes"] = json!([{"nodes": []}, {"nodes": [0]}]);
    document["scene"] = json!(1);
    assert_eq!(open(&document).geometry.mesh.triangles.len(), 1);
    assert!(warnings(&document).contains("of 2 scenes only scene 1 is loaded"));
}

#[test]
fn a_flat_node_has_triangles_without_normals() {
    let mut document = triangle();
    let normals = add_floats(&mut document, &[0.0, 1.0, 1.0].repeat(3), "VEC3", 3);
    document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    document["nodes"][0]["scale"] = json!([1, 1, 0]);
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!((mesh.triangles.len(), &mesh.normals[..]), (1, &[Vec3::ZERO; 3][..]));
}

#[test]
fn primitives_without_triangles_are_counted_or_nothing() {
    let mut document = triangle();
    let primitives = &mut document["meshes"][0]["primitives"];
    *primitives = json!([{"attributes": {"POSITION": 0}, "mode": 0}, {"attributes": {"POSITION": 0}, "mode": 3},
        {"attributes": {}}, {"attributes": {"POSITION": 0}, "indices": 1}]);
    assert_eq!(open(&document).geometry.mesh.triangles.len(), 1);
    let warnings = warnings(&document);
    assert!(warnings.contains("2 primitives of points or lines: ignored"), "{warnings}");
    assert!(warnings.contains("1 primitive without positions: ignored"), "{warnings}");
}

/// Each used to copy all vertices: memory grew with the square of the file.
#[test]
fn parts_of_shared_vertices_hold_only_their_own() {
    const PARTS: usize = 500;
    let mut document = triangle();
    let numbers: Vec<f32> = (0..3 * PARTS).flat_map(|vertex| [vertex as f32, (vertex % 3) as f32, 0.5]).collect();
    let (positions, normals) = (add_floats(&mut document, &numbers, "VEC3", 3 * PARTS), 3 + PARTS);
    let primitives: Vec<_> = (0..PARTS)
        .map(|part| {
            // The last corner first.
            let corners: Vec<u8> = (0..3).rev().flat_map(|corner| (3 * part as u16 + corner).to_le_bytes()).collect();
            let indices = add_accessor(&mut document, &corners, UNSIGNED_SHORT, "SCALAR", 3);
            json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices})
        })
        .collect();
    // Zeros, of which one is replaced.
    let at = add_view(&mut document, &[4, 0, 1, 0]);
    let values = add_view(&mut document, &bytes_of(&[0.0, 1.0, 0.0, 0.0, 0.0, 3.0]));
    assert_eq!(document["accessors"].as_array().unwrap().len(), normals);
    document["accessors"].as_array_mut().unwrap().push(json!({"componentType": FLOAT, "count": 3 * PARTS,
        "type": "VEC3", "sparse": {"count": 2, "values": {"bufferView": values},
        "indices": {"bufferView": at, "componentType": UNSIGNED_SHORT}}}));
    document["meshes"][0]["primitives"] = json!(primitives);
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (PARTS, 3 * PARTS));
    for part in [0, 1, PARTS - 1] {
        let corners = [2, 1, 0].map(|corner| Vec3::new((3 * part + corner) as f32, corner as f32, 0.5));
        assert_eq!(mesh.corners(part), corners);
    }
    assert_eq!((mesh.normals[1], mesh.normals[4]), (Vec3::Z, Vec3::Y));
}
