//! A mesh cache: the same images as without it, with fewer long tests.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};
use lightmesh_render::{
    AmbientSource, Device, Frame, MeshCache, Observer, PreparedScene, Quality, RenderError, Renderer, Settings, Step,
    Unobserved,
};
use lightmesh_scene::{Camera, LightKind, Lights, Scene, Sky, SunPosition, Up};
use lightmesh_testkit::{Picture, pile};

use crate::{LAMP, POINT, light_mesh, prepared, renderer};

const SIZE: [u32; 2] = [96, 96];

fn small(samples: u32) -> Settings {
    light_mesh([40, 40], 0.2, 2.1).with_samples(samples).with_bounces(1).with_layers(true)
}

/// The scene's first camera, moved to its right.
fn aside(scene: &PreparedScene, way: f32) -> Camera {
    let camera = scene.scene.cameras[0].clone();
    let (right, ..) = camera.basis();
    let position = camera.position + way * right;
    camera.with_position(position)
}

/// An image with the cache, which is bit-identical to one without. Returns the number of long tests performed and saved.
fn same(cache: &mut MeshCache, scene: &PreparedScene, settings: &Settings) -> (u64, u64) {
    let with = renderer().render_with(cache, scene, settings, &Unobserved).unwrap();
    let without = renderer().render_prepared(scene, settings, &Unobserved).unwrap();
    assert!(Picture::new(&with).bits() == Picture::new(&without).bits(), "the image differs");
    let tests = |frame: &Frame| (frame.stats.counts.long_tests, frame.stats.counts.long_tests_saved);
    let (made, saved) = tests(&with);
    assert_eq!(tests(&without), (made + saved, 0), "each test is made or saved");
    (made, saved)
}

#[test]
fn a_camera_that_moves_finds_light_points_that_are_known() {
    let scene = prepared(&Scene::open("builtin:childpark").unwrap());
    let way = 0.01 * scene.geometry.bounds.diagonal();
    let mut cache = MeshCache::new();
    let mut known = 0;
    for step in 0..4 {
        let camera = aside(&scene, way * step as f32);
        let settings = light_mesh(SIZE, 1.0, 2.1).with_camera(camera).with_bounces(1).with_layers(true);
        let (made, saved) = same(&mut cache, &scene, &settings);
        assert!(step == 0 || saved > made, "picture {step}: {made} made, {saved} saved");
        assert!(cache.len() > known || made == 0);
        known = cache.len();
    }
    assert!(cache.memory() > known / 8);
    cache.clear();
    assert!(cache.is_empty() && cache.memory() == 0);
}

/// The scene with what is above its floor moved, and prepared from what it was before.
fn elsewhere(before: &PreparedScene, by: Vec3) -> PreparedScene {
    let mut scene = before.scene.clone();
    let mesh = &mut scene.geometry_mut().mesh;
    let lifted = mesh.bounds().center();
    mesh.positions.iter_mut().filter(|place| place.distance(lifted) < 1.5).for_each(|place| *place += by);
    before.moved(&scene, Default::default(), &Unobserved).unwrap().expect("only places differ")
}

#[test]
fn light_points_that_cannot_have_noticed_a_motion_are_known() {
    for lights in [&[POINT][..], &[LAMP], &[POINT, LAMP]] {
        let mut scene = prepared(&pile(DVec3::ZERO, lights));
        let mut cache = MeshCache::new();
        let settings = small(4);
        let (all, _) = same(&mut cache, &scene, &settings);
        for step in 0..4 {
            let moved = elsewhere(&scene, Vec3::new(0.05, 0.02, 0.0));
            let (made, saved) = same(&mut cache, &moved, &settings);
            assert!(made > 0 && saved > all / 10, "step {step}: {made} made, {saved} saved of {all}");
            let fresh = prepared(&moved.scene);
            let [again, alone] = [&moved, &fresh].map(|scene| {
                renderer().render_prepared(scene, &settings, &Unobserved).unwrap().stats.counts.long_tests
            });
            assert_eq!(again, alone);
            scene = moved;
        }
    }
    // What differs in more is another scene.
    let scene = prepared(&pile(DVec3::ZERO, &[POINT]));
    let mut other = scene.scene.clone();
    other.geometry_mut().mesh.triangles.swap(0, 1);
    assert!(scene.moved(&other, Default::default(), &Unobserved).unwrap().is_none());
}

