//! What is cut out, and what lets light through.

use glam::Vec3;
use lightmesh_scene::{Dielectric, Opacity, OpacityChannel, OpacityMode, Scene, Wrap};

use super::open;
use super::textured_folder;

#[test]
fn a_material_may_be_cut_out() {
    let (folder, path) = textured_folder(
        r#"
        [[material]]
        name = "leaf"
        texture = "oak.png"
        opacity_texture = "leaf.png"
        opacity_cutoff = 0.25
        texture_scale = 3
        [[material]]
        name = "fence"
        opacity_texture = "oak.png"
        texture_wrap = "mirror"
        [[plane]]
        point = [0, 0, 0]
        normal = [0, 1, 0]
        size = [1, 1]
        material = "fence"
        "#,
    );
    let leaf = image::RgbaImage::from_pixel(1, 1, image::Rgba([0, 0, 0, 99]));
    leaf.save_with_format(folder.path().join("leaf.png"), image::ImageFormat::Png).unwrap();
    let scene = Scene::open(path).unwrap();
    let materials = &scene.geometry.materials;
    let [leaf, fence] = [0, 1].map(|index: usize| materials[index].opacity.unwrap());
    let mask = |cutoff| OpacityMode::Mask { cutoff };
    assert_eq!((leaf.channel, leaf.mode), (OpacityChannel::Alpha, mask(0.25)));
    assert_eq!((fence.channel, fence.mode), (OpacityChannel::Luminance, mask(0.5)));
    let (color, opacity) = (materials[0].texture.unwrap(), leaf.texture.unwrap());
    assert_eq!((color.transform, color.texture, opacity.texture), (opacity.transform, 0, 1));
    assert_eq!((materials[1].texture, fence.texture.unwrap().wrap), (None, [Wrap::Mirror; 2]));
    // What is cut out has texture coordinates.
    assert!(!scene.geometry.mesh.uvs.is_empty() && scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn a_material_may_let_light_through() {
    let (_folder, path) = textured_folder(
        r#"
        [[material]]
        name = "pane"
        opacity = 0.25
        filter = [0.5, 1, 0.75]
        [[material]]
        name = "foil"
        opacity = 0
        filter = [1, 0, 0]
        [[material]]
        name = "curtain"
        opacity_texture = "oak.png"
        opacity = 0.5
        "#,
    );
    let scene = Scene::open(path).unwrap();
    let opacity = |index: usize| scene.geometry.materials[index].opacity.unwrap();
    assert_eq!(opacity(0), Opacity::blend(0.25).with_filter([0.5, 1.0, 0.75]));
    assert_eq!(opacity(1), Opacity::blend(0.0).with_filter([1.0, 0.0, 0.0]));
    let curtain = opacity(2);
    assert_eq!((curtain.factor, curtain.filter(), curtain.texture.is_some()), (0.5, Some(Vec3::ONE), true));
    assert_eq!(scene.info().see_through, 3);
    assert!(scene.info().to_string().contains("(3 see-through)"), "{}", scene.info());
}

#[test]
fn a_material_may_be_glass() {
    let scene = open(
        r#"
        [[material]]
        name = "lens"
        ior = 1.5
        absorption = [1, 0, 0.5]
        [[material]]
        name = "window"
        ior = 1.6
        thin = true
        opacity = 0.25
        filter = [0.5, 1, 1]
        "#,
    );
    let material = |index: usize| &scene.geometry.materials[index];
    let lens = Dielectric::new(1.5).with_absorption([1.0, 0.0, 0.5]);
    assert_eq!((material(0).dielectric, material(0).opacity), (Some(lens), Some(Opacity::blend(0.0))));
    let window = Dielectric::new(1.6).with_thin(true);
    let tinted = Opacity::blend(0.25).with_filter([0.5, 1.0, 1.0]);
    assert_eq!((material(1).dielectric, material(1).opacity), (Some(window), Some(tinted)));
}

#[test]
fn wrong_opacities_name_line_and_key() {
    let message = |lines: &str| {
        let (_folder, path) = textured_folder(&format!("[[material]]\nname = \"leaf\"\n{lines}"));
        Scene::open(path).unwrap_err().to_string()
    };
    let alone = message("opacity_cutoff = 0.5");
    assert!(alone.contains("room.toml:3") && alone.contains("no effect without an opacity texture"), "{alone}");
    let both = message("opacity_texture = \"oak.png\"\nopacity_cutoff = 0.5\nopacity = 0.5");
    assert!(both.contains("room.toml:4") && both.contains("no effect where light goes through"), "{both}");
    let solid = message("filter = [1, 0, 0]");
    assert!(solid.contains("room.toml:3") && solid.contains("no effect on an opaque surface"), "{solid}");
    let adding = message("opacity = 0\nfilter = [1, 2, 0]");
    assert!(adding.contains("room.toml:4") && adding.contains("adds light that is not there"), "{adding}");
    let solid = message("kd = 0.5\nthin = true");
    assert!(solid.contains("room.toml:4") && solid.contains("without an index of refraction"), "{solid}");
    let flat = message("ior = 1.5\nthin = true\nabsorption = 1");
    assert!(flat.contains("room.toml:5") && flat.contains("a wall without thickness"), "{flat}");
    let large = message("opacity_texture = \"oak.png\"\nopacity_cutoff = 2");
    assert!(large.contains("room.toml:4") && large.contains("is not between 0 and 1"), "{large}");
}
