//! Images of normals on a floor, whose shading is that of a floor with other vertex normals.

use glam::{Affine2, Vec2, Vec3};
use lightmesh_render::{AmbientSource, Frame, Mode, Settings};
use lightmesh_scene::{
    Dielectric, LightKind, Lights, Material, NormalMap, Scene, Sky, SkyKind, Texture, TextureUse, Up,
};
use lightmesh_testkit::{SceneDraft, render};

use crate::mode;

/// The codes of a normal that leans to the right of the image by 76 / 102, and that normal on the floor.
const RIGHT: [u8; 3] = [128 + 76, 128, 128 + 102];
/// The same to the top of the image.
const TOP: [u8; 3] = [128, 128 + 76, 128 + 102];

/// The unit vector that leans by 76 / 102 from `up` to `aside`.
fn leaning(aside: Vec3, up: Vec3) -> Vec3 {
    (76.0 * aside + 102.0 * up).normalize()
}

/// A floor that reflects half of the light, x to the right of its images and −z to their top.
fn floor(texels: &[[u8; 3]], change: impl FnOnce(Material) -> Material) -> Scene {
    lit_floor(texels, change, Vec3::new(0.0, -1.0, 0.0), [0.0, 3.0, 0.2])
}

fn lit_floor(texels: &[[u8; 3]], change: impl FnOnce(Material) -> Material, sun: Vec3, eye: [f64; 3]) -> Scene {
    let map = NormalMap::new(TextureUse::new(0));
    let material = change(Material::matt([0.5; 3]).with_normal_texture(map));
    let sun = LightKind::Directional { direction: sun.normalize(), angle: 0.0 };
    let draft = SceneDraft::new().painted(material).floor(0.0, 300.0).light(sun).camera(eye, [0.0, 0.0, 0.1]);
    let mut scene = draft.finish("floor");
    let geometry = scene.geometry_mut();
    let texels: Vec<_> = texels.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
    geometry.textures = vec![Texture { name: "normals".into(), size: [texels.len() as u32, 1], texels }].into();
    geometry.mesh.uvs = geometry.mesh.positions.iter().map(|p| Vec2::new(p.x, p.z)).collect();
    scene
}

/// The same without an image of normals.
fn flat(mut material: Material) -> Material {
    material.normal_texture = None;
    material
}

fn frame(scene: &Scene) -> Frame {
    render(scene, &mode(Mode::RayTrace, [8, 6]))
}

/// What all of the image shows.
fn shown(scene: &Scene) -> f32 {
    let frame = frame(scene);
    let first = frame.color()[0][0];
    assert!(frame.color().iter().all(|color| (color[0] - first).abs() < 1e-5), "{:?}", frame.color());
    first
}

fn assert_shows(scene: &Scene, wanted: f32) {
    let found = shown(scene);
    assert!((found - wanted).abs() < 1e-5, "{found}, not {wanted}");
}

fn assert_same(a: &Scene, b: &Scene) {
    for settings in [mode(Mode::RayTrace, [16, 12]), Settings::default().with_size([16, 12]).with_bounces(1)] {
        assert_eq!(render(a, &settings).color(), render(b, &settings).color());
    }
}

#[test]
fn a_flat_image_changes_nothing() {
    let shine = |material: Material| material.with_ks([0.4; 3]);
    let without = floor(&[[0; 3]], |material| flat(shine(material)));
    assert_same(&floor(&[[128, 128, 255]], shine), &without);
    // No slopes, whatever the image says; nor from one that is not there.
    let scaled = |scale| {
        move |material: Material| {
            let map = material.normal_texture.unwrap().with_scale(scale);
            shine(material.with_normal_texture(map))
        }
    };
    assert_same(&floor(&[RIGHT], scaled(0.0)), &without);
    assert_same(&floor(&[RIGHT], |it| shine(it).with_normal_texture(NormalMap::new(TextureUse::new(7)))), &without);
    assert_ne!(frame(&floor(&[RIGHT], scaled(1.0))).color(), frame(&without).color());
}

#[test]
fn light_counts_by_its_angle_to_the_normal_of_the_image() {
    for (texel, normal) in [(RIGHT, leaning(Vec3::X, Vec3::Y)), (TOP, leaning(Vec3::NEG_Z, Vec3::Y))] {
        for sun in [Vec3::NEG_Y, Vec3::new(-1.0, -1.0, 0.3), Vec3::new(1.0, -2.0, 0.7)] {
            let scene = lit_floor(&[texel], |it| it, sun, [0.0, 3.0, 0.2]);
            assert_shows(&scene, 0.5 * normal.dot(-sun.normalize()).max(0.0));
        }
    }
}

