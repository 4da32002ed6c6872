//! Known answers for OBJ and MTL, and messages for damaged files.

mod lines;
mod map;
mod smoothing;

use std::fs;

use glam::Vec3;
use lightmesh_scene::{Dielectric, Facets, Material, Opacity, OpacityMode, Scene};

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

fn try_open(obj: &str, mtl: &str) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a b.mtl"), mtl).unwrap();
    let path = folder.path().join("shape.obj");
    fs::write(&path, obj).unwrap();
    Scene::open(path).map_err(|error| error.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn open(obj: &str) -> Scene {
    try_open(obj, "").unwrap()
}

#[test]
fn absolute_and_relative_indices_mean_the_same() {
    let absolute = open(&format!("{TETRAHEDRON}f 1 2 3\nf 2 3 4\n"));
    let relative = open(&format!("{TETRAHEDRON}f -4 -3 -2\nf 2 -2 -1\n"));
    assert_eq!(absolute.geometry.mesh.triangles.len(), 2);
    assert_eq!(absolute.geometry.mesh.corners(1), [Vec3::X, Vec3::Y, Vec3::Z]);
    assert_eq!([0, 1].map(|i| absolute.geometry.mesh.corners(i)), [0, 1].map(|i| relative.geometry.mesh.corners(i)));
}

#[test]
fn polygons_are_cut_into_fans() {
    let scene = open("v 0 0 0\nv 1 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\nf 1 2 3 4\n");
    assert_eq!(scene.geometry.mesh.triangles.len(), 3 + 2);
    let area = |i: usize| {
        let [a, b, c] = scene.geometry.mesh.corners(i);
        0.5 * (b - a).cross(c - a).z
    };
    assert!((0..3).map(area).sum::<f32>() == 2.5);
}

#[test]
fn one_place_with_two_normals_is_two_vertices() {
    let faces = "vn 0 0 2\nvn 1 0 0\nf 1//1 2//1 3//1\nf 2//2 3//2 4//2\n";
    let mesh = open(&format!("{TETRAHEDRON}{faces}")).geometry.mesh.clone();
    assert_eq!(mesh.positions.len(), 6);
    assert!(mesh.triangles[0].iter().all(|&vertex| mesh.normals[vertex as usize] == Vec3::Z));
    assert!(mesh.triangles[1].iter().all(|&vertex| mesh.normals[vertex as usize] == Vec3::X));
}

#[test]
fn faces_with_and_without_normals_may_follow_each_other() {
    let faces = "vn 0 0 1\nvt 0.5 0.25\nf 1 2 3\nf 1/1/1 2/1/1 3/1/1\nf 2 3 4\nf 1//1 2//1 4//1\nf 1/1/1 2//1 3//1\n";
    let mesh = open(&format!("{TETRAHEDRON}{faces}")).geometry.mesh.clone();
    let normals = |i: usize| mesh.triangles[i].map(|vertex| mesh.normals[vertex as usize]);
    let uvs = |i: usize| mesh.triangles[i].map(|vertex| mesh.uvs[vertex as usize].to_array());
    let (flat, smooth) = ([Vec3::ZERO; 3], [Vec3::Z; 3]);
    assert_eq!([0, 1, 2, 3, 4].map(normals), [flat, smooth, flat, smooth, smooth]);
    assert_eq!([0, 1, 4].map(uvs), [[[0.0; 2]; 3], [[0.5, 0.75]; 3], [[0.0; 2]; 3]]);
}

#[test]
fn digits_far_from_the_origin_are_kept() {
    let scene = open("v 1000000.125 0 0\nv 1000001.125 0 0\nv 1000000.125 1.0000001 0\nf 1 2 3\n");
    let [a, b, c] = scene.geometry.mesh.corners(0);
    assert_eq!(b - a, Vec3::X);
    assert!(((c - a).y - 1.000_000_1).abs() < 1e-7);
    assert_eq!(scene.to_world(a).x, 1_000_000.125);
}

#[test]
fn materials_have_their_coefficients() {
    let mtl = "newmtl shiny\nKa 20 20 20\nKd 0.5\nKs 0.1 0.2 0.3 # grey\nNs 96\nKe 1 2 3\nd -halo 0.5\nillum x\n\
               newmtl plain\nKd 0.1 0.2 0.3\nNs 0\n";
    let obj =
        format!("mtllib a b.mtl\n{TETRAHEDRON}usemtl plain\nf 1 2 3\nusemtl shiny\nf 2 3 4\nusemtl gone\nf 1 2 4\n");
    let scene = try_open(&obj, mtl).unwrap();
    assert_eq!(scene.geometry.mesh.materials, [1, 0, 2]);
    let [shiny, plain, gone] = &scene.geometry.materials[..] else { panic!("{:?}", scene.geometry.materials) };
    assert_eq!((shiny.ka, shiny.kd), (Vec3::splat(20.0), Vec3::splat(0.5)));
    assert_eq!((shiny.ks, shiny.shininess), (Vec3::new(0.1, 0.2, 0.3), 96.0));
    assert_eq!(shiny.emission, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!((plain.ka, plain.kd), (plain.kd, Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!((plain.shininess, gone.name.as_str()), (1.0, ""));
    assert!(scene.warnings.iter().any(|warning| warning.contains("gone")), "{:?}", scene.warnings);
}

#[test]
fn odd_but_lawful_lines_are_read() {
    let obj = "\u{feff}# caf\u{e9}\r\nv 0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv\t0 1 0\r\nvt 0.5\ng a b\nl 1 2\np 1\nf 1/1 \\\n2/1 3/1\n";
    let scene = open(obj);
    assert_eq!(scene.geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(scene.geometry.mesh.uvs[0].to_array(), [0.5, 1.0]);
    assert!(scene.warnings[0].contains("2 points and lines"), "{:?}", scene.warnings);
}

#[test]
fn damage_is_named_with_its_line() {
    #[rustfmt::skip]
    const MISTAKES: [(&str, &str); 8] = [
        ("v 0 0\n", "a line `v` has fewer than 3 numbers, shape.obj:1; "),
        ("v 0 0 zero\n", "`zero` in a line `v` is not a number, shape.obj:1; "),
        ("v 0 0 0\n\nf 1 1 2\n", "the face corner `2` refers to position 2 of 1, shape.obj:3; "),
        ("v 0 0 0\nf 1 1 0\n", "the face corner `0` refers to position 0 of 1, shape.obj:2; "),
        ("v 0 0 0\nf -2 1 1\n", "refers to position -2 of 1, shape.obj:2; "),
        ("v 0 0 0\nvn 0 0 1\nf 1//2 1//1 1//1\n", "refers to normal 2 of 1, shape.obj:3; "),
        ("v 0 0 0\nf 1 1 x\n", "the face corner `x` is not made of indices, shape.obj:2; "),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "shape.obj:2; "),
    ];
    for (obj, expected) in MISTAKES {
        let message = try_open(obj, "").unwrap_err();
        assert!(message.contains(expected), "{obj}: {message}");
    }
    let message = try_open("mtllib a b.mtl\nv 0 0 0\n", "newmtl a\nKd 1 x 1\n").unwrap_err();
    assert!(message.contains("`Kd` must have one number or three, a b.mtl:2; "), "{message}");
    assert!(message.ends_with(" (named by shape.obj:1)"), "{message}");
    for color in ["nan 0 0", "0 inf 0", "0 0 1e39"] {
        let message = try_open("mtllib a b.mtl\nv 0 0 0\n", &format!("newmtl a\nKd {color}\n")).unwrap_err();
        assert!(message.contains("must have one number or three, a b.mtl:2; "), "{message}");
    }
}

#[test]
fn a_concave_polygon_keeps_its_notch() {
    let arrow = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\n";
    for face in ["f 1 2 3 4", "f 4 1 2 3", "f -3 -2 -1 -4", "f 4 3 2 1"] {
        let mesh = open(&format!("{arrow}{face}\n")).geometry.mesh.clone();
        let areas: f32 = (0..2).map(|i| mesh.corners(i)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        assert_eq!((mesh.triangles.len(), areas), (2, 4.0), "{face}");
    }
}

#[test]
fn vertex_colours_are_srgb() {
    let scene = open("v 0 0 0 1 0 0.735\nv 1 0 0\nv 0 1 0 2 0.5 0.5 # w\nv 0 0 1 0 0 0 1\nf 1 2 3\nf 1 2 4\n");
    let colors = |scene: &Scene, triangle: usize| {
        scene.geometry.mesh.triangles[triangle].map(|vertex| scene.geometry.mesh.colors[vertex as usize])
    };
    // One colour above 1: all count to 255.
    let [_, white, dark] = colors(&scene, 0);
    assert_eq!(white, Vec3::ONE);
    assert!(dark.x < 0.001, "{dark}");
    let scene = open("v 0 0 0 1 0 0.735\nv 1 0 0\nv 0 1 0 0 0 0 1\nf 1 2 3\n");
    let [violet, white, black] = colors(&scene, 0);
    assert!((violet - Vec3::new(1.0, 0.0, 0.5)).abs().max_element() < 0.002, "{violet}");
    assert_eq!((white, black), (Vec3::ONE, Vec3::ZERO));
    assert!(open("v 0 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").geometry.mesh.colors.is_empty());
}

#[test]
fn names_keep_blanks_and_hashes_and_need_not_be_utf_8() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shape.obj");
    let faces = b"\nusemtl oak #2\nf 1 2 3\nusemtl gr\xfcn\nf 2 3 4 # not a corner\nusemtl gr\xe4n\nf 1 2 4\n";
    let write = |mtllib: &str| {
        fs::write(
            &path,
            [b"mtllib ", mtllib.as_bytes(), b"\n# \xff C:\\old\\\n", TETRAHEDRON.as_bytes(), faces].concat(),
        )
        .unwrap();
    };
    fs::create_dir(folder.path().join("lib")).unwrap();
    fs::write(folder.path().join("lib/two words.mtl"), "newmtl oak #2\r\nKd 1 0 0\r\n").unwrap();
    fs::write(folder.path().join("b.mtl"), b"newmtl gr\xfcn\nKd 0 1 0\nnewmtl gr\xe4n\nKd 0 0 1\nnewmtl oak #2\n")
        .unwrap();
    for mtllib in [r"lib\two words.mtl b.mtl", r".\lib\two words.mtl b.mtl gone.mtl", "lib/two words.mtl\nmtllib b.mtl"]
    {
        write(mtllib);
        let scene = Scene::open(&path).unwrap();
        let kd = |triangle: usize| scene.geometry.materials[scene.geometry.mesh.materials[triangle] as usize].kd;
        assert_eq!([0, 1, 2].map(kd), [Vec3::X, Vec3::Y, Vec3::Z], "{mtllib}: {:?}", scene.warnings);
        let missing = scene.warnings.iter().any(|warning| warning.contains("gone.mtl"));
        assert_eq!((missing, scene.warnings.len()), (mtllib.contains("gone"), usize::from(missing)));
    }
    write("../outside.mtl");
    let warnings = Scene::open(&path).unwrap().warnings;
    assert!(warnings[0].contains("../outside.mtl` leads outside the scene's folder"), "{warnings:?}");
}

#[test]
fn textures_come_from_map_kd_with_its_options() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("maps")).unwrap();
    image::RgbImage::new(2, 2).save(folder.path().join("maps/red brick.png")).unwrap();
    let mtl = "newmtl brick\nmap_Kd -s 2 4 1 -o 0.25 0.5 -clamp on .\\maps\\red brick.png\nmap_Bump bump.png\nd 0.5\n\
               newmtl gone\nKd 0.5\nmap_Kd gone.png\nTr 0.2\nnewmtl unused\nmap_Kd other.png\nd 1\nTr 1\n";
    fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    let faces = "vt 0.5 0.25\nusemtl brick\nf 1/1 2/1 3/1\nusemtl gone\nf 2 3 4\n";
    let path = folder.path().join("shape.obj");
    fs::write(&path, format!("mtllib a.mtl\n{TETRAHEDRON}{faces}")).unwrap();
    let scene = Scene::open(&path).unwrap();
    let texture = scene.geometry.materials[0].texture.expect("the image is there");
    assert_eq!((scene.geometry.materials[0].kd, texture.wrap), (Vec3::ONE, [lightmesh_scene::Wrap::Clamp; 2]));
    // (2 · 0.5 + 0.25, 4 · 0.25 + 0.5) upwards is (1.25, −0.5) downwards.
    let uv = scene.geometry.mesh.uvs[scene.geometry.mesh.triangles[0][0] as usize];
    assert_eq!(texture.transform.transform_point2(uv).to_array(), [1.25, -0.5]);
    assert_eq!((scene.geometry.materials[1].kd, scene.geometry.materials[1].texture), (Vec3::splat(0.5), None));
    let warned = |part: &str| scene.warnings.iter().filter(|warning| warning.contains(part)).count();
    assert_eq!(
        ["gone.png", "other.png", "bump.png", "textures other than", "transparent"].map(warned),
        [1, 0, 1, 0, 0]
    );
}

#[test]
fn images_of_emitted_light_come_from_map_ke() {
    let folder = tempfile::tempdir().unwrap();
    image::RgbImage::new(2, 2).save(folder.path().join("sign.png")).unwrap();
    let statements =
        ["map_Ke sign.png", "Ke 0 0 0\nmap_Ke sign.png", "Ke 0.5 4 0\nmap_Ke sign.png", "Ke 3\nmap_Ke gone.png"];
    let scene = with_materials(&folder, &statements);
    let found =
        |index: usize| (scene.geometry.materials[index].emission, scene.geometry.materials[index].emission_texture);
    let [unsaid, black, colored, gone] = [0, 1, 2, 3].map(found);
    assert_eq!((unsaid.0, unsaid.1.map(|uses| uses.texture)), (Vec3::ONE, Some(0)));
    assert_eq!((black, colored), (unsaid, (Vec3::new(0.5, 4.0, 0.0), unsaid.1)));
    assert_eq!(gone, (Vec3::ZERO, None), "black nearly everywhere rather than bright everywhere");
}

#[test]
fn normals_come_from_norm_and_heights_from_bump() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, texel: fn(u32) -> [u8; 3]| {
        let image = image::RgbImage::from_fn(4, 1, |column, _| image::Rgb(texel(column)));
        image.save(folder.path().join(name)).unwrap();
    };
    save("normals.png", |_| [128, 128, 255]);
    save("heights.png", |column| [if column == 2 { 255 } else { 0 }; 3]);
    let statements = [
        "norm normals.png",
        "map_Kn -bm 0.5 normals.png",
        "bump -bm 2 heights.png",
        "map_Bump -bm 3 -clamp on normals.png",
        "map_bump heights.png\nnorm normals.png",
        "map_Kd heights.png\nmap_bump heights.png",
        "norm gone.png",
    ];
    let scene = with_materials(&folder, &statements);
    let maps: Vec<_> = scene.geometry.materials.iter().map(|material| material.normal_texture).collect();
    let scales: Vec<_> = maps.iter().map(|map| map.map(|map| map.scale)).collect();
    assert_eq!(scales, [Some(1.0), Some(0.5), Some(2.0), Some(3.0), Some(1.0), Some(1.0), None]);
    let name = |index: usize| &*scene.geometry.textures[maps[index].unwrap().uses.texture as usize].name;
    assert_eq!([0, 1, 3, 4].map(name), ["normals.png"; 4]);
    assert_eq!([2, 5].map(name), ["heights.png as normals"; 2]);
    assert_eq!(maps[2].unwrap().uses.texture, maps[5].unwrap().uses.texture, "made once");
    let red = scene.geometry.textures[maps[2].unwrap().uses.texture as usize].texels[1][0];
    assert!(red < 128, "what is higher is to the right");
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn roughness_and_metal_are_numbers_and_images_of_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let save = |name: &str, side: u32, texel: [u8; 3]| {
        image::RgbImage::from_pixel(side, side, image::Rgb(texel)).save(folder.path().join(name)).unwrap();
    };
    save("rough.png", 2, [51; 3]);
    save("metal.png", 1, [204; 3]);
    save("both.png", 2, [9, 60, 70]);
    let statements = [
        "Pr 0.5\nPm 0.25",
        "map_Pr rough.png\nmap_Pm metal.png",
        "Pr 0.5\nPm 0.25\nmap_Pm metal.png\nmap_Pr rough.png",
        "map_Pr -clamp on rough.png",
        "Pr 0\nPm 0\nmap_Pm metal.png",
        "map_Pr -imfchan g both.png\nmap_Pm -imfchan b both.png",
        "map_Pr -s 2 2 1 rough.png\nmap_Pm metal.png",
        "map_Pr gone.png\nmap_Pm gone.png",
    ];
    let scene = with_materials(&folder, &statements);
    let material = |index: usize| &scene.geometry.materials[index];
    let facets = |roughness: f32, metallic: f32| Some(Facets::new(roughness).with_metallic(metallic));
    let expected = [(0.5, 0.25), (1.0, 1.0), (0.5, 0.25), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (1.0, 0.0)];
    for (index, (roughness, metallic)) in expected.into_iter().enumerate() {
        assert_eq!(material(index).facets, facets(roughness, metallic), "{}", statements[index]);
        assert_eq!(material(index).ks, Vec3::splat(Facets::LAYER));
    }
    let uses = |index: usize| material(index).metallic_roughness_texture;
    assert_eq!([0, 7].map(uses), [None; 2]);
    assert_eq!(uses(1), uses(2), "packed once");
    let texel = |index: usize| scene.geometry.textures[uses(index).unwrap().texture as usize].texels[0];
    assert_eq!([1, 3, 4].map(texel), [[255, 51, 204, 255], [255, 51, 255, 255], [255, 255, 204, 255]]);
    assert_eq!((texel(5), texel(6)), ([9, 60, 70, 255], texel(3)));
    assert_eq!(
        (uses(3).unwrap().wrap[0], uses(6).unwrap().transform.matrix2.x_axis.x),
        (lightmesh_scene::Wrap::Clamp, 2.0)
    );
    let warned = |part: &str| scene.warnings.iter().filter(|warning| warning.contains(part)).count();
    assert_eq!(["1 map_Pm with other options than map_Pr", "gone.png", "textures other than"].map(warned), [1, 1, 0]);
}

/// A scene with a face of each material, whose statements are given.
fn with_materials(folder: &tempfile::TempDir, materials: &[&str]) -> Scene {
    let mut mtl = String::new();
    let mut faces = "vt 0.5 0.25\n".to_owned();
    for (index, lines) in materials.iter().enumerate() {
        mtl += &format!("newmtl m{index}\n{lines}\n");
        faces += &format!("usemtl m{index}\nf 1/1 2/1 3/1\n");
    }
    fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    let path = folder.path().join("shape.obj");
    fs::write(&path, format!("mtllib a.mtl\n{TETRAHEDRON}{faces}")).unwrap();
    Scene::open(&path).unwrap()
}

#[test]
fn d_and_tr_let_light_through() {
    let folder = tempfile::tempdir().unwrap();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([0, 0, 0, 99])).save(folder.path().join("leaf.png")).unwrap();
    let materials = [
        "d 0.25",
        "Tr 0.25",
        "Tr 1\nd 1",
        "d -halo 0.5\nTf 0.5 1 0.25",
        "d 0.5\nTf 0 0 0",
        "d 0.5\nmap_d leaf.png",
        "Tf 0.5 0.5 0.5",
    ];
    let scene = with_materials(&folder, &materials);
    let found = |index: usize| scene.geometry.materials[index].opacity;
    assert_eq!(found(0), Some(Opacity::blend(0.25)));
    assert_eq!(found(1), Some(Opacity::blend(0.75)));
    assert_eq!((found(2), found(6)), (None, None), "opaque");
    assert_eq!(found(3), Some(Opacity::blend(0.5).with_filter([0.5, 1.0, 0.25])));
    assert_eq!(found(4), Some(Opacity::blend(0.5)), "black means that nothing was said");
    let both = found(5).unwrap();
    assert_eq!((both.factor, both.filter(), both.texture.is_some()), (0.5, Some(Vec3::ONE), true));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn what_refracts_is_a_body() {
    let folder = tempfile::tempdir().unwrap();
    let materials = ["illum 7\nNi 1.5", "illum 6\nNi 1.33\nTf 0.5 1 1\nd 0.25", "illum 7\nNi 1", "illum 2\nNi 1.5"];
    let scene = with_materials(&folder, &materials);
    let found = |index: usize| {
        let Material { dielectric, opacity, .. } = &scene.geometry.materials[index];
        (*dielectric, *opacity)
    };
    assert_eq!(found(0), (Some(Dielectric::new(1.5)), Some(Opacity::blend(0.0))));
    let tinted = Opacity::blend(0.25).with_filter([0.5, 1.0, 1.0]);
    assert_eq!(found(1), (Some(Dielectric::new(1.33)), Some(tinted)));
    assert_eq!((found(2), found(3)), ((None, None), (None, None)));
}

#[test]
fn map_d_cuts_out() {
    let folder = tempfile::tempdir().unwrap();
    let leaf = |alpha: u8| image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 100, 50, alpha]));
    leaf(9).save(folder.path().join("leaf.png")).unwrap();
    leaf(255).save(folder.path().join("solid.png")).unwrap();
    let materials = [
        "map_Kd leaf.png\nmap_d leaf.png",
        "map_Kd solid.png\nmap_d solid.png",
        "map_Kd leaf.png\nmap_d -s 2 2 1 solid.png",
        "map_d leaf.png",
        "map_d -imfchan b -clamp on leaf.png",
        "map_d gone.png",
        "map_Kd leaf.png",
    ];
    let scene = with_materials(&folder, &materials);
    let found = |index: usize| scene.geometry.materials[index].opacity;
    let channels: Vec<_> = (0..5).map(|index| found(index).expect("a texture").channel.name()).collect();
    // The image that colours the surface: its alpha. Another: alpha if there is any.
    assert_eq!(channels, ["alpha", "alpha", "luminance", "alpha", "blue"]);
    assert!((0..5).all(|index| found(index).unwrap().mode == OpacityMode::Mask { cutoff: 0.5 }));
    assert_eq!((found(5), found(6)), (None, None));
    let uses = [found(2), found(4)].map(|opacity| opacity.unwrap().texture.unwrap());
    assert_eq!(
        uses.map(|uses| (uses.transform.matrix2.x_axis.x, uses.wrap[0])),
        [(2.0, lightmesh_scene::Wrap::Repeat), (1.0, lightmesh_scene::Wrap::Clamp)]
    );
    let warnings = scene.warnings.join("\n");
    assert!(warnings.contains("gone.png") && !warnings.contains("other than"), "{warnings}");
}

