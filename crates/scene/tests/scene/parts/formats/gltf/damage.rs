//! Files that are inconsistent, truncated, or malicious.

use std::fs;

use serde_json::{Value, json};

use super::*;

#[test]
fn nodes_that_are_no_tree_are_refused() {
    for children in [json!([0]), json!([1, 1])] {
        let mut document = triangle();
        document["nodes"] = json!([{"mesh": 0, "children": children}, {"mesh": 0}]);
        assert!(error(&document).contains("nodes must form a tree"));
    }
}

#[test]
fn an_unknown_required_extension_is_refused_by_name() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    document["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(error(&document).contains("KHR_draco_mesh_compression, model.gltf; "));
}

#[test]
fn ranges_that_do_not_fit_are_refused() {
    #[rustfmt::skip]
    let changes: [(&str, Value, &str); 21] = [
        ("/meshes/0/primitives/0/attributes/POSITION", json!(9), "accessor 9 is referenced, but does not exist"),
        ("/accessors/0/count", json!(4), "accessor 0 reaches beyond its buffer"),
        ("/accessors/0/count", json!(u64::MAX), "accessor 0 reaches beyond its buffer"),
        ("/accessors/0/byteOffset", json!(u64::MAX - 8), "accessor 0 reaches beyond its buffer"),
        ("/accessors/1/bufferView", json!(7), "buffer view 7 is not there"),
        ("/accessors/1/count", json!(9), "accessor 1 reaches beyond its buffer"),
        ("/accessors/1/componentType", json!(5126), "reaches beyond|does not contain unsigned integers"),
        ("/accessors/0/type", json!("VEC2"), "has type VEC2 where VEC3 is expected"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "reaches beyond its buffer"),
        ("/bufferViews/0/byteStride", json!(8), "8 bytes apart"),
        ("/buffers/0/byteLength", json!(400), "buffer 0 has 39 of 400 bytes"),
        ("/buffers/0/uri", json!("missing.bin"), "missing.bin; check that it exists"),
        ("/buffers/0/uri", json!("data:;base64,*"), "the data URI of buffer 0 cannot be decoded"),
        ("/buffers/0/uri", json!("../model.bin"), "leads outside the scene's folder"),
        ("/buffers/0/uri", json!("https://example.org/model.bin"), "leads outside the scene's folder"),
        ("/bufferViews/0/buffer", json!(3), "there is no buffer 3"),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), "buffer view 0 reaches beyond its buffer of 39 bytes"),
        ("/accessors/1/componentType", json!(5124), "accessor 1 has the component type 5124"),
        ("/accessors/0/type", json!("MAT3"), "accessor 0 has type MAT3, which is not valid here"),
        ("/meshes/0/primitives/0/mode", json!(7), "a primitive of mesh 0 has the mode 7"),
        ("/nodes/0/mesh", json!(1), "there is no mesh 1"),
    ];
    for (pointer, value, expected) in changes {
        let mut document = triangle();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        document.pointer_mut(parent).unwrap()[key] = value;
        let message = error(&document);
        assert!(expected.split('|').any(|expected| message.contains(expected)), "{pointer}: {message}");
        assert!(message.contains("; "), "{message}");
    }
}

#[test]
fn a_stride_of_zero_means_none() {
    let mut document = triangle();
    document["bufferViews"][0]["byteStride"] = json!(0);
    assert_eq!(open(&document).geometry.mesh.corners(0), open(&triangle()).geometry.mesh.corners(0));
    assert!(warnings(&document).ends_with("model.gltf: 1 buffer view with a byteStride of 0: read without gaps"));
}

#[test]
fn damage_in_a_buffer_names_the_scene_too() {
    let mut document = triangle();
    document["buffers"][0]["uri"] = json!("missing.bin");
    assert!(error(&document).ends_with("missing.bin; check that it exists and is readable (named by model.gltf)"));
}

