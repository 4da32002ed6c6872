//! Emissive surfaces as lights.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use lightmesh_render::{AmbientSource, Crop, Device, Frame, Lookup, Mode, Quality, Renderer, Settings};
use lightmesh_scene::{Light, Material, Scene};
use lightmesh_testkit::SceneDraft;

const RADIANCE: f32 = 5.0;

fn render(scene: &Scene, settings: &Settings) -> Frame {
    Renderer::new(Device::Cpu).unwrap().render(scene, settings).unwrap()
}

fn settings() -> Settings {
    Settings::default().with_size([32, 24]).with_aa(1).with_layers(true)
}

/// A lamp 1.2 by 0.8 at height 2 above a floor that reflects a half; the camera sees the floor alone.
fn lit_floor(lamp: impl Fn(SceneDraft) -> SceneDraft) -> Scene {
    let draft = SceneDraft::new().painted(Material::matt(Vec3::splat(0.5))).floor(0.0, 20.0);
    let draft = lamp(draft.painted(Material::matt(Vec3::ZERO).with_emission(Vec3::splat(RADIANCE))));
    let mut scene = draft.camera([0.0, 1.5, 5.0], [0.0, 0.0, 0.5]).finish("lamp");
    scene.add_lamps();
    scene
}

fn panel(draft: SceneDraft) -> SceneDraft {
    draft.quad([[-0.6, 2.0, -0.4], [0.6, 2.0, -0.4], [0.6, 2.0, 0.4], [-0.6, 2.0, 0.4]])
}

