//! What other programs find in a GLB file: objects, instances, lights and materials in glTF's own words.

use std::collections::BTreeSet;
use std::fs;

use glam::{DMat4, DVec3, Vec2, Vec3};
use lightmesh_scene::{
    Empty, Facets, Falloff, Instancing, Light, LoadOptions, Material, MeshPart, Opacity, OpacityChannel, Scene,
    SceneBuilder, Texture, TextureUse,
};
use serde_json::Value;

/// The JSON of a GLB file.
fn json(scene: &Scene) -> Value {
    let bytes = scene.to_glb().unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

fn list(json: &Value) -> &[Value] {
    json.as_array().map_or(&[], Vec::as_slice)
}

/// The scene as it is read from a GLB file again.
fn reread(scene: &Scene, options: &LoadOptions) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    fs::write(&path, scene.to_glb().unwrap()).unwrap();
    let read = Scene::open_with(&path, options).unwrap_or_else(|error| panic!("{error}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    read
}

fn always() -> LoadOptions {
    LoadOptions::default().with_instancing(Instancing::Always)
}

/// Corners of all triangles where rays meet them, in no order that matters.
fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    let mesh = scene.geometry.mesh.flattened().unwrap();
    let mut corners: Vec<[Vec3; 3]> = (0..mesh.triangles.len()).map(|triangle| mesh.corners(triangle)).collect();
    let key =
        |corners: &[Vec3; 3]| corners.map(|corner| (corner * 1024.0).round().to_array().map(|value| value as i32));
    corners.sort_by_key(key);
    corners
}

fn assert_same_shape(one: &Scene, other: &Scene) {
    let (one, other) = (corners(one), corners(other));
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().flatten().zip(other.iter().flatten()) {
        assert!(one.distance(*other) < 1e-5, "{one} {other}");
    }
}

const TRIANGLE: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

fn part() -> MeshPart<'static, DVec3> {
    MeshPart { positions: &TRIANGLE, triangles: &[[0, 1, 2]], ..MeshPart::default() }
}

/// A triangle at these places.
fn instances(places: &[DMat4]) -> Scene {
    let mut builder = SceneBuilder::new();
    builder.begin_object("floor");
    builder.add(part(), &DMat4::IDENTITY, |_| 0).unwrap();
    builder.add_instances(part(), places, "tree", |_| 0).unwrap();
    builder.finish_scene("instances")
}

/// One triangle of a material.
fn shown(material: Material, textures: Vec<Texture>) -> Scene {
    let mut builder = SceneBuilder::new();
    builder.add_material(material);
    let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
    builder.add(MeshPart { uvs: &uvs, ..part() }, &DMat4::IDENTITY, |_| 0).unwrap();
    let mut scene = builder.finish_scene("shown");
    scene.geometry_mut().textures = textures.into();
    scene
}

#[test]
fn objects_are_nodes_with_a_primitive_for_each_material() {
    let mut builder = SceneBuilder::new();
    let [red, blue] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(|color| builder.add_material(Material::matt(color)));
    let names = ["one", "two", "three", "four", "five", "six", "seven"];
    for turn in 0..3 {
        for name in names {
            builder.begin_object(name);
            let place = DMat4::from_translation(DVec3::new(0.0, 0.0, f64::from(turn)));
            for material in [red, blue] {
                builder.add(part(), &place, |_| material).unwrap();
            }
        }
    }
    let scene = builder.finish_scene("boxes");
    let json = json(&scene);
    let nodes: Vec<&str> = list(&json["nodes"]).iter().filter_map(|node| node["name"].as_str()).collect();
    assert_eq!(nodes, names);
    for mesh in list(&json["meshes"]) {
        let materials: Vec<u64> = list(&mesh["primitives"]).iter().filter_map(|it| it["material"].as_u64()).collect();
        assert_eq!(materials, [0, 1]);
    }
    let read = reread(&scene, &LoadOptions::default());
    assert_eq!(read.geometry.mesh.objects.names().collect::<Vec<_>>(), names);
    assert_same_shape(&scene, &read);
    let of = |scene: &Scene| -> Vec<(String, u32)> {
        let mesh = &scene.geometry.mesh;
        let object = |triangle: usize| mesh.objects.name(mesh.objects.of(triangle as u32)).to_owned();
        let mut all: Vec<_> = mesh.materials.iter().enumerate().map(|(it, &material)| (object(it), material)).collect();
        all.sort();
        all
    };
    assert_eq!(of(&read), of(&scene));
}