#[test]
fn an_index_beyond_the_vertices_is_refused() {
    let mut document = triangle();
    // The positions read as indices.
    document["accessors"][1]["bufferView"] = json!(0);
    document["accessors"][1]["byteOffset"] = json!(14);
    assert!(error(&document).contains("a primitive refers to vertex 128 of 3"), "{}", error(&document));
}

/// Bytes changed at random: an error or a scene, never a panic and never a hang.
#[test]
fn damaged_files_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.glb");
    let text = furnished().to_string();
    try_open(text.as_bytes()).unwrap().export(&path).unwrap();
    let glb = fs::read(&path).unwrap();
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut refused = 0;
    for whole in [text.as_bytes(), &glb[..]] {
        for _ in 0..1500 {
            let mut bytes = whole.to_vec();
            for _ in 0..1 + random(3) {
                let at = random(bytes.len());
                bytes[at] = if random(2) == 0 { random(256) as u8 } else { b'0' + random(10) as u8 };
            }
            if random(8) == 0 {
                bytes.truncate(random(bytes.len()));
            }
            refused += usize::from(try_open(&bytes).is_err());
        }
    }
    assert!(refused > 1000, "{refused}");
}

#[test]
fn references_between_nodes_and_scenes_are_checked() {
    for (pointer, value, expected) in [
        ("/scene", json!(5), "there is no scene 5: the file has 1"),
        ("/scenes/0/nodes", json!([4]), "there is no node 4"),
        ("/nodes", json!([{"children": [9]}]), "there is no node 9"),
        ("/nodes", json!([{"children": [1]}, {"children": [2]}, {"children": [0]}]), "is its own ancestor"),
    ] {
        let mut document = triangle();
        *document.pointer_mut(pointer).unwrap() = value;
        assert!(error(&document).contains(expected), "{pointer}: {}", error(&document));
    }
}

#[test]
fn nodes_in_a_circle_without_a_root_are_refused() {
    let mut document = triangle();
    document.as_object_mut().unwrap().retain(|key, _| key != "scene" && key != "scenes");
    document["nodes"] = json!([{"mesh": 0, "children": [1]}, {"children": [0]}]);
    assert!(error(&document).contains("every node is the child of another"));
}

#[test]
fn numbers_that_json_does_not_know_are_refused_with_their_line() {
    for number in ["NaN", "1e999", "-Infinity", "null", "\"1\""] {
        let text =
            triangle().to_string().replace("\"mesh\":0", &format!("\"mesh\":0,\n\"translation\":[{number},0,0]"));
        let message = try_open(text.as_bytes()).unwrap_err();
        assert!(message.contains("model.gltf:2; export the file again"), "{number}: {message}");
    }
}

#[test]
fn places_too_far_to_compute_with_are_left_out() {
    for transform in [json!({"translation": [1e300, 0, 0]}), json!({"scale": [1e308, 1e308, 1e308]})] {
        let mut document = triangle();
        document["nodes"][0].as_object_mut().unwrap().extend(transform.as_object().unwrap().clone());
        assert!(open(&document).geometry.mesh.triangles.is_empty());
        assert!(warnings(&document).contains("1 triangles with infinite, undefined or far too large"));
    }
}

#[test]
fn vertices_that_are_no_numbers_are_left_out() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        let mut document = triangle();
        let numbers = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, bad, 0.0, 0.0];
        let positions = add_floats(&mut document, &numbers, "VEC3", 4);
        let indices = add_accessor(&mut document, &[0, 1, 2, 2, 1, 3], UNSIGNED_BYTE, "SCALAR", 6);
        document["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": positions}, "indices": indices});
        assert_eq!(open(&document).geometry.mesh.triangles, [[0, 1, 2]], "{bad}");
        assert!(warnings(&document).contains("1 triangles with infinite"), "{bad}");
    }
}

#[test]
fn a_rotation_without_a_length_turns_nothing() {
    let mut document = triangle();
    document["nodes"][0]["rotation"] = json!([0, 0, 0, 0]);
    assert_eq!(open(&document).geometry.mesh.corners(0)[1], glam::Vec3::X);
}

