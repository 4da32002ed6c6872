//! Textures that are smaller in the image than they are: no moiré, nothing brighter or darker, in mirrors as well.

use std::ops::Range;

use glam::{Affine2, DVec3, Vec2, Vec3, Vec3Swizzles};
use lightmesh_render::{Crop, Filter, Frame, Settings, Sharing};
use lightmesh_scene::{Material, Scene, Texture, TextureUse, Wrap};
use lightmesh_testkit::{SceneDraft, render};

const SIZE: [u32; 2] = [96, 72];
/// The first row below the horizon.
const HORIZON: usize = 36;
/// The first row in which pixels, at least as far apart along the floor, are as far apart across as checks are wide.
const CLOSE: usize = 52;
/// Checks per unit of length.
const CHECKS: f32 = 10.0;

/// A texture of black and white checks of `side` x `side` texels.
fn checks(size: [u32; 2], side: u32) -> Texture {
    let texel = |index: u32| match (index % size[0] / side + index / size[0] / side) % 2 {
        0 => [0, 0, 0, 255],
        _ => [255; 4],
    };
    Texture { name: "checks".to_owned(), size, texels: (0..size[0] * size[1]).map(texel).collect() }
}

/// What has nothing but its texture.
fn shown(wrap: [Wrap; 2]) -> Material {
    let uses = TextureUse { wrap, ..TextureUse::new(0) };
    Material::default().with_ka([1.0; 3]).with_kd([0.0; 3]).with_texture(uses)
}

/// A draft with a texture on everything, `repeats` times per unit of length along x and z.
fn textured(draft: SceneDraft, texture: Texture, repeats: Vec2) -> Scene {
    let mut scene = draft.background(Vec3::splat(0.5)).finish("textured");
    let origin = scene.geometry.origin.as_vec3();
    let geometry = scene.geometry_mut();
    geometry.textures = vec![texture].into();
    let mesh = &mut geometry.mesh;
    mesh.uvs = mesh.positions.iter().map(|p| repeats * (origin + *p - Vec3::splat(0.5 / CHECKS)).xz()).collect();
    scene
}

/// A floor to the horizon. Its texture has checks of `side` texels.
fn floor(size: [u32; 2], side: u32, wrap: Wrap) -> Scene {
    let draft = SceneDraft::new().ambient(1.0).painted(shown([wrap; 2])).floor(0.0, 2000.0);
    let draft = draft.camera([0.0, 1.5, 0.0], [0.3, 1.5, -1.0]);
    let checks_across = Vec2::new(size[0] as f32, size[1] as f32) / side as f32;
    textured(draft, checks(size, side), CHECKS / checks_across)
}

/// Settings for rows of the image alone.
fn of(settings: &Settings, rows: &Range<usize>) -> Settings {
    settings.clone().with_crop(Crop::new([0, rows.start as i32], [SIZE[0], rows.len() as u32]))
}

/// All pixels, one channel.
fn values(frame: &Frame) -> impl Iterator<Item = f64> {
    frame.color().iter().map(|color| f64::from(color[0]))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    values.for_each(|value| (sum, count) = (sum + value, count + 1));
    sum / f64::from(count)
}

fn with(scene: &Scene, aa: u32, rows: Range<usize>) -> Frame {
    render(scene, &of(&Settings::default().with_size(SIZE).with_aa(aa), &rows))
}

/// The largest and the mean difference from another image.
fn differences(frame: &Frame, other: &Frame) -> [f64; 2] {
    let apart = || values(frame).zip(values(other)).map(|(a, b)| (a - b).abs());
    [apart().fold(0.0, f64::max), mean(apart())]
}

/// Fails if rows of an image with 8 samples differ from those of many samples, each of which sees less than a texel: by more than `most` at
/// one pixel, on average, or in their relative means.
fn check(scene: &Scene, settings: &Settings, rows: Range<usize>, most: [f64; 3], what: &str) {
    let [reference, frame] = [256, 8].map(|aa| render(scene, &of(settings, &rows).with_aa(aa)));
    let [largest, usual] = differences(&frame, &reference);
    let means = [&frame, &reference].map(|frame| mean(values(frame)));
    assert!(largest < most[0] && usual < most[1], "{what}: {largest}, {usual} on average, {means:?}");
    let [found, wanted] = means;
    assert!((found / wanted - 1.0).abs() < most[2], "{what}: {found} instead of {wanted}");
}

