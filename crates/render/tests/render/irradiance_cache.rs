//! Gathered light where it is known: in closed rooms, on open floors, beside walls, under emitters.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::{DVec3, Vec3};
use lightmesh_render::{AmbientSource, Crop, Device, Frame, Quality, Renderer, Settings};
use lightmesh_scene::{Falloff, Light, LightKind, Lights, Material, Scene, Sky, SkyKind, SunPosition, Up};
use lightmesh_testkit::{BALL_LIGHT, SceneDraft, pile, thin_wall};

fn settings(size: [u32; 2]) -> Settings {
    Settings::default().with_ambient_light(AmbientSource::Mesh).with_size(size).with_aa(1)
}

fn render(scene: &Scene, settings: &Settings) -> Frame {
    Renderer::new(Device::Cpu).unwrap().render(scene, settings).unwrap()
}

/// In a sky alone.
fn under(sky: &Sky, draft: SceneDraft) -> Scene {
    let mut scene = draft.finish("under a sky");
    scene.lights = Lights::default();
    scene.lights.surround(sky.surroundings(Up::Y).unwrap());
    scene.lights.list.clear();
    scene
}

fn uniform(color: Vec3) -> Sky {
    Sky::new(SkyKind::Uniform { color })
}

/// A material that reflects this share of the light, and shines.
fn shining(kd: f32, emission: f32) -> Material {
    Material::matt(Vec3::splat(kd)).with_emission(Vec3::splat(emission))
}

#[test]
fn a_white_furnace_has_the_light_of_its_reflections() {
    let room = SceneDraft::new().painted(shining(0.5, 1.0)).cuboid([-2.0, -1.0, -1.5], [2.0, 1.0, 1.5]);
    let scene = room.camera([0.3, 0.2, 0.1], [2.0, -0.3, 0.6]).finish("furnace");
    for quality in Quality::ALL {
        let frame = render(&scene, &settings([48, 32]).with_quality(*quality));
        // 1 + 1/2 + 1/4 + 1/8: what is seen shines, and reflects what was reflected up to three times.
        for color in frame.color() {
            assert!(color.iter().all(|channel| (channel - 2.0).abs() < 2e-4), "{quality:?}: {color:?}");
        }
    }
}

#[test]
fn an_open_floor_receives_the_whole_sky() {
    let floor = || SceneDraft::new().painted(Material::matt(Vec3::splat(0.4))).floor(0.0, 50.0);
    let floor = || floor().camera([0.0, 3.0, 4.0], [0.0, 0.0, 0.0]);
    let even = under(&uniform(Vec3::new(0.5, 1.0, 2.0)), floor());
    for color in render(&even, &settings([24, 16])).color() {
        assert!((Vec3::from_array(*color) - Vec3::new(0.2, 0.4, 0.8)).abs().max_element() < 1e-4, "{color:?}");
    }

    let clear = under(&Sky::clear(SunPosition { elevation: 35.0, azimuth: 200.0 }), floor());
    let environment = clear.lights.environment.as_ref().unwrap();
    let [width, height] = environment.size();
    let mut sum = DVec3::ZERO;
    for (row, texels) in environment.texels().chunks_exact(width as usize).enumerate() {
        let angle = |row: usize| PI * row as f64 / f64::from(height);
        let solid = TAU / f64::from(width) * (angle(row).cos() - angle(row + 1).cos());
        let cosine = (0.5 * (angle(row) + angle(row + 1))).cos().max(0.0);
        sum += texels.iter().map(|texel| solid * cosine * Vec3::from_array(*texel).as_dvec3()).sum::<DVec3>();
    }
    let expected = 0.4 * sum / PI;
    let frame = render(&clear, &settings([24, 16]).with_quality(Quality::Final));
    let mean = frame.color().iter().map(|color| Vec3::from_array(*color).as_dvec3()).sum::<DVec3>();
    let mean = mean / frame.color().len() as f64;
    assert!(((mean - expected) / expected).abs().max_element() < 0.005, "{mean}, not {expected}");
    for color in frame.color() {
        let error = (Vec3::from_array(*color).as_dvec3() - expected) / expected;
        assert!(error.abs().max_element() < 0.02, "{color:?}, not {expected}");
    }
}

