//! Materials, textures and vertex colours.

use std::io::Cursor;

use glam::{Affine2, Vec2, Vec3};
use image::{ImageFormat, Rgba, RgbaImage};
use lightmesh_scene::{Dielectric, Facets, Material, Opacity, OpacityChannel, OpacityMode, Wrap};

use super::*;

/// An image of one texel.
fn png() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    RgbaImage::from_pixel(1, 1, Rgba([0, 128, 255, 255])).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// The triangle with a texture in a view, and two sets of texture coordinates.
fn textured() -> Value {
    let mut document = triangle();
    let view = add_view(&mut document, &png());
    let uvs = [
        add_floats(&mut document, &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0], "VEC2", 3),
        add_floats(&mut document, &[0.5; 6], "VEC2", 3),
    ];
    document["images"] = json!([{"bufferView": view, "mimeType": "image/png", "name": "sky"}]);
    document["textures"] = json!([{"source": 0}]);
    document["materials"] = json!([{"pbrMetallicRoughness":
        {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5}}]);
    let primitive = &mut document["meshes"][0]["primitives"][0];
    primitive["material"] = json!(0);
    primitive["attributes"]["TEXCOORD_0"] = json!(uvs[0]);
    primitive["attributes"]["TEXCOORD_1"] = json!(uvs[1]);
    document
}

fn info(document: &mut Value) -> &mut Value {
    &mut document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
}

#[test]
fn a_texture_in_a_view_is_read() {
    let scene = open(&textured());
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.geometry.textures[0].texels, [[0, 128, 255, 255]]);
    let found = scene.geometry.materials[0].texture.unwrap();
    assert_eq!((found.texture, found.wrap, found.transform), (0, [Wrap::Repeat; 2], Affine2::IDENTITY));
    assert_eq!(scene.geometry.mesh.uvs, [Vec2::ZERO, Vec2::X, Vec2::Y]);
}

#[test]
fn metal_and_roughness_are_facets_of_the_base_colour() {
    let material = &open(&textured()).geometry.materials[0];
    assert_eq!((material.kd, material.ks), (Vec3::new(1.0, 0.5, 0.25), Vec3::splat(Facets::LAYER)));
    assert_eq!(material.facets, Some(Facets::new(0.5).with_metallic(0.5)));
}

#[test]
fn a_texture_may_be_data_or_a_file() {
    let mut document = textured();
    document["images"] = json!([{"uri": format!("data:image/png;base64,{}", STANDARD.encode(png()))}]);
    assert_eq!(open(&document).geometry.textures.len(), 1);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("blue sky.png"), png()).unwrap();
    let path = folder.path().join("model.gltf");
    document["images"] = json!([{"uri": "blue%20sky.png"}]);
    fs::write(&path, document.to_string()).unwrap();
    let scene = Scene::open(path).unwrap();
    assert_eq!((scene.geometry.textures.len(), scene.warnings.len()), (1, 0));
}

#[test]
fn an_image_of_many_materials_is_read_once() {
    let mut document = textured();
    let material = document["materials"][0].clone();
    document["materials"].as_array_mut().unwrap().push(material);
    document["textures"].as_array_mut().unwrap().push(json!({"source": 0}));
    document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = json!(1);
    assert_eq!(open(&document).geometry.textures.len(), 1);
}

#[test]
fn samplers_say_what_lies_beyond_the_edge() {
    let mut document = textured();
    document["samplers"] = json!([{"wrapS": 33071, "wrapT": 33648}, {"wrapS": 10497}, {"wrapT": 5}]);
    for (sampler, wrap) in
        [(0, [Wrap::Clamp, Wrap::Mirror]), (1, [Wrap::Repeat; 2]), (2, [Wrap::Repeat; 2]), (9, [Wrap::Repeat; 2])]
    {
        document["textures"][0]["sampler"] = json!(sampler);
        assert_eq!(open(&document).geometry.materials[0].texture.unwrap().wrap, wrap, "{sampler}");
    }
}

#[test]
fn a_material_picks_its_set_of_coordinates() {
    let mut document = textured();
    info(&mut document)["texCoord"] = json!(1);
    assert_eq!(open(&document).geometry.mesh.uvs, [Vec2::splat(0.5); 3]);
    // The transform's own set takes precedence.
    info(&mut document)["extensions"] =
        json!({"KHR_texture_transform": {"texCoord": 0, "scale": [2, 3], "offset": [1, 0]}});
    let scene = open(&document);
    assert_eq!(scene.geometry.mesh.uvs[1], Vec2::X);
    let transform = scene.geometry.materials[0].texture.unwrap().transform;
    assert_eq!(transform.transform_point2(Vec2::ONE), Vec2::new(3.0, 3.0));
}

