//! Extensions that are required or used.

use super::*;

#[test]
fn unknown_required_extensions_are_refused_by_name() {
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu", "ACME_anything"] {
        let mut document = triangle();
        document["extensionsUsed"] = json!([name]);
        document["extensionsRequired"] = json!([name]);
        let message = error(&document);
        assert!(
            message.starts_with(&format!("the file requires the extension {name}, model.gltf; export it")),
            "{message}"
        );
        assert!(message.contains("KHR_lights_punctual"), "{message}");
    }
}

#[test]
fn unknown_used_extensions_are_one_warning() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_materials_sheen", "KHR_lights_punctual", "KHR_draco_mesh_compression"]);
    let scene = open(&document);
    let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    assert!(warning.ends_with("are ignored: KHR_materials_sheen, KHR_draco_mesh_compression"), "{warning}");
}

#[test]
fn known_extensions_may_be_required() {
    let mut document = triangle();
    let known = json!([
        "EXT_mesh_gpu_instancing",
        "KHR_lights_punctual",
        "KHR_materials_emissive_strength",
        "KHR_materials_unlit",
        "KHR_mesh_quantization",
        "KHR_texture_transform"
    ]);
    document["extensionsUsed"] = known.clone();
    document["extensionsRequired"] = known;
    assert!(open(&document).warnings.is_empty());
}

#[test]
fn an_extension_that_packs_the_shape_leaves_no_shape_without_it() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
    document["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    document["accessors"][0]["count"] = json!(24_000);
    assert!(error(&document).contains("accessor 0 has 24000 elements, but no buffer view"));
}

#[test]
fn strict_reading_ends_at_what_is_not_shown() {
    let mut document = triangle();
    document["extensionsUsed"] = json!(["KHR_materials_sheen"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.gltf");
    fs::write(&path, document.to_string()).unwrap();
    let strict = LoadOptions::default().with_strict(true);
    assert!(Scene::open_with(&path, &strict).unwrap_err().to_string().contains("KHR_materials_sheen"));
}