#[test]
fn a_node_of_no_size_is_a_point() {
    let mut document = triangle();
    document["nodes"][0]["scale"] = json!([0, 0, 0]);
    assert_eq!(open(&document).geometry.mesh.corners(0), [glam::Vec3::ZERO; 3]);
}

#[test]
fn huge_counts_without_bytes_are_refused() {
    for count in [1u64 << 20, u64::from(u32::MAX), u64::MAX] {
        let mut document = triangle();
        document["accessors"][0] = json!({"componentType": FLOAT, "count": count, "type": "VEC3"});
        assert!(error(&document).contains(&format!("accessor 0 has {count} elements, but no buffer view")));
        let mut document = triangle();
        document["accessors"][1] = json!({"componentType": UNSIGNED_INT, "count": count, "type": "SCALAR"});
        assert!(error(&document).contains("but no buffer view"));
    }
}

#[test]
fn sparse_parts_that_do_not_fit_are_refused() {
    let sparse = |change: &dyn Fn(&mut Value)| {
        let mut document = triangle();
        let indices = add_view(&mut document, &[3]);
        let values = add_view(&mut document, &bytes_of(&[5.0, 6.0, 7.0]));
        document["accessors"][0]["sparse"] = json!({"count": 1, "values": {"bufferView": values},
            "indices": {"bufferView": indices, "componentType": UNSIGNED_BYTE}});
        change(&mut document["accessors"][0]["sparse"]);
        error(&document)
    };
    assert!(sparse(&|_| ()).contains("accessor 0 has 3 elements, but its sparse part replaces number 3"));
    assert!(
        sparse(&|sparse| sparse["count"] = json!(u64::MAX)).contains("3 elements, but its sparse part replaces 1844")
    );
    assert!(sparse(&|sparse| sparse["count"] = json!(2)).contains("reaches beyond its buffer view"));
    assert!(sparse(&|sparse| sparse["indices"]["componentType"] = json!(FLOAT)).contains("are not unsigned integers"));
    assert!(sparse(&|sparse| sparse["values"]["bufferView"] = json!(99)).contains("buffer view 99 is not there"));
}