#[test]
fn a_texture_without_coordinates_is_left_out_of_that_primitive() {
    let mut document = textured();
    let with = document["meshes"][0]["primitives"][0].clone();
    let without = json!({"attributes": {"POSITION": 0}, "material": 0});
    document["meshes"][0]["primitives"] = json!([with, without, without]);
    let scene = open(&document);
    assert_eq!(scene.geometry.materials.len(), 2);
    assert_eq!(scene.geometry.mesh.materials, [0, 1, 1]);
    assert!(scene.geometry.materials[0].texture.is_some() && scene.geometry.materials[1].texture.is_none());
    assert!(warnings(&document).contains("2 triangles have a texture but no texture coordinates"));
    let mut document = textured();
    info(&mut document)["texCoord"] = json!(5);
    assert!(open(&document).geometry.materials[1].texture.is_none());
}

#[test]
fn textures_that_the_file_does_not_hold_are_counted() {
    for change in [
        json!({"textures": []}),
        json!({"textures": [{}]}),
        json!({"textures": [{"source": 4}]}),
        json!({"images": [{}]}),
        json!({"images": [{"bufferView": 77}]}),
        json!({"images": [{"uri": "data:image/png;base64,***"}]}),
    ] {
        let mut document = textured();
        document.as_object_mut().unwrap().extend(change.as_object().unwrap().clone());
        let scene = open(&document);
        assert!(scene.geometry.materials[0].texture.is_none() && scene.geometry.mesh.triangles.len() == 1);
        assert!(warnings(&document).contains("1 material with a texture that the file does not contain"), "{change}");
    }
}

#[test]
fn textures_that_cannot_be_read_are_a_warning() {
    for uri in ["missing.png", "../sky.png", "https://example.org/sky.png", "data:image/png;base64,AAAA"] {
        let mut document = textured();
        document["images"] = json!([{"uri": uri}]);
        let scene = open(&document);
        assert_eq!((scene.geometry.mesh.triangles.len(), scene.warnings.len()), (1, 1), "{uri}: {:?}", scene.warnings);
        assert_eq!(scene.geometry.materials[0].texture, None);
    }
}

#[test]
fn vertex_colours_of_all_kinds_are_linear_tints() {
    let expected = [Vec3::X, Vec3::new(0.0, 1.0, 0.0), Vec3::ONE];
    let mut kinds = Vec::new();
    let mut document = triangle();
    kinds.push(add_floats(&mut document, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0], "VEC3", 3));
    kinds.push(add_floats(&mut document, &[1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.5], "VEC4", 3));
    kinds.push(add_accessor(&mut document, &[255, 0, 0, 9, 0, 255, 0, 9, 255, 255, 255, 9], UNSIGNED_BYTE, "VEC4", 3));
    let shorts = [u16::MAX, 0, 0, 0, u16::MAX, 0, u16::MAX, u16::MAX, u16::MAX].map(u16::to_le_bytes).concat();
    kinds.push(add_accessor(&mut document, &shorts, UNSIGNED_SHORT, "VEC3", 3));
    for accessor in kinds {
        document["accessors"][accessor]["normalized"] =
            json!(document["accessors"][accessor]["componentType"] != FLOAT);
        document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(accessor);
        assert_eq!(open(&document).geometry.mesh.colors, expected, "{accessor}");
    }
}

#[test]
fn colours_of_one_primitive_are_white_on_the_others() {
    let mut document = triangle();
    let colors = add_floats(&mut document, &[0.5; 9], "VEC3", 3);
    document["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}},
        {"attributes": {"POSITION": 0, "COLOR_0": colors}}, {"attributes": {"POSITION": 0}}]);
    let mesh = open(&document).geometry.mesh.clone();
    assert_eq!([mesh.colors[0], mesh.colors[3], mesh.colors[8]], [Vec3::ONE, Vec3::splat(0.5), Vec3::ONE]);
}