#[test]
fn attributes_that_share_a_view_say_how_far_apart_they_are() {
    let json = json(&instances(&[]));
    let views = list(&json["bufferViews"]);
    let strides: Vec<_> = views.iter().map(|view| (view["target"].as_u64(), view["byteStride"].as_u64())).collect();
    assert_eq!(strides, [(Some(34962), Some(12)), (Some(34963), None)]);
}

#[test]
fn instances_are_nodes_that_share_a_mesh() {
    let turn = DMat4::from_rotation_y(0.7) * DMat4::from_scale(DVec3::new(2.0, 1.0, 0.5));
    let mirror = DMat4::from_translation(DVec3::splat(3.0)) * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let scene = instances(&[DMat4::from_translation(DVec3::X), turn, mirror]);
    let json = json(&scene);
    let meshes: Vec<_> =
        list(&json["nodes"]).iter().map(|node| (node["name"].as_str(), node["mesh"].as_u64())).collect();
    let tree = (Some("tree"), Some(1));
    assert_eq!(meshes, [(Some("floor"), Some(0)), tree, tree, tree]);
    assert_eq!(list(&json["meshes"]).len(), 2, "places that mirror show the same mesh");
    let read = reread(&scene, &always());
    assert_eq!(read.geometry.mesh.instances.list().len(), 3);
    assert_same_shape(&scene, &read);
    assert_same_shape(&scene, &reread(&scene, &LoadOptions::default()));
}

#[test]
fn very_many_instances_are_one_node() {
    let places: Vec<DMat4> = (0..1500)
        .map(|it| {
            let place = DVec3::new(f64::from(it % 40), 0.0, f64::from(it / 40));
            DMat4::from_translation(place)
                * DMat4::from_rotation_y(f64::from(it))
                * DMat4::from_scale(DVec3::splat(0.5))
        })
        .collect();
    let scene = instances(&places);
    let json = json(&scene);
    assert_eq!(list(&json["nodes"]).len(), 2);
    assert_eq!(list(&json["extensionsRequired"]), ["EXT_mesh_gpu_instancing"]);
    let read = reread(&scene, &always());
    assert_eq!(read.geometry.mesh.instances.list().len(), 1500);
    assert_same_shape(&scene, &read);
}

#[test]
fn a_place_that_shears_is_a_mesh_of_its_own() {
    let sheared = DMat4::from_scale(DVec3::new(3.0, 1.0, 1.0)) * DMat4::from_rotation_z(0.6);
    let scene = instances(&[sheared, DMat4::from_translation(DVec3::Z), DMat4::from_translation(DVec3::Y)]);
    let json = json(&scene);
    assert_eq!(list(&json["meshes"]).len(), 3);
    assert!(list(&json["nodes"])[1].get("matrix").is_none());
    assert_same_shape(&scene, &reread(&scene, &always()));
}

#[test]
fn lights_without_falloff_give_the_same_light_at_the_middle() {
    let mut scene = instances(&[]);
    // The middle is at (0.5, 0.5, 0).
    let lamp = Light::point(Vec3::new(0.5, 0.5, 4.0)).with_intensity([0.8, 0.4, 0.2]);
    let sun = Light::directional(Vec3::NEG_Y).unwrap().with_intensity([0.5, 0.25, 0.25]);
    let candela = lamp.clone().with_falloff(Falloff::InverseSquare);
    scene.lights.list = vec![lamp, sun, candela];
    let json = json(&scene);
    let lights = list(&json["extensions"]["KHR_lights_punctual"]["lights"]);
    let strength = |light: &Value| light["intensity"].as_f64().unwrap();
    // A white surface at distance d shows I / (π d²), by a sun I / π.
    let expected = [0.8 * std::f64::consts::PI * 16.0, 0.5 * std::f64::consts::PI, 0.8];
    for (light, expected) in lights.iter().zip(expected) {
        assert!((strength(light) / expected - 1.0).abs() < 1e-6, "{light}");
        assert_eq!(light["color"][0], 1.0);
    }
    let read = reread(&scene, &LoadOptions::default());
    assert_eq!(read.lights.list, scene.lights.list);
}