#[test]
fn thousands_of_texture_coordinates_at_one_place_are_read_quickly() {
    let count = 50_000;
    let uvs: String = (0..count).map(|i| format!("vt {i} 0\n")).collect();
    let faces: String = (1..=count).map(|i| format!("f 1/{i} 2/{i} 3/{i}\n")).collect();
    let mesh = open(&(TETRAHEDRON.to_owned() + &uvs + &faces)).geometry.mesh.clone();
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (count, 3 * count));
}

#[test]
fn unused_vertices_and_undefined_numbers_do_no_harm() {
    let scene = open(&format!("{TETRAHEDRON}v 1e17 0 0\nv nan 0 inf\nf 1 2 3\nf 1 2 6\n"));
    assert_eq!(scene.geometry.mesh.triangles.len(), 1);
    assert_eq!(scene.geometry.mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert!(scene.warnings[0].starts_with("1 triangles"), "{:?}", scene.warnings);
}

#[test]
fn a_file_cut_short_anywhere_ends_with_a_message_or_less() {
    let whole = format!("mtllib a b.mtl\n{TETRAHEDRON}vn 0 0 1\nusemtl x\nf 1//1 2//1 3//1 \\\n4//1\n");
    for length in 0..whole.len() {
        if let Err(message) = try_open(&whole[..length], "newmtl x\n") {
            assert!(message.contains(", shape.obj:"), "{message}");
        }
    }
}

/// What other programs read: warned about with its line, and read as what it must mean.
#[test]
fn what_others_read_is_read_with_a_warning() {
    const CASES: [(&str, &str); 9] = [
        ("v 0 0 0\nv 1.0f 0 0\nv 0 1 0\nf 1 2 3\n", "shape.obj:2: `1.0f` is an odd way to write a number, but known"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0 see below\nf 1 2 3\n", "shape.obj:3: `see` behind the numbers is ignored"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\n",
            "shape.obj:4: `1//1` refers to a normal, but there is none: it is ignored (the first of 3)",
        ),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1/-1/1 2/7/1 3/9/1\n",
            "shape.obj:5: `1/-1/1` refers to a texture coordinate, but there is none: it is ignored (the first of 3)",
        ),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn -nan(ind) 1.#QNAN0 nan\nf 1//1 2//1 3//1\n",
            "shape.obj:4: `-nan(ind)` is an odd way to write a number, but known (the first of 2)",
        ),
        (
            "v 0 0 0\nhello there\nv 1 0 0\nv 0 1 0\nworld\nf 1 2 3\n",
            "shape.obj:2: `hello` is an unknown statement, which is ignored (the first of 2)",
        ),
        ("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", "shape.obj:1: `1` refers to a line below it (the first of 3)"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\nf 1 2 3\n", "shape.obj: 1 points and lines were ignored"),
        (
            "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            "a b.mtl:3: `newmtl` has no name: it is for faces that name no material",
        ),
    ];
    for (obj, expected) in CASES {
        let scene = try_open(obj, "\nKa 1\nnewmtl\nKd 1 0 0\n").unwrap();
        assert_eq!(scene.geometry.mesh.triangles.len(), 1, "{obj}");
        let corners = scene.geometry.mesh.corners(0);
        assert_eq!(corners, [Vec3::ZERO, Vec3::X, Vec3::Y], "{obj}");
        assert!(scene.warnings.iter().any(|warning| warning.ends_with(expected)), "{obj}: {:?}", scene.warnings);
    }
}

