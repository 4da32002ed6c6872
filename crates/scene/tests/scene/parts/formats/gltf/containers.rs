//! GLB and JSON as files: lengths, chunks, versions, encodings and external files.

use super::*;

fn triangles(bytes: &[u8]) -> usize {
    try_open(bytes).unwrap().geometry.mesh.triangles.len()
}

fn refused(bytes: &[u8]) -> String {
    try_open(bytes).unwrap_err()
}

#[test]
fn a_binary_file_is_read_whatever_its_ending() {
    let (json, bin) = separate();
    assert_eq!(triangles(&glb(&[(b"JSON", json.as_bytes()), (b"BIN\0", &bin)])), 1);
}

#[test]
fn a_json_file_may_be_called_glb() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.GLB");
    fs::write(&path, triangle().to_string()).unwrap();
    assert_eq!(Scene::open(path).unwrap().geometry.mesh.triangles.len(), 1);
}

#[test]
fn what_follows_the_chunks_is_ignored() {
    let (json, bin) = separate();
    let mut bytes = glb(&[(b"JSON", json.as_bytes()), (b"BIN\0", &bin), (b"MORE", b"anything")]);
    bytes.extend(b"trailing bytes beyond the stated length");
    assert_eq!(triangles(&bytes), 1);
}

#[test]
fn a_second_chunk_of_another_kind_is_not_the_binary_one() {
    let (json, bin) = separate();
    let message = refused(&glb(&[(b"JSON", json.as_bytes()), (b"MORE", &bin)]));
    assert!(message.contains("buffer 0 has no data"), "{message}");
}

#[test]
fn padding_of_either_kind_is_taken_off() {
    let (json, bin) = separate();
    for padding in ["  ", "\0\0\0", "\n"] {
        let padded = format!("{json}{padding}");
        assert_eq!(triangles(&glb(&[(b"JSON", padded.as_bytes()), (b"BIN\0", &[&bin[..], &[0; 1]].concat())])), 1);
    }
}

#[test]
fn lengths_that_do_not_fit_are_named() {
    let (json, bin) = separate();
    let whole = glb(&[(b"JSON", json.as_bytes()), (b"BIN\0", &bin)]);
    let with_word = |at: usize, value: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        refused(&bytes)
    };
    for length in [whole.len() as u32 + 1, u32::MAX] {
        assert!(with_word(8, length).contains(&format!("states a length of {length} bytes, but the file has")));
    }
    for length in [0, 11, 12, 19, 20] {
        assert!(with_word(8, length).contains("too short for its JSON chunk"), "{length}");
    }
    assert!(with_word(8, whole.len() as u32 - 1).contains("too short for its second chunk"));
    assert!(with_word(12, u32::MAX).contains("too short for its JSON chunk"));
    let second = 20 + json.len();
    assert!(with_word(second, u32::MAX).contains("too short for its second chunk"));
    assert!(with_word(second, 8).contains("buffer 0 has 8 of 39 bytes"));
}

#[test]
fn a_file_without_a_json_chunk_is_refused() {
    let (json, bin) = separate();
    let message = refused(&glb(&[(b"BIN\0", &bin), (b"JSON", json.as_bytes())]));
    assert!(message.contains("does not begin with a JSON chunk"), "{message}");
    assert!(refused(b"glTF").contains("ends after 4 bytes"));
    assert!(refused(&glb(&[(b"JSON", b"")])).contains("the file contains no JSON"));
}

#[test]
fn other_versions_are_refused_by_their_number() {
    let mut bytes = glb(&[(b"JSON", b"{}")]);
    bytes[4] = 1;
    assert!(refused(&bytes).contains("the file has glTF version `1`, model.gltf; export it as glTF 2.0"));
    // Version 1 had objects where there are arrays now.
    let first = br#"{"asset": {"version": "1.0"}, "accessors": {"a": {}}, "scene": "main"}"#;
    assert!(refused(first).contains("version `1.0`"));
    let mut document = triangle();
    document["asset"]["version"] = json!("3.0");
    assert!(error(&document).contains("version `3.0`"));
    document["asset"] = json!({"version": "2.1", "minVersion": "2.1"});
    assert!(error(&document).contains("version `2.1`"));
    document["asset"] = json!({"version": "2.1", "minVersion": "2.0"});
    assert_eq!(open(&document).geometry.mesh.triangles.len(), 1);
}