#[test]
fn cones_are_within_what_the_format_allows() {
    let mut scene = instances(&[]);
    let right = std::f32::consts::FRAC_PI_2;
    let spot = |inner, outer| Light::spot(Vec3::Y, Vec3::NEG_Y, inner, outer).unwrap();
    scene.lights.list = vec![spot(0.5, 0.5), spot(0.0, right), spot(right, right), spot(0.2, 0.3).with_visible(true)];
    let json = json(&scene);
    for light in list(&json["extensions"]["KHR_lights_punctual"]["lights"]) {
        let [inner, outer] = ["innerConeAngle", "outerConeAngle"].map(|angle| light["spot"][angle].as_f64().unwrap());
        assert!(0.0 <= inner && inner < outer && outer <= std::f64::consts::FRAC_PI_2, "{light}");
    }
    assert_eq!(reread(&scene, &LoadOptions::default()).lights.list, scene.lights.list);
}

#[test]
fn strong_emission_has_a_strength() {
    let scene = shown(Material::matt([0.0; 3]).with_emission([20.0, 10.0, 5.0]), vec![]);
    let json = json(&scene);
    let material = &json["materials"][0];
    assert_eq!(list(&material["emissiveFactor"]), [1.0, 0.5, 0.25]);
    assert_eq!(material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"], 20.0);
    assert!(list(&json["extensionsUsed"]).contains(&"KHR_materials_emissive_strength".into()));
    assert_eq!(reread(&scene, &LoadOptions::default()).geometry.materials, scene.geometry.materials);
}

#[test]
fn matt_surfaces_have_no_glossy_layer_and_others_have_theirs() {
    let specular = |material: Material| {
        json(&shown(material, vec![]))["materials"][0]["extensions"]["KHR_materials_specular"].clone()
    };
    assert_eq!(specular(Material::matt([0.5; 3]))["specularFactor"], 0.0);
    let facets = Facets::new(0.5);
    assert_eq!(specular(Material::matt([0.5; 3]).with_ks(Vec3::splat(Facets::LAYER)).with_facets(facets)), Value::Null);
    let dim = specular(Material::matt([0.5; 3]).with_ks([0.01; 3]).with_facets(facets.with_grazing(0.5)));
    assert_eq!((&dim["specularFactor"], &dim["specularColorFactor"][1]), (&0.5.into(), &0.5.into()));
}

#[test]
fn what_is_shown_as_it_is_is_unlit() {
    let unlit = Material::matt([0.0; 3]).with_ka([0.0; 3]).with_emission_tinted([0.5, 0.25, 1.0]);
    let scene = shown(unlit.with_texture(TextureUse::new(0)), vec![texture("sign", [1, 1], |_| [9, 9, 9, 255])]);
    let entry = &json(&scene)["materials"][0];
    assert!(entry["extensions"]["KHR_materials_unlit"].is_object(), "{entry}");
    assert_eq!(list(&entry["pbrMetallicRoughness"]["baseColorFactor"]), [0.5, 0.25, 1.0, 1.0]);
    assert_eq!(reread(&scene, &LoadOptions::default()).geometry.materials, scene.geometry.materials);
    assert_eq!(scene.export_warnings("a.glb").unwrap(), [""; 0]);
}

fn texture(name: &str, size: [u32; 2], texel: impl Fn(u32) -> [u8; 4]) -> Texture {
    Texture { name: name.into(), size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

#[test]
fn opacities_of_an_image_of_their_own_are_put_beside_the_colours() {
    let colors = texture("bark", [2, 2], |it| [10 * it as u8, 20, 30, 255]);
    let mask = texture("leaf", [4, 1], |it| [0, 80 * it as u8, 7, 255]);
    let (bark, leaf) = (TextureUse::new(0), TextureUse::new(1));
    let by_green = Opacity::by(leaf, OpacityChannel::Green).with_cutoff(0.3);
    let both = Material::matt([0.5; 3]).with_texture(bark).with_opacity(by_green);
    let white = Material::matt([0.5; 3]).with_opacity(by_green);
    // An image of colours with alpha that does not count.
    let opaque = Material::matt([0.5; 3]).with_texture(bark).with_opacity(Opacity::blend(0.5));
    for (material, expected) in [
        (both, [[0, 20, 30, 0], [0, 20, 30, 80], [10, 20, 30, 160], [10, 20, 30, 240]]),
        (white, [[255, 255, 255, 0], [255, 255, 255, 80], [255, 255, 255, 160], [255, 255, 255, 240]]),
        (opaque, [[0, 20, 30, 255], [10, 20, 30, 255], [20, 20, 30, 255], [30, 20, 30, 255]]),
    ] {
        let scene = shown(material.clone(), vec![colors.clone(), mask.clone()]);
        let bytes = scene.to_glb().unwrap();
        let json = json(&scene);
        let entry = &json["materials"][0];
        assert_eq!(entry["alphaMode"], if material.opacity.unwrap().filter().is_some() { "BLEND" } else { "MASK" });
        if entry["alphaMode"] == "MASK" {
            assert!((entry["alphaCutoff"].as_f64().unwrap() - 0.3).abs() < 1e-6);
        }
        // What other programs find as base colour.
        let index = entry["pbrMetallicRoughness"]["baseColorTexture"]["index"].as_u64().unwrap() as usize;
        let image = &json["images"][json["textures"][index]["source"].as_u64().unwrap() as usize];
        let view = &json["bufferViews"][image["bufferView"].as_u64().unwrap() as usize];
        let bin = 20 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize + 8;
        let [first, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        let png = image::load_from_memory(&bytes[bin + first..bin + first + length]).unwrap().into_rgba8();
        assert_eq!(png.pixels().take(4).map(|pixel| pixel.0).collect::<Vec<_>>(), expected, "{material:?}");
        // What we find.
        let read = reread(&scene, &LoadOptions::default());
        let used = |scene: &Scene, uses: Option<TextureUse>| {
            uses.map(|it| scene.geometry.textures[it.texture as usize].clone())
        };
        let (one, other) = (&read.geometry.materials[0], &scene.geometry.materials[0]);
        assert_eq!(used(&read, one.texture), used(&scene, other.texture));
        let opacity = |material: &Material| material.opacity.unwrap();
        assert_eq!(used(&read, opacity(one).texture), used(&scene, opacity(other).texture));
        let without = |opacity: Opacity| (opacity.channel, opacity.factor, opacity.mode);
        assert_eq!(without(opacity(one)), without(opacity(other)));
        assert!(scene.export_warnings("a.glb").unwrap().iter().all(|warning| !warning.contains("opa")));
    }
}

/// A file of two objects in several places of a scene file.
#[test]
fn objects_of_files_in_many_places_keep_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
    fs::write(folder.path().join("chair.obj"), format!("{points}o seat\nf 1 2 3\no leg\nf 2 3 4\n")).unwrap();
    let place = |x: u32| format!("[[mesh]]\nfile = \"chair.obj\"\ntranslate = [{x}, 0, 0]\n");
    let named = "[[mesh]]\nfile = \"chair.obj\"\nname = \"throne\"\ntranslate = [0, 5, 0]\n";
    fs::write(folder.path().join("hall.toml"), (0..3).map(place).collect::<String>() + named).unwrap();
    let scene = Scene::open_with(folder.path().join("hall.toml"), &always()).unwrap();
    let json = json(&scene);
    let mut names: Vec<&str> = list(&json["nodes"]).iter().filter_map(|node| node["name"].as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["leg", "leg", "leg", "seat", "seat", "seat", "throne"]);
    assert_same_shape(&scene, &reread(&scene, &always()));
}

#[test]
fn what_gltf_cannot_say_is_a_warning() {
    let plain = shown(Material::matt([0.5; 3]), vec![]);
    assert_eq!(plain.export_warnings("a.glb").unwrap(), [""; 0]);
    let mut scene = shown(
        Material::matt([0.5, 2.0, 0.5])
            .with_ks([0.2; 3])
            .with_catcher(true)
            .with_opacity(Opacity::blend(0.5).with_filter([1.0, 0.0, 0.0])),
        vec![],
    );
    let lamp = Light::sphere(Vec3::Y, 0.1).unwrap();
    let panel = Light::rectangle(Vec3::Y, Vec3::X, Vec3::Z).unwrap().with_falloff(Falloff::InverseSquare);
    scene.lights.list = vec![lamp.clone(), lamp, panel.with_visible(true)];
    (scene.lights.ambient, scene.lights.background) = (Some(Vec3::ONE), Some(Vec3::ONE));
    scene.geometry_mut().mesh.colors = vec![Vec3::splat(1.5); 3];
    let warnings = scene.export_warnings("a.glb").unwrap();
    for expected in [
        "2 lights the same at any distance: other programs show them with inverse-square falloff, in candela that give the same light at the \
         middle of the scene",
        "1 light shining to one side of a surface: other programs show it like a spot to that side, with hard shadows",
        "2 lights with a size: other programs show them as light from a point, with hard shadows",
        "1 light that cameras see: other programs show it without a surface",
        "1 material with a Phong lobe (ks, shininess): other programs show it as a rough layer",
        "1 material that reflects more light than it gets: other programs show it with a colour of at most 1",
        "1 material that catches shadows: other programs show it as an ordinary surface",
        "1 material that tints the light that it lets through: other programs show it without that tint",
        "3 vertex colours above 1: other programs show them as 1",
        "ambient light: other programs show the scene without it",
        "a background: other programs show one of their own",
    ] {
        assert!(warnings.iter().any(|warning| warning == expected), "{expected}: {warnings:#?}");
    }
    // Files of our own say all of it.
    assert_eq!(scene.export_warnings("a.toml").unwrap(), [""; 0]);
    assert!(scene.export_warnings("a.obj").is_err());
}

/// Names of nodes that have triangles.
fn named_nodes(json: &Value) -> Vec<String> {
    let is_shown = |node: &&Value| {
        let mesh = node["mesh"].as_u64().map(|mesh| &json["meshes"][mesh as usize]);
        mesh.is_some_and(|mesh| {
            list(&mesh["primitives"]).iter().any(|it| it["mode"].as_u64().is_none_or(|mode| mode >= 4))
        })
    };
    let named = list(&json["nodes"]).iter().filter(is_shown).filter_map(|node| node["name"].as_str());
    named.map(str::to_owned).collect()
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn named_nodes_of_the_shared_models_stay_named_nodes() {
    let shared = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes");
    for file in [
        "balloon/scene.gltf",
        "camera_light/geometry-camera-light.glb",
        "chess/chess-board.glb",
        "complete/complete.glb",
        "cornell_gltf/cornellBox.gltf",
        "cubes/Cubes.glb",
        "duck/Duck.glb",
        "house/house.glb",
        "milk_truck/CesiumMilkTruck.glb",
        "mountains/Mountains.gltf",
        "node_hierarchy/02_node_hierarchy.gltf",
        "u32_indices/01_vertex_count_32bit.gltf",
    ] {
        let bytes = fs::read(shared.join(file)).unwrap();
        let source: Value = if bytes.starts_with(b"glTF") {
            let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
            serde_json::from_slice(&bytes[20..20 + length]).unwrap()
        } else {
            serde_json::from_slice(&bytes).unwrap()
        };
        let scene = Scene::open_with(shared.join(file), &always()).unwrap();
        let (source, written) = (named_nodes(&source), named_nodes(&json(&scene)));
        for name in &source {
            assert!(written.contains(name), "{file}: {name} of {written:?}");
        }
        assert!(written.len() >= source.len(), "{file}: {written:?} {source:?}");
        let read = reread(&scene, &always());
        assert_eq!(read.geometry.mesh.instances.list().len(), scene.geometry.mesh.instances.list().len(), "{file}");
        assert_eq!(read.geometry.mesh.triangle_count(), scene.geometry.mesh.triangle_count(), "{file}");
    }
}

#[test]
#[cfg_attr(not(shared_scenes), ignore = "needs ../shared/scenes")]
fn groups_of_shared_obj_files_stay_objects() {
    let shared = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes");
    for file in ["beetle/beetle.obj", "cornell_box/cornell_box.obj", "spider/spider.obj", "sponza/sponza.obj"] {
        let scene = Scene::open(shared.join(file)).unwrap();
        let names = |scene: &Scene| -> BTreeSet<String> {
            let mesh = &scene.geometry.mesh;
            mesh.objects.runs().1.iter().map(|&object| mesh.objects.name(object).to_owned()).collect()
        };
        assert_eq!(named_nodes(&json(&scene)).into_iter().collect::<BTreeSet<_>>(), names(&scene), "{file}");
        assert_eq!(names(&reread(&scene, &LoadOptions::default())), names(&scene), "{file}");
    }
}

/// A group that is turned, with a pivot, two things of one name and a mesh of lines in it; one more thing of that name shares a mesh.
const NAMED: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "group", "children": [1, 2, 3, 4, 5, 6], "translation": [1, 2, 3], "rotation": [0, 0.70710678, 0, 0.70710678]},
        {"name": "pivot", "translation": [0, 0, 1]}, {"name": "chair", "mesh": 0}, {"name": "chair", "mesh": 1},
        {"name": "chair", "mesh": 1, "translation": [5, 0, 0]}, {"name": "lines", "mesh": 2}, {"translation": [7, 7, 7]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}, {"primitives": [{"attributes": {"POSITION": 0}}]},
        {"primitives": [{"attributes": {"POSITION": 0}, "mode": 3}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

#[test]
fn every_named_node_is_there_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("named.gltf");
    std::fs::write(&path, NAMED).unwrap();
    for options in [LoadOptions::default(), always()] {
        let scene = Scene::open_with(&path, &options).unwrap();
        assert_eq!(scene.geometry.mesh.objects.names().collect::<Vec<_>>(), ["chair"; 3]);
        for name in ["again.glb", "again.toml"] {
            let read = folder.path().join(name);
            scene.export(&read).unwrap();
            let read = Scene::open_with(&read, &options).unwrap();
            let json = json(&read);
            let mut names: Vec<&str> = list(&json["nodes"]).iter().filter_map(|node| node["name"].as_str()).collect();
            names.sort_unstable();
            assert_eq!(names, ["chair", "chair", "chair", "group", "lines", "pivot"], "{name}");
            let pivot = read.empties.iter().find(|empty| empty.name == "pivot").unwrap();
            let place = pivot.transform.w_axis.truncate();
            assert!(place.distance(DVec3::new(2.0, 2.0, 3.0)) < 1e-6, "{name}: {place}");
            assert_same_shape(&scene, &read);
        }
    }
}

#[test]
fn places_that_gltf_does_not_have_keep_their_middle() {
    let mut scene = instances(&[]);
    let shear =
        DMat4::from_rotation_z(0.5) * DMat4::from_scale(DVec3::new(2.0, 1.0, 1.0)) * DMat4::from_rotation_z(0.5);
    let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    for (name, transform) in [("shear", shear), ("flat", flat)] {
        let transform = DMat4::from_translation(DVec3::Y) * transform;
        scene.empties.push(Empty { name: name.to_owned(), transform });
    }
    let json = json(&scene);
    for node in &list(&json["nodes"])[1..] {
        assert_eq!((&node["translation"], node.get("matrix")), (&serde_json::json!([0.0, 1.0, 0.0]), None));
    }
}

#[test]
fn panels_are_spots_to_their_side() {
    let (direction, position) = (Vec3::new(0.6, -0.8, 0.0), Vec3::new(1.0, 2.0, 3.0));
    let mut scene = instances(&[]);
    scene.lights.list = vec![
        Light::disk(position, direction, 0.5).unwrap(),
        Light::rectangle(position, 0.5 * Vec3::X, 0.25 * Vec3::Z).unwrap().with_falloff(Falloff::InverseSquare),
        Light::rectangle(position, Vec3::X, Vec3::Z).unwrap().with_one_sided(false),
    ];
    let json = json(&scene);
    let lights = list(&json["extensions"]["KHR_lights_punctual"]["lights"]);
    let kinds: Vec<_> = lights.iter().map(|light| light["type"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["spot", "spot", "point"]);
    let half_turn = std::f64::consts::FRAC_PI_2;
    assert_eq!(lights[0]["spot"], serde_json::json!({"innerConeAngle": 0.0, "outerConeAngle": half_turn}));
    let nodes: Vec<_> = list(&json["nodes"]).iter().filter(|node| node["extensions"].is_object()).collect();
    for (node, side) in nodes.iter().zip([direction, Vec3::NEG_Y]) {
        let back: Vec<f64> = list(&node["matrix"])[8..11].iter().map(|value| value.as_f64().unwrap()).collect();
        assert!(DVec3::from_slice(&back).distance(-side.as_dvec3()) < 1e-6, "{back:?}");
    }
    let warnings = scene.export_warnings("a.glb").unwrap();
    let expected = "2 lights shining to one side of a surface: other programs show them like a spot to that side, with hard shadows";
    assert!(warnings.iter().any(|warning| warning == expected), "{warnings:?}");
    assert_eq!(reread(&scene, &LoadOptions::default()).lights.list, scene.lights.list);
}