#[test]
fn faces_above_their_points_are_as_below_them() {
    let points = format!("{TETRAHEDRON}vt 0.5 0.25\nvn 0 0 1\n");
    let faces = "f 1/1/1 2/1/1 3/1/1\nf 2 3 4\n";
    let [below, above] =
        [format!("{points}{faces}"), format!("{faces}{points}")].map(|text| open(&text).geometry.mesh.clone());
    assert_eq!((&below.triangles, &below.positions), (&above.triangles, &above.positions));
    assert_eq!((&below.normals, &below.uvs), (&above.normals, &above.uvs));
    // Only the normals are below; indices below 0 count from the face.
    let mixed =
        open(&format!("{TETRAHEDRON}f -4//1 -3//1 -2//1\nv 5 5 5\nvn 0 0 1\nf -5 -4 -3\n")).geometry.mesh.clone();
    assert_eq!([0, 1].map(|index| mixed.corners(index)), [[Vec3::ZERO, Vec3::X, Vec3::Y]; 2]);
    assert_eq!(mixed.normals[mixed.triangles[0][0] as usize], Vec3::Z);
}

#[test]
fn what_may_mean_several_things_is_refused() {
    for line in ["v 1,5 0 0", "v 1.0x 0 0", "vt 0 x", "f 0 1 2", "f 1 2 x", "f 1/2/3/4 2 3", "f 1.0 2 3"] {
        let message = try_open(&format!("{TETRAHEDRON}{line}\nf 1 2 3\n"), "").unwrap_err();
        assert!(message.contains(", shape.obj:5; "), "{line}: {message}");
    }
}