/// A white floor at a long black wall, in an even sky.
fn walled() -> Scene {
    // The wall is as good as infinite along z. Seen from above, pixels are a fiftieth wide.
    let draft = SceneDraft::new()
        .painted(Material::matt(Vec3::ONE))
        .floor(0.0, 200.0)
        .painted(Material::matt(Vec3::ZERO))
        .quad([[0.0, -1.0, -200.0], [0.0, 1.0, -200.0], [0.0, 1.0, 200.0], [0.0, -1.0, 200.0]])
        .orthographic([1.0, 30.0, 0.0], [1.0, 0.0, 0.0], 0.4);
    under(&uniform(Vec3::ONE), draft)
}

/// The worst error of an image of [`walled`], and their mean.
fn errors_at_the_wall(frame: &Frame) -> [f32; 2] {
    let layers = frame.layers().unwrap();
    let (mut worst, mut sum): (f32, f32) = (0.0, 0.0);
    for (color, position) in frame.color().iter().zip(&layers.position) {
        let distance = position[0];
        if distance < 0.02 {
            continue;
        }
        // The form factor of a long strip: (1 − cos of the elevation of its edge) / 2.
        let expected = 1.0 - 0.5 * (1.0 - distance / (distance * distance + 1.0).sqrt());
        worst = worst.max((color[0] - expected).abs());
        sum += color[0] - expected;
    }
    [worst, sum / frame.color().len() as f32]
}

#[test]
fn a_black_wall_hides_half_of_the_sky_at_its_foot() {
    let [worst, mean] = errors_at_the_wall(&render(&walled(), &settings([100, 20]).with_layers(true)));
    assert!(worst < 0.05 && mean.abs() < 0.01, "{worst}, {mean}");
}

#[test]
fn points_that_gather_for_themselves_know_the_answers_too() {
    let by_rays = |size| settings(size).with_ambient_light(AmbientSource::Rays).with_quality(Quality::Draft);
    let room = SceneDraft::new().painted(shining(0.5, 1.0)).cuboid([-2.0, -1.0, -1.5], [2.0, 1.0, 1.5]);
    let room = room.camera([0.3, 0.2, 0.1], [2.0, -0.3, 0.6]).finish("furnace");
    for color in render(&room, &by_rays([12, 8])).color() {
        assert!(color.iter().all(|channel| (channel - 2.0).abs() < 2e-4), "{color:?}");
    }
    // At the foot of a wall, all along an image row: nothing but noise is left.
    let frame = render(&walled(), &by_rays([100, 2]).with_quality(Quality::Good).with_layers(true));
    let [worst, mean] = errors_at_the_wall(&frame);
    assert!(worst < 0.012 && mean.abs() < 0.003, "{worst}, {mean}");
    assert!(frame.stats.counts.gather_rays > 1000 * frame.stats.counts.pixels);
    assert_eq!(frame.stats.settings.ambient_light, "rays");
}

#[test]
fn the_light_of_a_surface_point_does_not_depend_on_the_camera() {
    let scene = yard();
    let seen = |size: [u32; 2], crop: Crop| {
        let settings = settings(size).with_ambient_light(AmbientSource::Rays).with_quality(Quality::Draft);
        render(&scene, &settings.with_crop(crop)).color().to_vec()
    };
    // The pixel in the middle of an image is that of one with three times as many.
    let [few, many] = [seen([9, 9], Crop::new([4, 4], [1, 1])), seen([27, 27], Crop::new([13, 13], [1, 1]))];
    assert!((Vec3::from(few[0]) - Vec3::from(many[0])).abs().max_element() < 1e-5, "{few:?} {many:?}");
}

#[test]
fn no_light_leaks_into_a_dark_room() {
    for thickness in [0.02, 0.2] {
        let mut scene = thin_wall(thickness, BALL_LIGHT).finish("dark room");
        scene.lights.surround(uniform(Vec3::ONE).surroundings(Up::Y).unwrap());
        let frame = render(&scene, &settings([96, 64]));
        let lit = frame.color().iter().filter(|color| **color != [0.0; 3]).count();
        assert_eq!(lit, 0, "{thickness}");
    }
}