#[test]
fn attributes_of_other_lengths_are_refused() {
    for (name, kind, message) in
        [("NORMAL", "VEC3", "2 normals"), ("TEXCOORD_0", "VEC2", "2 texture"), ("COLOR_0", "VEC4", "2 colours")]
    {
        let mut document = triangle();
        let accessor = add_floats(&mut document, &[0.5; 8], kind, 2);
        document["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
        assert!(error(&document).contains(message), "{}", error(&document));
        assert!(error(&document).contains("for 3 vertices"));
    }
}

#[test]
fn instances_of_nothing_take_no_memory() {
    let mut document = triangle();
    document["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}, "mode": 0}]);
    let rotations = add_accessor(&mut document, &vec![1u8; 4 << 20], BYTE, "VEC4", 1 << 20);
    let node = json!({"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"ROTATION": rotations}}}});
    document["nodes"] = json!(vec![node; 5000]);
    document["scenes"][0]["nodes"] = json!((0..5000).collect::<Vec<_>>());
    assert!(warnings(&document).contains("5000 primitives of points or lines"));
}

#[test]
fn a_long_name_is_not_kept_in_every_node() {
    let mut document = furnished();
    document["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = json!("lamp ".repeat(100_000));
    document["cameras"][0]["name"] = json!("ü".repeat(100_000));
    let scene = open(&document);
    assert!(scene.lights[0].name.starts_with("lamp lamp") && scene.lights[0].name.len() == 200);
    assert_eq!(scene.cameras[0].name.chars().count(), 200);
}

/// Nodes times primitives times vertices, from a small file: rejected at once, and not only when memory is full.
#[test]
fn a_few_triangles_in_very_many_places_are_refused() {
    let mut document = triangle();
    let many = add_floats(&mut document, &[0.0; 3 * 3000], "VEC3", 3000);
    document["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {"POSITION": many}}); 2000]);
    document["nodes"] = json!(vec![json!({"mesh": 0}); 2000]);
    document["scenes"][0]["nodes"] = json!((0..2000).collect::<Vec<_>>());
    assert!(error(&document).contains("more than 4294967295 vertices or triangles"));
}

#[test]
fn a_mesh_with_very_many_instances_is_refused() {
    let mut document = triangle();
    let many = add_floats(&mut document, &[0.0; 3 * 3000], "VEC3", 3000);
    document["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {"POSITION": many}}); 1000]);
    let bytes = vec![0u8; 3 * 4000];
    let places = add_accessor(&mut document, &bytes, UNSIGNED_BYTE, "VEC3", 4000);
    document["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}});
    assert!(error(&document).contains("more than 4294967295 vertices or triangles"));
}

#[test]
fn very_many_primitives_without_triangles_take_no_time() {
    let mut document = triangle();
    document["meshes"][0]["primitives"] = json!(vec![json!({"attributes": {"POSITION": 0}, "mode": 1}); 20_000]);
    document["nodes"] = json!(vec![json!({"mesh": 0}); 20_000]);
    document["scenes"][0]["nodes"] = json!((0..20_000).collect::<Vec<_>>());
    assert!(warnings(&document).contains("400000000 primitives of points or lines: ignored"));
}

#[test]
fn json_nested_without_end_is_refused() {
    for nested in ["[", "{\"a\":"] {
        let text = triangle().to_string().replacen("{", &format!("{{\"extras\":{},", nested.repeat(200_000)), 1);
        assert!(try_open(text.as_bytes()).unwrap_err().contains("the JSON cannot be read as glTF"));
    }
    // Deeply nested extras are skipped without recursion, including those of a material.
    let mut text = triangle().to_string();
    let deep = format!("{}{}", "[".repeat(200_000), "]".repeat(200_000));
    text = text.replacen('{', &format!("{{\"materials\":[{{\"extras\":{deep}}}],\"extras\":{deep},"), 1);
    assert_eq!(try_open(text.as_bytes()).unwrap().geometry.mesh.triangles.len(), 1);
}

/// Truncated everywhere: an error that names the file, never a panic.
#[test]
fn files_cut_off_at_every_byte_are_refused() {
    let (json, bin) = separate();
    let whole = glb(&[(b"JSON", json.as_bytes()), (b"BIN\0", &bin)]);
    assert_eq!(try_open(&whole).unwrap().geometry.mesh.triangles.len(), 1);
    for length in 0..whole.len() {
        let message = try_open(&whole[..length]).expect_err("cut off");
        assert!(message.contains("model.gltf") && message.contains("; "), "{length}: {message}");
    }
    let text = furnished().to_string();
    for length in (0..text.len()).step_by(7) {
        assert!(try_open(&text.as_bytes()[..length]).unwrap_err().contains("model.gltf"), "{length}");
    }
}

/// Every number of the document replaced by bad ones in turn.
#[test]
fn bad_numbers_everywhere_never_panic() {
    fn numbers(value: &Value, path: String, found: &mut Vec<String>) {
        match value {
            Value::Object(entries) => {
                entries.iter().for_each(|(key, value)| numbers(value, format!("{path}/{key}"), found))
            }
            Value::Array(items) => {
                (0..).zip(items).for_each(|(i, value): (usize, _)| numbers(value, format!("{path}/{i}"), found))
            }
            Value::Number(_) => found.push(path),
            _ => {}
        }
    }
    let document = furnished();
    let mut pointers = Vec::new();
    numbers(&document, String::new(), &mut pointers);
    assert!(pointers.len() > 60);
    for pointer in pointers {
        for bad in
            [json!(-1), json!(4), json!(u32::MAX), json!(u64::MAX), json!(0.5), json!(1e308), json!(null), json!([])]
        {
            let mut changed = document.clone();
            *changed.pointer_mut(&pointer).unwrap() = bad;
            if let Err(message) = try_open(changed.to_string().as_bytes()) {
                assert!(message.contains("; "), "{pointer}: {message}");
            }
        }
    }
}