#[test]
fn unlit_materials_give_off_their_colour() {
    let mut document = textured();
    document["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    document["materials"][0]["emissiveFactor"] = json!([1, 1, 1]);
    let base = Vec3::new(1.0, 0.5, 0.25);
    let material = &open(&document).geometry.materials[0];
    assert_eq!([material.ka, material.kd, material.ks, material.ks_tinted, material.emission], [Vec3::ZERO; 5]);
    assert_eq!(material.emission_tinted, base);
    assert!(material.texture.is_some());
    document["materials"][0]["pbrMetallicRoughness"].as_object_mut().unwrap().remove("baseColorTexture");
    let material = &open(&document).geometry.materials[0];
    // No lamp stands for it.
    assert_eq!((material.emission, material.emission_tinted), (Vec3::ZERO, base));
}

#[test]
fn emission_has_its_strength() {
    let mut document = textured();
    document["materials"][0]["emissiveFactor"] = json!([1, 0.5, 0]);
    assert_eq!(open(&document).geometry.materials[0].emission, Vec3::new(1.0, 0.5, 0.0));
    document["materials"][0]["extensions"] = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 4}});
    assert_eq!(open(&document).geometry.materials[0].emission, Vec3::new(4.0, 2.0, 0.0));
    // An image is placed by itself, also without one of the base colour.
    document["materials"][0]["emissiveTexture"] = json!({"index": 0, "texCoord": 0,
        "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25]}}});
    for _ in 0..2 {
        let material = open(&document).geometry.materials[0].clone();
        let uses = material.emission_texture.unwrap();
        assert_eq!((material.emission, uses.texture), (Vec3::new(4.0, 2.0, 0.0), 0));
        assert_eq!(uses.transform.translation, Vec2::new(0.5, 0.25));
        assert!(material.lamp && material.one_sided, "lights stand for its front");
        document["materials"][0]["pbrMetallicRoughness"].as_object_mut().unwrap().remove("baseColorTexture");
    }
    document["materials"][0]["doubleSided"] = json!(true);
    assert!(!open(&document).geometry.materials[0].one_sided);
    let uvs = |document: &Value| open(document).geometry.mesh.uvs.clone();
    let first = uvs(&document);
    document["materials"][0]["emissiveTexture"]["texCoord"] = json!(1);
    assert_ne!(uvs(&document), first);
}

#[test]
fn an_emissive_texture_that_cannot_be_shown_makes_nothing_glow() {
    let mut document = textured();
    document["materials"][0]["emissiveFactor"] = json!([1, 0.5, 0]);
    for (info, sentence) in [
        (json!({"index": 0, "texCoord": 1}), "1 emissive texture that cannot be placed beside the base colour's"),
        (json!({"index": 7}), "1 material with a texture that the file does not contain"),
    ] {
        document["materials"][0]["emissiveTexture"] = info;
        let material = open(&document).geometry.materials[0].clone();
        assert_eq!((material.emission, material.emission_texture), (Vec3::ZERO, None));
        assert!(warnings(&document).contains(sentence), "{}", warnings(&document));
    }
}

#[test]
fn normals_have_an_image_with_a_scale() {
    let mut document = textured();
    assert_eq!(open(&document).geometry.materials[0].normal_texture, None);
    document["materials"][0]["normalTexture"] = json!({"index": 0});
    let normals = |document: &Value| open(document).geometry.materials[0].normal_texture;
    assert_eq!(normals(&document).unwrap().scale, 1.0);
    document["materials"][0]["normalTexture"] = json!({"index": 0, "texCoord": 0, "scale": -0.5,
        "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25]}}});
    for _ in 0..2 {
        let map = normals(&document).unwrap();
        assert_eq!((map.scale, map.uses.texture), (-0.5, 0));
        assert_eq!(map.uses.transform.translation, Vec2::new(0.5, 0.25));
        assert_eq!(warnings(&document), "");
        document["materials"][0]["pbrMetallicRoughness"].as_object_mut().unwrap().remove("baseColorTexture");
    }
    document["materials"][0]["doubleSided"] = json!(true);
    assert!(!open(&document).geometry.materials[0].one_sided);
    let uvs = |document: &Value| open(document).geometry.mesh.uvs.clone();
    let first = uvs(&document);
    document["materials"][0]["normalTexture"]["texCoord"] = json!(1);
    assert_ne!(uvs(&document), first);
    document["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    assert_eq!(normals(&document), None, "nothing is lit");
}

#[test]
fn normals_that_cannot_be_shown_leave_the_surface_as_it_was() {
    let mut document = textured();
    for (info, sentence) in [
        (
            json!({"index": 0, "texCoord": 1}),
            "1 normal texture that cannot be placed beside the other images: not shown",
        ),
        (json!({"index": 7}), "1 material with a texture that the file does not contain"),
    ] {
        document["materials"][0]["normalTexture"] = info;
        assert_eq!(open(&document).geometry.materials[0].normal_texture, None);
        assert!(warnings(&document).contains(sentence), "{}", warnings(&document));
    }
}

#[test]
fn roughness_and_metal_have_an_image() {
    let mut document = textured();
    let found = |document: &Value| open(document).geometry.materials[0].metallic_roughness_texture;
    assert_eq!(found(&document), None);
    document["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 0,
        "extensions": {"KHR_texture_transform": {"offset": [0.5, 0.25]}}});
    for _ in 0..2 {
        let uses = found(&document).unwrap();
        assert_eq!((uses.texture, uses.transform.translation), (0, Vec2::new(0.5, 0.25)));
        assert_eq!(open(&document).geometry.materials[0].facets, Some(Facets::new(0.5).with_metallic(0.5)));
        assert_eq!(warnings(&document), "");
        document["materials"][0]["pbrMetallicRoughness"].as_object_mut().unwrap().remove("baseColorTexture");
    }
    document["materials"][0]["doubleSided"] = json!(true);
    assert!(!open(&document).geometry.materials[0].one_sided);
    let uvs = |document: &Value| open(document).geometry.mesh.uvs.clone();
    let first = uvs(&document);
    document["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["texCoord"] = json!(1);
    assert_ne!(uvs(&document), first);
    document["materials"][0]["extensions"] = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    assert_eq!(found(&document), None, "glass has no facets");
    let sentence = "1 metallic-roughness texture of a material that transmits light: the material's factors are used";
    assert!(warnings(&document).contains(sentence), "{}", warnings(&document));
    document["materials"][0]["extensions"] = json!({"KHR_materials_unlit": {}});
    assert_eq!(found(&document), None, "nothing is lit");
}

#[test]
fn what_of_materials_is_not_shown_is_one_sentence_a_kind() {
    let mut document = textured();
    let material = &mut document["materials"][0];
    material["occlusionTexture"] = json!({"index": 0});
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({"index": 0, "texCoord": 1});
    material["alphaMode"] = json!("BLEND");
    let other = material.clone();
    document["materials"].as_array_mut().unwrap().push(other);
    document["materials"][1]["alphaMode"] = json!("CLOUDS");
    let warnings = warnings(&document);
    for sentence in [
        "2 metallic-roughness textures that cannot be placed beside the other images: the material's factors are used",
        "2 occlusion textures not shown",
        "1 material with an unknown alphaMode: shown opaque",
    ] {
        assert!(warnings.contains(sentence), "{warnings}");
    }
    assert_eq!(warnings.lines().count(), 3, "{warnings}");
}

#[test]
fn a_mask_cuts_out_by_the_alpha_of_the_base_colour() {
    let mut document = textured();
    let opacity = |document: &Value| open(document).geometry.materials[0].opacity;
    assert_eq!(opacity(&document), None);
    document["materials"][0]["alphaMode"] = json!("MASK");
    let scene = open(&document);
    let mut wanted = Opacity::default();
    wanted.texture = scene.geometry.materials[0].texture;
    assert!(wanted.texture.is_some() && wanted.channel == OpacityChannel::Alpha);
    assert_eq!(wanted.mode, OpacityMode::Mask { cutoff: 0.5 });
    assert_eq!((scene.geometry.materials[0].opacity, &scene.warnings[..]), (Some(wanted), &[][..]));
    document["materials"][0]["alphaCutoff"] = json!(0.25);
    document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = json!([1, 1, 1, 0.75]);
    assert_eq!(opacity(&document), Some(wanted.with_cutoff(0.25).with_factor(0.75)));
    document["materials"][0]["alphaMode"] = json!("BLEND");
    assert_eq!(opacity(&document), Some(wanted.with_factor(0.75).with_filter(Vec3::ONE)));
    document["materials"][0]["alphaMode"] = json!("CLOUDS");
    assert_eq!(opacity(&document), None);
}

#[test]
fn a_mask_without_a_texture_may_hide_everything() {
    let mut document = textured();
    document["materials"][0] =
        json!({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}});
    assert!(warnings(&document).contains("1 material is not seen, for lack of opacity"));
    document["materials"][0]["alphaCutoff"] = json!(0.4);
    assert_eq!(warnings(&document), "");
}

#[test]
fn what_is_transmitted_goes_through_walls_and_bodies() {
    let mut document = textured();
    let glass = |document: &Value| {
        let Material { dielectric, opacity, .. } = open(document).geometry.materials[0].clone();
        (dielectric, opacity)
    };
    document["materials"][0] = json!({
        "pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0.25, 1], "metallicFactor": 0.5, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}},
    });
    let tinted = Opacity::blend(0.75).with_filter([0.5, 1.0, 0.25]);
    assert_eq!(glass(&document), (Some(Dielectric::new(1.5).with_thin(true)), Some(tinted)));
    document["materials"][0]["extensions"]["KHR_materials_ior"] = json!({"ior": 1.33});
    document["materials"][0]["extensions"]["KHR_materials_volume"] = json!({"thicknessFactor": 0.1});
    assert_eq!(glass(&document), (Some(Dielectric::new(1.33)), Some(tinted)));
    document["materials"][0]["extensions"]["KHR_materials_volume"] =
        json!({"thicknessFactor": 0.1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 1]});
    let body = Dielectric::new(1.33).with_attenuation([1.0, 0.5, 1.0], 2.0);
    assert_eq!((glass(&document), warnings(&document)), ((Some(body), Some(tinted)), String::new()));
    document["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.5);
    assert!(warnings(&document).contains("1 material with rough transmission: what is behind is shown sharp"));
    document["materials"][0]["extensions"]["KHR_materials_transmission"] = json!({});
    assert_eq!(glass(&document), (None, None));
}

#[test]
fn the_alpha_of_vertices_counts_where_a_mask_asks_for_it() {
    let mut document = textured();
    let colors = add_floats(&mut document, &[1.0, 0.5, 0.0, 0.25, 1.0, 1.0, 1.0, 7.0, 0.0, 0.0, 0.0, -1.0], "VEC4", 3);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    assert!(open(&document).geometry.mesh.opacities.is_empty());
    document["materials"][0]["alphaMode"] = json!("MASK");
    assert_eq!(open(&document).geometry.mesh.opacities, [0.25, 1.0, 0.0]);
}

#[test]
fn a_material_that_is_not_there_is_the_white_one() {
    let mut document = triangle();
    document["meshes"][0]["primitives"][0]["material"] = json!(8);
    let scene = open(&document);
    assert_eq!((scene.geometry.materials.len(), scene.geometry.materials[0].kd), (1, Vec3::ONE));
    assert!(warnings(&document).contains("1 primitive with a material that the file does not contain: shown white"));
}

#[test]
fn extras_of_others_are_passed_over() {
    for extras in [json!(7), json!("text"), json!([1]), json!({"other": {"ka": 1}}), json!(null)] {
        let mut document = textured();
        document["materials"][0]["extras"] = extras.clone();
        document["scenes"][0]["extras"] = extras;
        assert!(open(&document).warnings.is_empty());
    }
    let mut document = textured();
    document["materials"][0]["extras"] = json!({"lightmesh": {"ka": 1}});
    assert!(error(&document).contains("extras.lightmesh of material 0 is damaged"), "{}", error(&document));
}

#[test]
fn the_material_of_a_scene_around_replaces_colours_too() {
    let mut document = textured();
    let colors = add_floats(&mut document, &[0.5; 9], "VEC3", 3);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("model.gltf"), document.to_string()).unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(
        &path,
        "[[material]]\nname = \"red\"\nkd = [1, 0, 0]\n[[mesh]]\nfile = \"model.gltf\"\nmaterial = \"red\"\n",
    )
    .unwrap();
    let scene = Scene::open(path).unwrap();
    assert_eq!(
        (scene.geometry.materials.len(), scene.geometry.textures.len(), scene.geometry.mesh.colors.len()),
        (1, 0, 0)
    );
    assert_eq!(scene.geometry.mesh.uvs.len(), 3);
}

/// As glTF requires of colours, whether the accessor says so or not.
#[test]
fn integer_colours_are_normalized() {
    let mut document = triangle();
    let bytes = [255, 0, 51].repeat(3);
    let colors = add_accessor(&mut document, &bytes, UNSIGNED_BYTE, "VEC3", 3);
    document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let expected = "model.gltf: node 0: vertex colours are integers that are not normalized: taken as if they were";
    assert!(warnings(&document).contains(expected), "{}", warnings(&document));
    let of = |document: &Value| open(document).geometry.mesh.colors.clone();
    assert_eq!(of(&document)[0], Vec3::new(1.0, 0.0, 0.2));
    let raw = of(&document);
    document["accessors"][colors]["normalized"] = json!(true);
    assert_eq!((of(&document), warnings(&document).contains("normalized")), (raw, false));
}
