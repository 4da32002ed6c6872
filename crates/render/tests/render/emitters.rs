//! Emissive surfaces of every size, strength, side and texture light what is around as their integrals say.

use std::f64::consts::PI;

use glam::{DMat4, DVec3, Vec2, Vec3};
use lightmesh_render::{AmbientSource, Device, Renderer, Settings};
use lightmesh_scene::{Geometry, Material, Mesh, Scene, Texture, TextureUse, Up};
use lightmesh_testkit::SceneDraft;

/// A quadrilateral, corner by corner around its border.
type Quad = [[f64; 3]; 4];

/// A horizontal rectangle about a point; seen from above, its corners are counter-clockwise.
fn level([x, y, z]: [f64; 3], [half_x, half_z]: [f64; 2]) -> Quad {
    let corner = |a: f64, b: f64| [x + a * half_x, y, z + b * half_z];
    [corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)]
}

fn glowing(radiance: f32) -> Material {
    Material::matt([0.0; 3]).with_emission([radiance; 3])
}

fn white(kd: f32) -> Material {
    Material::matt([kd; 3])
}

/// What a surface at `point` shows of a rectangle: ∫ k_d / π L cos cos' / d² over it.
fn expected(kd: f64, radiance: f64, [a, b, _, d]: Quad, point: [f64; 3], normal: DVec3) -> f64 {
    let [a, b, d, point] = [a, b, d, point].map(DVec3::from);
    let (u, v, n) = (b - a, d - a, 256);
    let (area, facing) = (u.cross(v).length(), u.cross(v).normalize());
    let place = |index: usize| (index as f64 + 0.5) / n as f64;
    let part = |(i, j): (usize, usize)| {
        let way = a + place(i) * u + place(j) * v - point;
        normal.dot(way).max(0.0) * facing.dot(way).abs() / way.length_squared().powi(2)
    };
    kd / PI * radiance * area * (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(part).sum::<f64>() / (n * n) as f64
}

/// What the middle of the image shows if a camera looks from one place to another, with direct light alone.
fn shown(mut scene: Scene, from: [f64; 3], to: [f64; 3]) -> f64 {
    let camera = SceneDraft::new().floor(0.0, 1.0).camera(from, to).finish("camera");
    scene.cameras = camera.cameras;
    scene.lights.ambient = Some(Vec3::ZERO);
    let settings = Settings::default().with_size([1, 1]).with_aa(1).with_ambient_light(AmbientSource::Constant);
    let frame = Renderer::new(Device::Cpu).unwrap().render(&scene, &settings).unwrap();
    f64::from(frame.color()[0][0])
}

/// What the floor of `kd` shows under the origin.
fn floor_shows(scene: &Scene) -> f64 {
    shown(scene.clone(), [0.0, 1.9, 0.01], [0.0, 0.0, 0.0])
}

fn assert_near(shown: f64, expected: f64, error: f64) {
    assert!((shown / expected - 1.0).abs() < error, "{shown}, not {expected}");
}

/// A floor 5 by 5 that reflects a half, with lamps.
fn lit(lamps: impl IntoIterator<Item = (Material, Quad)>) -> Scene {
    let draft = SceneDraft::new().painted(white(0.5)).floor(0.0, 2.5);
    let draft = lamps.into_iter().fold(draft, |draft, (material, quad)| draft.painted(material).quad(quad));
    let mut scene = draft.finish("lit");
    scene.add_lamps();
    scene
}

#[test]
fn a_luminous_ceiling_lights_the_floor() {
    let panel = level([0.0, 2.4, 0.0], [1.2, 1.2]);
    let scene = lit([(glowing(10.0), panel)]);
    assert!((2..=16).contains(&scene.lights.len()), "{}", scene.lights.len());
    assert_near(floor_shows(&scene), 1.197, 0.01);
    assert_near(floor_shows(&scene), expected(0.5, 10.0, panel, [0.0; 3], DVec3::Y), 0.01);
}

#[test]
fn a_weak_lamp_is_the_only_light() {
    let panel = level([0.0, 2.4, 0.0], [0.15, 0.15]);
    let mut scene = lit([(glowing(5.0), panel)]);
    assert!(!scene.complete(Up::Y).lights && scene.lights.len() == 1);
    assert_near(floor_shows(&scene), expected(0.5, 5.0, panel, [0.0; 3], DVec3::Y), 0.01);
    assert!((0.011..0.013).contains(&floor_shows(&scene)), "{}", floor_shows(&scene));
}

#[test]
fn a_strip_lights_the_floor_and_the_ceiling() {
    let strip = level([0.0, 2.4, 0.0], [0.95, 0.02]);
    let ceiling = (white(0.5), level([0.0, 2.5, 0.0], [2.5, 2.5]));
    let scene = lit([ceiling, (glowing(50.0), strip)]);
    assert_near(floor_shows(&scene), 0.095, 0.03);
    assert_near(floor_shows(&scene), expected(0.5, 50.0, strip, [0.0; 3], DVec3::Y), 0.01);
}

#[test]
fn one_sided_emitters_shine_to_their_front() {
    let strip = level([0.0, 2.0, 0.0], [0.25, 0.05]);
    let ceiling = (white(0.7), level([0.0, 2.5, 0.0], [2.5, 2.5]));
    let place = [0.4, 2.5, 0.0];
    let above = |scene: &Scene| shown(scene.clone(), [0.41, 2.2, 0.0], place);
    let of_ceiling = expected(0.7, 50.0, strip, place, DVec3::NEG_Y);
    let of_floor = expected(0.5, 50.0, strip, [0.0; 3], DVec3::Y);
    for (one_sided, is_turned, up, down) in
        [(true, false, true, false), (true, true, false, true), (false, false, true, true), (false, true, true, true)]
    {
        let [a, b, c, d] = strip;
        let strip = if is_turned { [d, c, b, a] } else { strip };
        let scene = lit([ceiling.clone(), (glowing(50.0).with_one_sided(one_sided), strip)]);
        assert_eq!(scene.lights.len(), usize::from(up) + usize::from(down));
        match up {
            true => assert_near(above(&scene), of_ceiling, 0.03),
            false => assert_eq!(above(&scene), 0.0),
        }
        match down {
            true => assert_near(floor_shows(&scene), of_floor, 0.03),
            false => assert_eq!(floor_shows(&scene), 0.0),
        }
    }
}

#[test]
fn a_large_lamp_does_not_change_a_small_one_of_its_material() {
    let (large, small) = (level([0.0, 2.4, 0.0], [1.2, 1.2]), level([1.6, 1.0, 1.0], [0.1, 0.1]));
    let draft = SceneDraft::new().painted(white(0.5)).floor(0.0, 2.5);
    let mut scene = draft.painted(glowing(10.0)).quad(large).quad(small).finish("both");
    scene.add_lamps();
    let under = |[x, z]: [f64; 2]| {
        let all = [large, small].map(|quad| expected(0.5, 10.0, quad, [x, 0.0, z], DVec3::Y));
        assert_near(shown(scene.clone(), [x, 0.5, z + 0.01], [x, 0.0, z]), all[0] + all[1], 0.02);
        all
    };
    under([0.0, 0.0]);
    let [of_large, of_small] = under([1.6, 1.0]);
    assert!(of_small > 0.02 && of_large > 0.2);
}

/// A scene whose lamp shows an image.
fn with_image(mut scene: Scene, size: [u32; 2], texels: Vec<[u8; 4]>) -> Scene {
    let geometry = scene.geometry_mut();
    geometry.textures.push(Texture { name: "screen".into(), size, texels });
    // The last four corners are those of the lamp.
    let count = geometry.mesh.positions.len();
    geometry.mesh.uvs = vec![Vec2::ZERO; count];
    geometry.mesh.uvs[count - 4..].copy_from_slice(&[Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
    let material = geometry.materials.last_mut().unwrap();
    material.emission_texture = Some(TextureUse::new(0));
    scene.add_lamps();
    scene
}

#[test]
fn the_light_of_a_screen_is_that_of_its_image() {
    let screen = level([0.0, 1.0, 0.0], [0.8, 0.5]);
    let plain = lit([(glowing(10.0), screen)]);
    let white = with_image(plain.clone(), [8, 4], vec![[255; 4]; 32]);
    assert_eq!(white.lights.list, plain.lights.list);
    assert_eq!(floor_shows(&white), floor_shows(&plain));
    // The left half alone shines.
    let halves: Vec<[u8; 4]> = (0..32).map(|index| if index % 8 < 4 { [255; 4] } else { [0; 4] }).collect();
    let half = with_image(plain.clone(), [8, 4], halves);
    let left = level([-0.4, 1.0, 0.0], [0.4, 0.5]);
    for x in [-0.6, 0.0, 0.6] {
        let shows = shown(half.clone(), [x, 0.5, 0.01], [x, 0.0, 0.0]);
        assert_near(shows, expected(0.5, 10.0, left, [x, 0.0, 0.0], DVec3::Y), 0.03);
    }
    let dark = with_image(plain, [8, 4], vec![[0; 4]; 32]);
    assert!(dark.lights.is_empty() && floor_shows(&dark) == 0.0);
}

#[test]
fn lamps_of_instances_shine_in_each_place() {
    let floor = lit([]);
    let shape = lit([(glowing(8.0), level([0.0, 0.0, 0.0], [0.2, 0.1]))]);
    let lamp = Mesh {
        positions: shape.geometry.mesh.positions[4..].to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        materials: vec![2; 2],
        ..Mesh::default()
    };
    let places = [[-1.0, 1.5, 0.0], [0.5, 2.0, 0.3]].map(|place| DMat4::from_translation(place.into()));
    let mut mesh = floor.geometry.mesh.clone();
    mesh.add_instances(&lamp, &places, "lamp").unwrap();
    let scene = |mesh: Mesh| {
        let geometry = Geometry { mesh, materials: shape.geometry.materials.clone(), ..Geometry::default() };
        let mut scene = Scene::new("instances", geometry);
        scene.add_lamps();
        scene
    };
    let flat = scene(mesh.flattened().unwrap());
    let placed = scene(mesh);
    // The upper one is above all else, and the lower one below it.
    assert!(placed.lights.len() == 3 && placed.lights.list == flat.lights.list, "{:?}", placed.lights.list);
    let all: f64 = places
        .map(|place| {
            let [x, y, z] = place.w_axis.truncate().to_array();
            expected(0.5, 8.0, level([x, y, z], [0.2, 0.1]), [0.0; 3], DVec3::Y)
        })
        .iter()
        .sum();
    assert_near(floor_shows(&placed), all, 0.01);
    assert_eq!(floor_shows(&placed), floor_shows(&flat));
}

#[test]
fn what_surrounds_the_scene_is_gathered() {
    // A ball of light around a floor: a diffuse surface shows k_d L.
    let draft = SceneDraft::new().painted(white(0.5)).floor(0.0, 1.0).painted(glowing(2.0));
    let mut scene = draft.smooth_ball(DVec3::ZERO, 10.0, [24, 48]).camera([0.0, 1.0, 0.01], [0.0; 3]).finish("dome");
    scene.add_lamps();
    scene.lights.ambient = None;
    assert!(scene.lights.is_empty() && !scene.complete(Up::Y).lights);
    let settings = Settings::default().with_size([1, 1]).with_aa(1);
    let frame = Renderer::new(Device::Cpu).unwrap().render(&scene, &settings).unwrap();
    assert_near(f64::from(frame.color()[0][0]), 1.0, 0.01);
}