#[test]
fn files_with_paths_of_another_computer_are_found_next_to_the_file() {
    let folder = tempfile::tempdir().unwrap();
    image::RgbImage::new(2, 2).save(folder.path().join("oak.png")).unwrap();
    fs::write(folder.path().join("wood.mtl"), "newmtl oak\nmap_Kd \"C:\\Users\\me\\oak.png\"\n").unwrap();
    let path = folder.path().join("shape.obj");
    let faces = "vt 0 0\nusemtl oak\nf 1/1 2/1 3/1\n";
    fs::write(&path, format!("mtllib /home/me/wood.mtl\n{TETRAHEDRON}{faces}")).unwrap();
    let scene = Scene::open(&path).unwrap();
    assert!(scene.geometry.materials[0].texture.is_some(), "{:?}", scene.warnings);
    let found = [
        "`/home/me/wood.mtl` cannot be used; wood.mtl next to",
        r"`C:\Users\me\oak.png` cannot be used; oak.png next to",
    ];
    for part in found {
        assert!(scene.warnings.iter().any(|warning| warning.contains(part)), "{part}: {:?}", scene.warnings);
    }
}

#[test]
fn very_many_lines_of_one_kind_are_one_warning_and_take_no_time() {
    let lines: String =
        (0..40_000).map(|i| format!("odd{i} 1\nmtllib none{i}.mtl\nusemtl gone{i}\nf 1//1 2//1 3//1\n")).collect();
    let warnings = open(&(TETRAHEDRON.to_owned() + &lines)).warnings;
    assert_eq!(warnings.len(), 101, "{warnings:?}");
    assert!(warnings.iter().map(String::len).sum::<usize>() < 50_000);
}

/// Exporters write it whatever the material; a room of such materials would be black where no lamp shines.
#[test]
fn no_ambient_coefficient_is_the_diffuse_one() {
    for line in ["Ka 0 0 0", "Ka 0", ""] {
        let scene = try_open(
            "mtllib a b.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            &format!("newmtl a\n{line}\nKd 0.5 0.25 0\n"),
        );
        let material = &scene.unwrap().geometry.materials[0];
        assert_eq!((material.ka, material.kd), (Vec3::new(0.5, 0.25, 0.0), Vec3::new(0.5, 0.25, 0.0)), "{line}");
    }
}