#[test]
fn checks_to_the_horizon_have_no_moire_and_keep_their_energy() {
    let settings = Settings::default().with_size(SIZE);
    let (repeat, mirror) = (Wrap::Repeat, Wrap::Mirror);
    let kinds = [([2, 2], 1, repeat), ([64, 64], 8, repeat), ([64, 64], 8, mirror), ([60, 36], 6, repeat)];
    let odd = [([6, 50], 1, repeat), ([1, 20], 1, repeat), ([20, 1], 1, mirror), ([7, 5], 1, repeat)];
    for (size, side, wrap) in kinds.into_iter().chain(odd) {
        let scene = floor(size, side, wrap);
        let settings = settings.clone().with_sharing(if side == 6 { Sharing::Never } else { Sharing::default() });
        check(&scene, &settings, HORIZON..CLOSE, [0.2, 0.025, 0.01], &format!("{size:?}, {wrap:?}"));
        if size[0] % 2 == 0 && size[1] % 2 == 0 {
            // Many checks in a pixel: their mean.
            let frame = with(&scene, 8, HORIZON..HORIZON + 5);
            let most = values(&frame).map(|value| (value - 0.5).abs()).fold(0.0, f64::max);
            assert!(most < 0.03, "{size:?}, {wrap:?}: {most}");
        }
    }
}

#[test]
fn a_clamped_texture_ends_in_the_distance() {
    // Checks from -20 to 20 across and to -40 in the distance; where they end, a pixel may see both, and footprints end, too.
    let mut scene = floor([800, 800], 2, Wrap::Clamp);
    let uses = scene.geometry_mut().materials[1].texture.as_mut().unwrap();
    uses.transform = Affine2::from_translation(Vec2::new(0.5, 1.0));
    check(&scene, &Settings::default().with_size(SIZE), HORIZON..CLOSE, [0.45, 0.03, 0.02], "clamped");
}

#[test]
fn one_sample_sees_a_point() {
    let hard = with(&floor([64, 64], 8, Wrap::Repeat), 1, HORIZON..CLOSE);
    let usual = mean(values(&hard).map(|value| (value - 0.5).abs()));
    assert!(usual > 0.4, "black or white, not grey: {usual}");
}

#[test]
fn a_pixel_of_a_whole_number_of_texels_sees_that_level() {
    let view = |texels_per_pixel: f64| {
        let draft = SceneDraft::new().ambient(1.0).painted(shown([Wrap::Repeat; 2])).floor(0.0, 500.0);
        let height = (f64::from(SIZE[1]) * texels_per_pixel) as f32;
        let draft = draft.orthographic([0.0, 5.0, 0.0], [0.0, 0.0, 0.0], height);
        let scene = textured(draft, checks([16, 16], 1), Vec2::splat(1.0 / 16.0));
        let frame = render(&scene, &Settings::default().with_size(SIZE).with_aa(4).with_filter(Filter::Box));
        values(&frame).map(|value| (value - 0.5).abs()).fold(0.0, f64::max)
    };
    // A quarter of the pixel's area has an edge of two texels: the first level, in which all texels are grey.
    assert!(view(4.0) < 1e-6 && view(8.0) < 1e-6, "{} {}", view(4.0), view(8.0));
    assert!(view(3.8) > 1e-3, "{}", view(3.8));
}

#[test]
fn mirrors_show_filtered_textures() {
    let mirror = Material::default().with_ka([0.0; 3]).with_kd([0.0; 3]).with_ks([1.0; 3]);
    let floor =
        || SceneDraft::new().ambient(1.0).painted(shown([Wrap::Repeat; 2])).floor(0.0, 60.0).painted(mirror.clone());
    let wall = [[-60.0, -1.0, -4.0], [60.0, -1.0, -4.0], [60.0, 60.0, -4.0], [-60.0, 60.0, -4.0]];
    let scenes =
        [("wall", floor().quad(wall)), ("ball", floor().smooth_ball(DVec3::new(0.0, 1.5, -4.0), 1.4, [32, 64]))];
    for (name, draft) in scenes {
        let draft = draft.camera([0.0, 1.5, 0.0], [0.0, 1.5, -1.0]);
        let scene = textured(draft, checks([32, 32], 8), Vec2::splat(CHECKS / 4.0));
        let settings = Settings::default().with_size(SIZE).with_bounces(1);
        check(&scene, &settings, HORIZON..CLOSE, [0.25, 0.05, 0.01], name);
    }
}