#[test]
fn slopes_have_a_scale() {
    let sun = Vec3::new(-1.0, -2.0, 0.0);
    for (scale, normal) in [(0.5, Vec3::new(38.0, 102.0, 0.0)), (-1.0, Vec3::new(-76.0, 102.0, 0.0))] {
        let change = |it: Material| it.with_normal_texture(NormalMap::new(TextureUse::new(0)).with_scale(scale));
        let scene = lit_floor(&[RIGHT], change, sun, [0.0, 3.0, 0.2]);
        assert_shows(&scene, 0.5 * normal.normalize().dot(-sun.normalize()));
    }
}

#[test]
fn images_lean_as_they_lie() {
    let sun = Vec3::new(-1.0, -1.0, 0.4);
    let shows = |scene: &Scene, aside: Vec3| assert_shows(scene, 0.5 * leaning(aside, Vec3::Y).dot(-sun.normalize()));
    let new = |texel: [u8; 3]| lit_floor(&[texel], |it| it, sun, [0.0, 3.0, 0.2]);
    // Mirrored: right is left, top is top.
    for (texel, aside) in [(RIGHT, Vec3::NEG_X), (TOP, Vec3::NEG_Z)] {
        let mut scene = new(texel);
        scene.geometry_mut().mesh.uvs.iter_mut().for_each(|uv| uv.x = -uv.x);
        shows(&scene, aside);
    }
    // Turned by its texture coordinates, or as the material places it: right is where v grows.
    let mut scene = new(RIGHT);
    scene.geometry_mut().mesh.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(3.0 * uv.y, uv.x));
    shows(&scene, Vec3::Z);
    let turned = Affine2::from_cols_array(&[0.0, -0.7, 0.5, 0.0, 0.3, 0.1]);
    let uses = TextureUse { transform: turned, ..TextureUse::new(0) };
    let placed = |it: Material| it.with_normal_texture(NormalMap::new(uses));
    shows(&lit_floor(&[RIGHT], placed, sun, [0.0, 3.0, 0.2]), Vec3::Z);
    // Stretched along a line, it says nothing.
    let mut scene = new(RIGHT);
    scene.geometry_mut().mesh.uvs.iter_mut().for_each(|uv| uv.y = uv.x);
    assert_shows(&scene, 0.5 * Vec3::Y.dot(-sun.normalize()));
}

#[test]
fn bumps_are_dents_from_behind() {
    let sun = Vec3::new(-1.0, 2.0, 0.0);
    let scene = lit_floor(&[RIGHT], |it| it, sun, [0.0, -3.0, 0.2]);
    assert_shows(&scene, 0.5 * -leaning(Vec3::X, Vec3::Y).dot(-sun.normalize()));
}

#[test]
fn vertex_normals_are_what_images_turn() {
    let sun = Vec3::new(-0.2, -1.0, -0.3);
    let mut scene = lit_floor(&[RIGHT], |it| it, sun, [0.0, 3.0, 0.2]);
    let smooth = Vec3::new(0.3, 1.0, 0.0).normalize();
    let geometry = scene.geometry_mut();
    geometry.mesh.normals = vec![smooth; geometry.mesh.positions.len()];
    assert_shows(&scene, 0.5 * leaning(Vec3::new(1.0, -0.3, 0.0).normalize(), smooth).dot(-sun.normalize()));
}

#[test]
fn small_images_are_flat_in_the_distance() {
    // Leaning to both sides, more than a texel in a pixel.
    let both = [RIGHT, [128 - 76, 128, 128 + 102]];
    let mut scene = lit_floor(&both, |it| it, Vec3::NEG_Y, [0.0, 2.0, 0.2]);
    scene.geometry_mut().mesh.uvs.iter_mut().for_each(|uv| *uv *= 1000.0);
    for color in render(&scene, &Settings::default().with_size([16, 12])).color() {
        assert!((color[0] - 0.5).abs() < 1e-3, "{color:?}");
    }
}

#[test]
fn light_fades_before_it_sinks() {
    let shown_at = |degrees: f32| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        shown(&lit_floor(&[RIGHT], |it| it, Vec3::new(-cosine, -sine, 0.0), [0.0, 3.0, 0.2]))
    };
    let normal = leaning(Vec3::X, Vec3::Y);
    assert!(
        (shown_at(7.0) - 0.5 * normal.dot(Vec3::new(7f32.to_radians().cos(), 7f32.to_radians().sin(), 0.0))).abs()
            < 1e-5
    );
    let low: Vec<f32> = (1..60).map(|tenths| shown_at(tenths as f32 / 10.0)).collect();
    assert!(low.is_sorted() && low[0] < 0.005 && low[58] > 0.3, "{low:?}");
    assert_eq!(shown_at(-1.0), 0.0);
}