/// A yard under a sky, whose light is gathered.
#[test]
fn a_camera_that_moves_finds_light_that_was_gathered() {
    let mut scene = pile(DVec3::ZERO, &[LAMP]);
    scene.lights.surround(Sky::clear(SunPosition { elevation: 30.0, azimuth: 100.0 }).surroundings(Up::Y).unwrap());
    let scene = prepared(&scene);
    let renderer = Renderer::new(Device::Cpu).unwrap();
    let settings = Settings::default().with_ambient_light(AmbientSource::Mesh).with_size(SIZE).with_aa(1);
    let mut cache = MeshCache::new();
    // Rays with the cache and without; the images are the same.
    let mut rays = |scene: &PreparedScene, settings: &Settings| {
        let with = renderer.render_with(&mut cache, scene, settings, &Unobserved).unwrap();
        let without = renderer.render_prepared(scene, settings, &Unobserved).unwrap();
        assert!(with.color() == without.color(), "the image differs");
        [with, without].map(|frame| frame.stats.counts.gather_rays)
    };
    let [first, alone] = rays(&scene, &settings);
    assert_eq!(first, alone);
    for step in 1..6 {
        let [with, without] = rays(&scene, &settings.clone().with_camera(aside(&scene, 0.01 * step as f32)));
        assert!(4 * with < without, "step {step}: {with} of {without} rays");
    }
    // Other lights and other seeds are another matter.
    let mut lights = scene.scene.lights.clone();
    lights.iter_mut().for_each(|light| light.intensity *= 2.0);
    for (scene, settings) in [(scene.with_lights(lights), settings.clone()), (scene.clone(), settings.with_seed(5))] {
        let [with, without] = rays(&scene, &settings);
        assert_eq!(with, without);
    }
    assert!(cache.memory() > 100_000 && !cache.is_empty());
    cache.clear();
    assert!(cache.memory() == 0 && cache.is_empty());
}

/// A yard under a sky.
fn yard(elevation: f64) -> Scene {
    let mut scene = pile(DVec3::ZERO, &[LAMP]);
    scene.lights.surround(Sky::clear(SunPosition { elevation, azimuth: 100.0 }).surroundings(Up::Y).unwrap());
    scene
}

/// What another process would see: the same scene, prepared anew, and a file.
#[test]
fn gathered_light_of_a_file_is_used_where_all_that_it_depends_on_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let [path, second] = ["first.mesh", "second.mesh"].map(|name| folder.path().join(name));
    let settings = small(4).with_ambient_light(AmbientSource::Mesh).with_aa(1);
    let mut cache = MeshCache::new();
    let scene = prepared(&yard(30.0));
    let fresh = renderer().render_with(&mut cache, &scene, &settings, &Unobserved).unwrap();
    let saved = cache.save(&path, &scene).unwrap().unwrap();
    assert!(saved.values > 0 && saved.records > 0, "{saved:?}");

    // 1. The same: the same image, and the same file again.
    let scene = prepared(&yard(30.0));
    let mut cache = MeshCache::load(&path, &scene, Default::default()).unwrap();
    assert_eq!(cache.records_read(), saved.records);
    let again = renderer().render_with(&mut cache, &scene, &settings, &Unobserved).unwrap();
    assert!(Picture::new(&again).bits() == Picture::new(&fresh).bits(), "the image differs");
    let [before, rays] = [&fresh, &again].map(|frame| frame.stats.counts.gather_rays);
    assert!(2 * rays < before, "{rays} of {before}");
    assert!(cache.refused().is_none() && cache.records_read() == 0);
    assert_eq!(cache.save(&second, &scene).unwrap(), Some(saved));
    assert!(std::fs::read(&path).unwrap() == std::fs::read(&second).unwrap(), "what is known is the same");
    // From elsewhere it is added to.
    let elsewhere = settings.clone().with_camera(aside(&scene, 0.3));
    same(&mut cache, &scene, &elsewhere);
    assert!(cache.save(&second, &scene).unwrap().unwrap().records > saved.records);

    // 2. Not the same: it is dropped alone, and this is said once.
    let mut painted = yard(30.0);
    painted.geometry_mut().materials[0].kd *= 0.5;
    let mut bright = yard(30.0);
    bright.lights.list[0].intensity *= 2.0;
    for (changed, settings) in [
        (yard(31.0), settings.clone()),
        (painted, settings.clone()),
        (bright, settings.clone()),
        (yard(30.0), settings.clone().with_quality(Quality::Draft)),
        (yard(30.0), settings.clone().with_seed(5)),
    ] {
        let scene = prepared(&changed);
        let mut cache = MeshCache::load(&path, &scene, Default::default()).unwrap();
        let with = renderer().render_with(&mut cache, &scene, &settings, &Unobserved).unwrap();
        let without = renderer().render_prepared(&scene, &settings, &Unobserved).unwrap();
        assert!(Picture::new(&with).bits() == Picture::new(&without).bits(), "the image differs");
        assert_eq!(with.stats.counts.gather_rays, without.stats.counts.gather_rays, "nothing of it is used");
        assert!(settings.seed != 0 || with.stats.counts.long_tests_saved > 0, "light points are");
        let error = cache.refused().unwrap();
        assert!(error.fault.is_of_gathered_light() && error.fault.is_replaceable(), "{error}");
        assert!(cache.refused().is_none());
    }
}