#[test]
fn rooms_of_thin_boards_that_abut_are_dark() {
    // Ways between surface points begin above these: of those inside a board not beyond it.
    let [w, h, d, t] = [2.1, 2.7, 3.3, 0.02];
    let boards = [
        ([-w - t, -t, -d - t], [w + t, 0.0, d + t]),
        ([-w - t, h, -d - t], [w + t, h + t, d + t]),
        ([-w - t, 0.0, -d - t], [-w, h, d + t]),
        ([w, 0.0, -d - t], [w + t, h, d + t]),
        ([-w, 0.0, -d - t], [w, h, -d]),
        ([-w, 0.0, d], [w, h, d + t]),
    ];
    let draft = SceneDraft::new().painted(Material::matt(Vec3::splat(0.7)));
    let draft = boards.into_iter().fold(draft, |draft, (min, max)| draft.cuboid(min, max));
    let scene = under(&uniform(Vec3::ONE), draft.camera([1.6, 1.5, 2.8], [-1.0, 1.2, -2.0]));
    let frame = render(&scene, &settings([160, 120]));
    let lit = frame.color().iter().filter(|color| **color != [0.0; 3]).count();
    assert_eq!(lit, 0);
}

#[test]
fn what_lies_on_a_floor_gets_nothing_from_below() {
    // A sheet, thinner than cells are wide: in it and below it is darkness.
    for thickness in [0.001, 0.004, 0.016] {
        let draft = SceneDraft::new().painted(Material::matt(Vec3::splat(0.5))).floor(0.0, 5.0);
        let sheet = draft.cuboid([-4.0, 0.0, -4.0], [4.0, thickness, 4.0]);
        let scene = under(&uniform(Vec3::ONE), sheet.camera([0.0, 2.0, 0.5], [0.0, 0.0, 0.0]));
        for color in render(&scene, &settings([96, 64])).color() {
            assert!((color[0] - 0.5).abs() < 1e-4, "{thickness}: {color:?}");
        }
    }
}

#[test]
fn a_floor_receives_what_an_emitter_above_it_gives() {
    // A square with a side of 2 at height 1, above the middle of a black floor with a white patch.
    let draft = SceneDraft::new()
        .painted(Material::matt(Vec3::ONE))
        .floor(0.0, 0.4)
        .painted(shining(0.0, 3.0))
        .quad([[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]])
        .orthographic([0.0, 0.5, 0.0], [0.0, 0.0, 0.0], 0.1);
    let mut scene = draft.finish("emitter");
    scene.lights = Lights::default();
    scene.lights.ambient = Some(Vec3::ZERO);
    let frame = render(&scene, &settings([16, 16]));
    let mean = frame.color().iter().map(|color| f64::from(color[0])).sum::<f64>() / 256.0;
    // Four times the form factor of a square above its corner.
    let quarter = 0.5f64.sqrt() * 0.5f64.sqrt().atan() * 2.0 / TAU;
    assert!((mean / (12.0 * quarter) - 1.0).abs() < 0.01, "{mean}, not {}", 12.0 * quarter);
}