/// What a mirror of this material shows of a sky of which every height is different; with other vertex normals if they are given.
fn mirrored(change: impl Fn(Material) -> Material, eye: [f64; 3], normal: Option<Vec3>) -> Frame {
    let mirror = |it: Material| change(it.with_kd(Vec3::ZERO).with_ka(Vec3::ZERO));
    let mut scene = lit_floor(&[RIGHT], mirror, Vec3::NEG_Y, eye);
    let (zenith, horizon) = (Vec3::new(0.0, 1.0, 0.5), Vec3::new(1.0, 0.0, 0.5));
    let sky = Sky::new(SkyKind::Gradient { zenith, horizon, ground: Vec3::new(0.0, 0.0, 9.0) });
    scene.lights = Lights::default();
    scene.lights.surround(sky.surroundings(Up::Y).unwrap());
    scene.lights.list.clear();
    let geometry = scene.geometry_mut();
    geometry.mesh.normals = normal.iter().flat_map(|&normal| vec![normal; geometry.mesh.positions.len()]).collect();
    render(&scene, &mode(Mode::RayTrace, [8, 6]).with_bounces(1).with_ambient_light(AmbientSource::Constant))
}

/// Fails if the left half of two images differs.
fn assert_left_same(a: &Frame, b: &Frame) {
    for (pixel, (a, b)) in a.color().iter().zip(b.color()).enumerate().filter(|(pixel, _)| pixel % 8 < 4) {
        assert!((Vec3::from_array(*a) - Vec3::from_array(*b)).abs().max_element() < 1e-4, "{pixel}: {a:?} {b:?}");
    }
}

#[test]
fn mirrors_lean_too() {
    let mirror = |it: Material| it.with_ks([1.0; 3]);
    let plain = |it: Material| flat(mirror(it));
    let (above, normal) = ([0.0, 3.0, 0.1], leaning(Vec3::X, Vec3::Y));
    let image = mirrored(mirror, above, None);
    assert_left_same(&image, &mirrored(plain, above, Some(normal)));
    assert!(image.color() != mirrored(plain, above, None).color());
    // Whatever the view, nothing from below the floor is seen.
    for x in [-20.0, -4.0, -1.0, 1.0, 4.0, 20.0] {
        let frame = mirrored(mirror, [x, 1.0, 0.1], None);
        assert!(frame.color().iter().all(|color| color[2] < 1.0), "{x}: {:?}", frame.color());
    }
}

#[test]
fn glass_bends_light_by_its_relief() {
    let glass = |it: Material| Material::of(Dielectric::new(1.5)).with_normal_texture(it.normal_texture.unwrap());
    let plain = |it: Material| flat(glass(it));
    let (above, normal) = ([0.0, 3.0, 0.1], leaning(Vec3::X, Vec3::Y));
    let image = mirrored(glass, above, None);
    assert_left_same(&image, &mirrored(plain, above, Some(normal)));
    assert!(image.color() != mirrored(plain, above, None).color());
}

#[test]
fn gathered_light_comes_from_where_the_image_faces() {
    // A wall that glows, to the right of the floor.
    let glow = Material::matt([0.0; 3]).with_emission([1.0; 3]);
    let wall = [[1.5, 0.0, -2.0], [1.5, 3.0, -2.0], [1.5, 3.0, 2.0], [1.5, 0.0, 2.0]];
    let draft = || SceneDraft::new().painted(Material::matt([0.5; 3])).floor(0.0, 2.0).painted(glow.clone()).quad(wall);
    let draft = || draft().camera([0.0, 1.0, 0.02], [0.0, 0.0, 0.0]);
    let with = |texel: Option<[u8; 3]>, normal: Option<Vec3>| {
        let mut scene = draft().finish("beside a wall");
        let geometry = scene.geometry_mut();
        geometry.textures = texel
            .map(|[r, g, b]| Texture { name: String::new(), size: [1, 1], texels: vec![[r, g, b, 255]] })
            .into_iter()
            .collect::<Vec<Texture>>()
            .into();
        geometry.materials[1].normal_texture = texel.map(|_| NormalMap::new(TextureUse::new(0)));
        geometry.mesh.uvs = geometry.mesh.positions.iter().map(|p| Vec2::new(p.x, p.z)).collect();
        if let Some(normal) = normal {
            geometry.mesh.normals = geometry.mesh.positions.iter().map(|_| normal).collect();
        }
        let settings = Settings::default().with_ambient_light(AmbientSource::Mesh).with_size([8, 6]).with_aa(1);
        let frame = render(&scene, &settings);
        frame.color().iter().map(|color| color[0]).sum::<f32>() / 48.0
    };
    let [flat, image, vertices] =
        [with(None, None), with(Some(RIGHT), None), with(None, Some(leaning(Vec3::X, Vec3::Y)))];
    assert!(image > 1.3 * flat && (image - vertices).abs() < 1e-3 * image, "{flat} {image} {vertices}");
}