/// What a point of the floor shows: ∫ k_d / π L cos cos' / d² over the lamp.
fn expected(point: DVec3) -> f64 {
    let n = 64;
    let place = |index: usize, half: f64| half * ((2 * index + 1) as f64 / n as f64 - 1.0);
    let seen = |(i, j): (usize, usize)| {
        let way = DVec3::new(place(i, 0.6), 2.0, place(j, 0.4)) - point;
        (way.y / way.length()).powi(2) / way.length_squared()
    };
    let sum: f64 = (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(seen).sum();
    0.5 / PI * f64::from(RADIANCE) * 1.2 * 0.8 * sum / (n * n) as f64
}

#[test]
fn a_lamp_lights_a_floor_as_its_integral_says() {
    let scene = lit_floor(panel);
    assert_eq!(scene.lights.len(), 1);
    let techniques =
        [(Mode::LightMesh, Lookup::Lists), (Mode::LightMesh, Lookup::Adaptive), (Mode::Area, Lookup::Auto)];
    for (mode, lookup) in techniques {
        for ambient in [AmbientSource::Constant, AmbientSource::Mesh] {
            let settings = settings().with_mode(mode).with_lookup(lookup).with_ambient_light(ambient);
            let mut scene = scene.clone();
            scene.lights.ambient = Some(Vec3::ZERO);
            let frame = render(&scene, &settings);
            let layers = frame.layers().unwrap();
            let mut seen = 0;
            for ((color, position), depth) in frame.color().iter().zip(&layers.position).zip(&layers.depth) {
                if !depth.is_finite() || position[1].abs() > 1e-3 || position[2] < -6.0 {
                    continue;
                }
                let expected = expected(Vec3::from_array(*position).as_dvec3());
                assert!(
                    (f64::from(color[0]) / expected - 1.0).abs() < 0.02,
                    "{mode:?} {ambient:?}, {position:?}: {color:?}, not {expected}"
                );
                seen += 1;
            }
            assert!(seen > 100, "{seen}");
        }
    }
}

#[test]
fn a_lamp_of_triangles_is_the_light_of_its_shape() {
    let scene = lit_floor(panel);
    let mut other = scene.clone();
    let half = [Vec3::new(0.6, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.4)];
    let light = Light::rectangle(Vec3::new(0.0, 1.99, 0.0), half[0], half[1]).unwrap();
    let light = light.with_surface(Vec3::NEG_Y).with_intensity([RADIANCE * 1.2 * 0.8; 3]);
    other.lights.list = vec![light.with_falloff(scene.lights[0].falloff)];
    let [a, b] = [&scene, &other].map(|scene| render(scene, &settings()));
    for (a, b) in a.color().iter().zip(b.color()) {
        assert!(
            (Vec3::from_array(*a) - Vec3::from_array(*b)).abs().max_element() <= 0.02 * b[0].max(0.05),
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn a_lamp_shines_where_it_is_not_hidden() {
    // A ball of light beside a screen: behind it, nothing.
    let lamp = |draft: SceneDraft| {
        let draft = draft.smooth_ball(DVec3::new(0.0, 0.6, 0.0), 0.3, [12, 24]);
        let screen = [[1.0, 0.0, -8.0], [1.0, 1.0, -8.0], [1.0, 1.0, 8.0], [1.0, 0.0, 8.0]];
        draft.painted(Material::matt(Vec3::ZERO)).quad(screen)
    };
    let mut scene = lit_floor(lamp);
    scene.lights.ambient = Some(Vec3::ZERO);
    assert_eq!(scene.lights.len(), 1);
    let techniques =
        [(Mode::LightMesh, Lookup::Lists), (Mode::LightMesh, Lookup::Adaptive), (Mode::Area, Lookup::Auto)];
    for (mode, lookup) in techniques {
        is_lit_by_its_ball(&render(&scene, &settings().with_mode(mode).with_lookup(lookup)));
    }
}

fn is_lit_by_its_ball(frame: &Frame) {
    let layers = frame.layers().unwrap();
    let (mut lit, mut dark) = (0, 0);
    for ((color, position), depth) in frame.color().iter().zip(&layers.position).zip(&layers.depth) {
        if !depth.is_finite() || position[1].abs() > 1e-3 {
            continue;
        }
        if position[0] > 1.01 && position[2] > -7.0 {
            assert_eq!(color, &[0.0; 3], "{position:?}");
            dark += 1;
        } else if position[0] < 0.9 && (0.5..3.0).contains(&position[2]) {
            // That of a sphere with this radiance: L r² sin / d²; triangles inside of it have a smaller area.
            let to = Vec3::new(0.0, 0.6, 0.0) - Vec3::from_array(*position);
            let expected = 0.5 * RADIANCE * 0.09 * to.y / to.length().powi(3);
            assert!((color[0] / expected - 0.98).abs() < 0.02, "{position:?}: {color:?}, not {expected}");
            lit += 1;
        }
    }
    assert!(lit > 20 && dark > 20, "{lit} {dark}");
}

/// What a floor and a wall get from all lights, and what they gather. The lamp itself is above the image.
fn direct_and_gathered(scene: &Scene) -> [Vec<Vec3>; 2] {
    let settings = settings().with_ambient_light(AmbientSource::Mesh).with_size([64, 48]);
    let settings = settings.with_crop(Crop::new([0, 12], [64, 36])).with_quality(Quality::Final);
    let frame = render(scene, &settings);
    let layers = frame.layers().unwrap();
    let light = |pixel: usize| layers.lights.iter().map(|light| Vec3::from(light[pixel])).sum();
    [(0..layers.rest.len()).map(light).collect(), layers.rest.iter().map(|&color| color.into()).collect()]
}

fn mean(colors: &[Vec3]) -> Vec3 {
    colors.iter().sum::<Vec3>() / colors.len() as f32
}

#[test]
fn a_light_a_lamp_and_what_shines_by_itself_give_the_same() {
    // A wall of another colour stands on the floor. The lamp is large, so that rays find it.
    let walled = |draft: SceneDraft| {
        let large = [[-3.0, 6.0, -2.0], [3.0, 6.0, -2.0], [3.0, 6.0, 2.0], [-3.0, 6.0, 2.0]];
        let red = Material::matt([0.7, 0.3, 0.1]);
        let wall = [[-20.0, -1.0, -2.0], [20.0, -1.0, -2.0], [20.0, 2.0, -2.0], [-20.0, 2.0, -2.0]];
        draft.quad(large).painted(red).quad(wall)
    };
    let lamp = lit_floor(walled);
    assert_eq!(lamp.lights.len(), 1);
    // Without the surface, and without the light.
    let mut light = lamp.clone();
    let shines: Vec<bool> = lamp.geometry.materials.iter().map(|material| material.emission != Vec3::ZERO).collect();
    let mesh = &mut light.geometry_mut().mesh;
    let is_kept = |index: &usize| !shines[mesh.materials[*index] as usize];
    let kept: Vec<usize> = (0..mesh.triangles.len()).filter(is_kept).collect();
    mesh.triangles = kept.iter().map(|&index| mesh.triangles[index]).collect();
    mesh.materials = kept.iter().map(|&index| mesh.materials[index]).collect();
    let mut surface = lamp.clone();
    surface.lights.list.clear();
    surface.geometry_mut().materials.iter_mut().for_each(|material| material.lamp = false);

    let [[of_light, others], [of_lamp, around], [none, all]] = [&light, &lamp, &surface].map(direct_and_gathered);
    assert!(of_light == of_lamp && mean(&of_lamp).min_element() > 0.02, "{} and {}", mean(&of_light), mean(&of_lamp));
    assert!(none.iter().all(|color| *color == Vec3::ZERO));
    let near = |a: Vec3, b: Vec3, error: f32| ((a - b).abs() / b).max_element() < error;
    assert!(near(mean(&around), mean(&others), 0.002), "{} and {}", mean(&around), mean(&others));
    let both: Vec<Vec3> = of_lamp.iter().zip(&around).map(|(a, b)| *a + *b).collect();
    assert!(near(mean(&all), mean(&both), 0.02), "{} and {}", mean(&all), mean(&both));
    let far = all.iter().zip(&both).filter(|(a, b)| **b != Vec3::ZERO && !near(**a, **b, 0.1)).count();
    assert!(far < all.len() / 8, "{far}");
}