#[test]
fn of_many_lights_some_stand_for_all() {
    let place = |[x, y, z]: [f32; 3]| LightKind::Sphere { position: Vec3::new(x, y, z), radius: 0.05 };
    let kinds = [[-1.5, 1.6, 0.5], [0.5, 0.4, 1.0], [1.6, 1.7, -1.0]].map(place);
    let [tangent, down] = [Vec3::new(0.6, -0.8, 0.0), Vec3::NEG_Y];
    let spot =
        LightKind::Spot { position: Vec3::new(0.0, 1.8, 0.0), direction: tangent, inner: 0.2, outer: 0.7, radius: 0.0 };
    let kinds = kinds.into_iter().chain([spot]);
    let few: Vec<Light> = kinds.map(|kind| Light::new(kind).with_falloff(Falloff::InverseSquare)).collect();
    let panel = LightKind::Disk { position: Vec3::new(-0.5, 1.9, -0.8), normal: down, radius: 0.2 };
    let few = [few, vec![Light::new(panel).with_surface(down).with_falloff(Falloff::InverseSquare)]].concat();
    let part = |light: &Light| light.clone().with_intensity(light.intensity / 16.0);
    let many: Vec<Light> = few.iter().flat_map(|light| std::iter::repeat_n(part(light), 16)).collect();
    let mean = |lights: &[Light]| {
        let room =
            SceneDraft::new().painted(Material::matt(Vec3::splat(0.5))).cuboid([-2.0, 0.0, -1.5], [2.0, 2.0, 1.5]);
        let mut scene = room.camera([1.8, 1.0, 1.2], [0.0, 0.8, 0.0]).finish("many lights");
        scene.lights.list = lights.to_vec();
        let frame = render(&scene, &settings([24, 16]).with_samples(1).with_layers(true));
        let rest = &frame.layers().expect("asked for").rest;
        rest.iter().map(|color| f64::from(color[1])).sum::<f64>() / rest.len() as f64
    };
    let each: f64 = few.iter().map(|light| mean(std::slice::from_ref(light))).sum();
    let together = mean(&many);
    assert!((together / each - 1.0).abs() < 0.01, "{together}, not {each}");
}

#[test]
fn light_behind_a_ledge_reaches_the_room() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../bench/light/scenes/cove.toml");
    let mut scene = Scene::open(&file).unwrap();
    scene.complete(Up::Y);
    let frame = render(&scene, &settings([160, 120]).with_samples(4));
    let lower = &frame.color()[160 * 60..];
    let mean = lower.iter().map(|color| f64::from(color[1])).sum::<f64>() / lower.len() as f64;
    // Mitsuba's paths of any length, 0.1830: most of it is reflected several times between the ledge, the wall and the ceiling.
    assert!((0.14..0.19).contains(&mean), "{mean}");
}

/// A pile of boxes in a clear sky, with mirrors and a lamp.
fn yard() -> Scene {
    let lamp = LightKind::Sphere { position: Vec3::new(-2.0, 2.0, 2.0), radius: 0.3 };
    let mut scene = pile(DVec3::ZERO, &[lamp]);
    scene.lights.surround(Sky::clear(SunPosition { elevation: 30.0, azimuth: 100.0 }).surroundings(Up::Y).unwrap());
    for material in &mut scene.geometry_mut().materials {
        material.ks = Vec3::splat(0.2);
    }
    scene
}

#[test]
fn neither_threads_nor_bands_nor_crops_change_a_bit() {
    let scene = yard();
    for aa in [1, 4] {
        let settings = settings([80, 64]).with_bounces(1).with_aa(aa).with_quality(Quality::Draft);
        let whole = render(&scene, &settings);
        let bits = |frame: &Frame| frame.color().iter().flatten().map(|channel| channel.to_bits()).collect::<Vec<_>>();
        let single = Renderer::with_threads(Device::Cpu, Some(1)).unwrap().render(&scene, &settings).unwrap();
        assert!(bits(&single) == bits(&whole), "threads");
        let bands = render(&scene, &settings.clone().with_partial(true));
        assert!(bits(&bands) == bits(&whole), "bands");
        let crop = Crop::new([30, 20], [24, 20]);
        let part = render(&scene, &settings.clone().with_crop(crop));
        assert!(bits(&part) == bits(&whole.cropped(crop).unwrap()), "crop");
    }
}

#[test]
fn light_that_is_gathered_is_less_than_the_whole_sky_gives() {
    let scene = yard();
    let constant = settings([80, 64]).with_ambient_light(AmbientSource::Constant);
    let (gathered, constant) = (render(&scene, &settings([80, 64])), render(&scene, &constant));
    let sum = |frame: &Frame| frame.color().iter().flatten().sum::<f32>();
    let ratio = sum(&gathered) / sum(&constant);
    // Less sky, but light that others reflect.
    assert!((0.7..1.2).contains(&ratio), "{ratio}");
    assert_eq!(gathered.stats.settings.ambient_light, "mesh");
    assert!(gathered.stats.counts.gather_rays > 10_000 && constant.stats.counts.gather_rays == 0);
}