#[test]
fn what_is_no_gltf_is_refused() {
    for (bytes, expected) in [
        (&b""[..], "the file contains no JSON"),
        (b"\xef\xbb\xbf", "the file contains no JSON"),
        (b"\0\0\0", "the file contains no JSON"),
        (b"solid teapot", "the JSON cannot be read as glTF"),
        (b"{}", "missing field `asset`"),
        (b"[]", "the JSON cannot be read as glTF"),
        (b"\xff\xfe{\0}\0", "the JSON cannot be read as glTF"),
        (br#"{"asset": {}}"#, "glTF version ``"),
        (br#"{"asset": {"version": "2.0"}} {}"#, "trailing characters"),
        (br#"{"asset": {"version": "2.0"}, "nodes": [], "nodes": []}"#, "duplicate field"),
        (b"{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"name\": \"\xff\"}]}", "the JSON cannot be read"),
    ] {
        let message = refused(bytes);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn a_byte_order_mark_is_taken_off() {
    let text = format!("\u{feff}{}", triangle());
    assert_eq!(triangles(text.as_bytes()), 1);
}

#[test]
fn a_file_without_nodes_is_an_empty_scene() {
    let scene = try_open(br#"{"asset": {"version": "2.0"}}"#).unwrap();
    assert!(scene.geometry.mesh.triangles.is_empty());
    assert_eq!(scene.warnings, ["the scene has no triangles"]);
}

#[test]
fn buffers_beside_the_file_have_encoded_names() {
    let (json, bin) = separate();
    let json = json.replace("\"byteLength\":39}", "\"byteLength\":39,\"uri\":\"parts/my%20b%C3%BCro.bin\"}");
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    fs::write(folder.path().join("parts/my büro.bin"), [&bin[..], b"more"].concat()).unwrap();
    let path = folder.path().join("model.gltf");
    fs::write(&path, json).unwrap();
    assert_eq!(Scene::open(&path).unwrap().geometry.mesh.triangles.len(), 1);
    fs::write(folder.path().join("parts/my büro.bin"), &bin[..38]).unwrap();
    assert!(Scene::open(&path).unwrap_err().to_string().contains("buffer 0 has 38 of 39 bytes: it is truncated"));
}

#[test]
fn a_buffer_that_nothing_needs_may_be_missing() {
    let mut document = triangle();
    document["buffers"].as_array_mut().unwrap().push(json!({"byteLength": 9, "uri": "animation.bin"}));
    assert_eq!(open(&document).geometry.mesh.triangles.len(), 1);
}

#[test]
fn a_buffer_may_lie_outside_where_that_is_allowed() {
    let (json, bin) = separate();
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scene")).unwrap();
    fs::write(folder.path().join("model.bin"), bin).unwrap();
    let path = folder.path().join("scene/model.gltf");
    fs::write(&path, json.replace("\"byteLength\":39}", "\"byteLength\":39,\"uri\":\"../model.bin\"}")).unwrap();
    assert!(Scene::open(&path).unwrap_err().to_string().contains("`../model.bin` leads outside the scene's folder"));
    let options = LoadOptions::default().with_allow_outside(true);
    assert_eq!(Scene::open_with(&path, &options).unwrap().geometry.mesh.triangles.len(), 1);
}

#[test]
fn data_of_another_media_type_is_data_all_the_same() {
    let text = triangle().to_string();
    for header in ["data:application/gltf-buffer;base64,", "data:;base64,", "DATA:text/plain;charset=x;BASE64,"] {
        assert_eq!(triangles(text.replace("data:application/octet-stream;base64,", header).as_bytes()), 1, "{header}");
    }
}