#[test]
fn the_same_picture_again_tests_nothing() {
    let scene = prepared(&pile(DVec3::new(1e3, 0.0, -1e5), &[LAMP, POINT]));
    let mut cache = MeshCache::new();
    let (made, _) = same(&mut cache, &scene, &small(5));
    assert!(made > 0);
    assert_eq!(same(&mut cache, &scene, &small(5)).0, 0);
    // Another radius uses other light points of the same lattice.
    let (made, saved) = same(&mut cache, &scene, &small(5).with_radius(3.1));
    assert!(made > 0 && saved > 0);
}

#[test]
fn a_light_that_moves_or_changes_is_tested_anew_and_no_other() {
    let scene = prepared(&pile(DVec3::ZERO, &[POINT, LAMP]));
    let with = |kinds: [LightKind; 2]| {
        let mut lights: Lights = scene.scene.lights.clone();
        lights.iter_mut().zip(kinds).for_each(|(light, kind)| light.kind = kind);
        lights
    };
    let moved = LightKind::Point { position: Vec3::new(2.0, 4.1, 1.0), spread: 0.0 };
    let larger = LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.7 };
    let mut cache = MeshCache::new();
    let (made, saved) = same(&mut cache, &scene, &small(4));
    // One ray to the point light, four to the lamp.
    let points = (made + saved) / 5;
    let mut again = |lights: Lights| same(&mut cache, &scene.with_lights(lights), &small(4)).0;
    let one = again(with([moved.clone(), LAMP]));
    assert!(one > 0 && one <= points, "{one} of {points} light points");
    assert_eq!(again(with([moved.clone(), larger.clone()])), 4 * one);
    let mut brighter = with([moved.clone(), larger.clone()]);
    brighter[0].intensity *= 2.0;
    assert_eq!(again(brighter), 0, "how strong a light is does not matter");
    assert_eq!(again(with([larger, moved])), 5 * one, "lights have changed places");
    let mut fewer = scene.scene.lights.clone();
    fewer.list.truncate(1);
    assert_eq!(again(fewer), one, "one light, and not the one there was");
}

#[test]
fn what_decides_an_answer_makes_it_new() {
    let scene = prepared(&pile(DVec3::ZERO, &[POINT, LAMP]));
    let mut cache = MeshCache::new();
    // One ray to the point light, four to the lamp.
    let points = same(&mut cache, &scene, &small(4)).0 / 5;
    assert_eq!(same(&mut cache, &scene, &small(4).with_seed(1)).0, 4 * points, "the lamp alone");
    assert_eq!(same(&mut cache, &scene, &small(5)).0, 5 * points, "the lamp alone");
    let finer = small(5).with_step(Step::Fixed(0.15));
    assert!(same(&mut cache, &scene, &finer).0 > 6 * points, "another step has other light points");
    assert_eq!(same(&mut cache, &scene, &small(5)).0, 6 * points, "the first step's were forgotten");
    let mut other = pile(DVec3::ZERO, &[POINT, LAMP]);
    other.geometry_mut().mesh.positions[0] += Vec3::splat(0.5);
    assert!(same(&mut cache, &prepared(&other), &small(5)).0 > points, "another geometry");
}

#[test]
fn two_geometries_take_turns() {
    let scenes = [pile(DVec3::ZERO, &[POINT, LAMP]), pile(DVec3::splat(0.3), &[POINT, LAMP])].map(|it| prepared(&it));
    let mut cache = MeshCache::new();
    let made: Vec<u64> = (0..4).map(|turn| same(&mut cache, &scenes[turn % 2], &small(4)).0).collect();
    assert!(made[0] > 0 && made[1] > 0);
    assert_eq!(made[2..], [0, 0]);
    let known = cache.len();
    let [first, second] = scenes;
    drop(first);
    same(&mut cache, &second, &small(4));
    assert!(cache.len() < known, "geometry that is gone is forgotten");
}

/// Requests cancellation at a given poll.
struct Impatient {
    left: AtomicU64,
}

impl Observer for Impatient {
    fn cancelled(&self) -> bool {
        let left = |left: u64| Some(left.saturating_sub(1));
        self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, left) == Ok(1)
    }
}

#[test]
fn a_picture_that_was_stopped_leaves_nothing_wrong_behind() {
    let scene = prepared(&pile(DVec3::ZERO, &[POINT, LAMP]));
    let mut stopped = 0;
    for patience in (1..400).step_by(13) {
        let mut cache = MeshCache::new();
        let observer = Impatient { left: AtomicU64::new(patience) };
        match renderer().render_with(&mut cache, &scene, &small(4), &observer) {
            Err(RenderError::Cancelled) => stopped += 1,
            other => assert!(other.is_ok()),
        }
        same(&mut cache, &scene, &small(4));
    }
    assert!(stopped > 0);
}
