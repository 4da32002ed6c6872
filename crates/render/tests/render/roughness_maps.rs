//! Images of how rough and metallic a floor is, whose parts look like floors that are as rough and metallic everywhere.

use std::ops::Range;

use glam::{Vec2, Vec3};
use lightmesh_render::{AmbientSource, Frame, Mode, Settings};
use lightmesh_scene::{Facets, Light, Material, Scene, Sky, SkyKind, Texture, TextureUse, Up, Wrap};
use lightmesh_testkit::{SceneDraft, render};

use crate::mode;

const SIZE: [u32; 2] = [48, 36];
/// The columns of pixels to whose samples the seam is too far away, also in mip levels: left and right of it.
const LEFT: Range<usize> = 0..14;
const RIGHT: Range<usize> = 34..48;
/// Texels along the image, whose middle is below the camera.
const TEXELS: u32 = 64;

/// A floor of copper below a sky and two lights. It has a white image in any case, so that what its samples see has a width.
fn floor(change: impl FnOnce(Material) -> Material) -> Scene {
    let copper = Material::matt([0.9, 0.6, 0.5]).with_ks([Facets::LAYER; 3]);
    let material = change(copper.with_texture(TextureUse::new(1)));
    let draft = SceneDraft::new().painted(material).floor(0.0, 2.0).camera([0.0, 3.0, 0.2], [0.0, 0.0, 0.1]);
    let mut scene = draft.finish("floor");
    let (zenith, horizon) = (Vec3::new(0.0, 1.0, 0.5), Vec3::new(1.0, 0.0, 0.5));
    let sky = Sky::new(SkyKind::Gradient { zenith, horizon, ground: Vec3::ZERO });
    scene.lights.surround(sky.surroundings(Up::Y).unwrap());
    let panel = Light::rectangle(Vec3::new(0.3, 2.5, -1.0), 0.5 * Vec3::X, 0.25 * Vec3::Z).unwrap();
    scene.lights.list = vec![panel, Light::directional(Vec3::new(0.2, -1.0, 0.1)).unwrap()];
    let image = |texel: [u8; 4]| Texture { name: String::new(), size: [1, 1], texels: vec![texel] };
    scene.geometry_mut().textures = vec![image([0, 0, 0, 255]), image([255; 4])].into();
    let mesh = &mut scene.geometry_mut().mesh;
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(0.25 * p.x + 0.5, p.z)).collect();
    scene
}

/// The same with an image on it whose left and right halves are these texels.
fn halves(facets: Facets, [left, right]: [[u8; 3]; 2]) -> Scene {
    let uses = TextureUse { wrap: [Wrap::Clamp; 2], ..TextureUse::new(0) };
    let mut scene = floor(|material| material.with_facets(facets).with_metallic_roughness_texture(uses));
    let texel = |index: u32| if index < TEXELS / 2 { left } else { right };
    let texels = (0..TEXELS).map(texel).map(|[r, g, b]| [r, g, b, 255]).collect();
    scene.geometry_mut().textures[0] = Texture { name: "halves".into(), size: [TEXELS, 1], texels };
    scene
}

/// What a texel stands for.
fn share(code: u8) -> f32 {
    f32::from(code) / 255.0
}

/// The pixels on one side of the seam.
fn side(frame: &Frame, columns: Range<usize>) -> Vec<[f32; 3]> {
    frame
        .color()
        .iter()
        .copied()
        .enumerate()
        .filter(|(pixel, _)| columns.contains(&(pixel % SIZE[0] as usize)))
        .map(|(_, it)| it)
        .collect()
}

/// The largest relative difference of two images.
fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let apart =
        |(a, b): (&[f32; 3], &[f32; 3])| ((Vec3::from(*a) - Vec3::from(*b)) / Vec3::from(*b)).abs().max_element();
    a.iter().zip(b).map(apart).fold(0.0, f32::max)
}

fn all_settings() -> [Settings; 4] {
    let plain = mode(Mode::RayTrace, SIZE).with_ambient_light(AmbientSource::Constant);
    let samples = |bounces: u32| plain.clone().with_aa(4).with_bounces(bounces);
    [plain.clone(), plain.clone().with_bounces(1), samples(0), samples(1)]
}

/// Fails if a half of the floor differs from a whole floor with the facets that its texel stands for.
fn assert_as_plain(facets: Facets, texels: [[u8; 3]; 2]) {
    let image = halves(facets, texels);
    let plain = texels.map(|[_, green, blue]| {
        let own = Facets::new(facets.roughness * share(green)).with_metallic(facets.metallic * share(blue));
        floor(|material| material.with_facets(own.with_grazing(facets.grazing)))
    });
    for settings in all_settings() {
        let image = render(&image, &settings);
        let [left, right] = plain.each_ref().map(|scene| render(scene, &settings));
        assert!(side(&image, LEFT) == side(&left, LEFT), "left, {texels:?}");
        assert!(side(&image, RIGHT) == side(&right, RIGHT), "right, {texels:?}");
        let differs = |columns: Range<usize>| side(&left, columns.clone()) != side(&right, columns);
        assert!(differs(LEFT) && differs(RIGHT), "both sides are alike: {texels:?}");
    }
}

#[test]
fn a_half_that_is_rough_is_like_a_rough_floor() {
    // Both mirror a part, so that samples are shaded apart with an image and without.
    assert_as_plain(Facets::new(1.0), [[0, 51, 0], [255, 102, 255]]);
    assert_as_plain(Facets::new(0.5).with_metallic(0.75).with_grazing(0.5), [[0, 204, 255], [0, 25, 255]]);
}

#[test]
fn a_half_that_is_metal_is_like_a_floor_of_metal() {
    assert_as_plain(Facets::new(0.25).with_metallic(1.0), [[0, 255, 0], [0, 255, 255]]);
    assert_as_plain(Facets::new(0.25).with_metallic(0.5), [[0, 255, 102], [9, 255, 204]]);
}

#[test]
fn an_image_that_is_white_or_nowhere_changes_nothing() {
    let facets = Facets::new(0.3).with_metallic(0.6);
    let plain = floor(|material| material.with_facets(facets));
    let white = halves(facets, [[0, 255, 255]; 2]);
    let gone = floor(|it| it.with_facets(facets).with_metallic_roughness_texture(TextureUse::new(7)));
    for settings in all_settings() {
        let plain = render(&plain, &settings);
        assert!(render(&white, &settings).color() == plain.color(), "white");
        assert!(render(&gone, &settings).color() == plain.color(), "gone");
    }
    let mut image = halves(facets, [[0; 3]; 2]);
    image.geometry_mut().materials[1].facets = None;
    let without = floor(|material| material);
    let settings = &all_settings()[0];
    assert!(render(&image, settings).color() == render(&without, settings).color(), "no facets");
}

#[test]
fn small_images_are_their_mean_in_the_distance() {
    let mut image = halves(Facets::new(1.0).with_metallic(1.0), [[0, 51, 255], [0, 153, 51]]);
    let geometry = image.geometry_mut();
    geometry.mesh.uvs.iter_mut().for_each(|uv| *uv *= 4000.0);
    geometry.materials[1].metallic_roughness_texture = Some(TextureUse::new(0));
    let plain = floor(|material| material.with_facets(Facets::new(0.4).with_metallic(0.6)));
    for bounces in [0, 1] {
        let settings = mode(Mode::RayTrace, SIZE).with_aa(4).with_bounces(bounces);
        let [image, plain] = [&image, &plain].map(|scene| render(scene, &settings));
        let apart = difference(image.color(), plain.color());
        assert!(apart < 1e-3, "{apart}");
    }
}
