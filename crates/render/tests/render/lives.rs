//! What outlives an image: geometry is prepared once, whatever lights, cameras and settings change.

use std::sync::Arc;

use glam::Vec3;
use lightmesh_render::{Acceleration, Mode, PreparedScene, RenderError, Settings, Unobserved};
use lightmesh_scene::{Light, Scene};
use lightmesh_testkit::half_plane;

use crate::renderer;

fn settings() -> Settings {
    Settings::default().with_size([32, 32]).with_mode(Mode::RayTrace)
}

/// The scene with another lamp.
fn moved(scene: &Scene, offset: Vec3) -> Scene {
    let mut moved = scene.clone();
    let position = scene.lights[0].position().unwrap_or_default() + offset;
    moved.lights.list = vec![Light::point(position)];
    moved
}

#[test]
fn a_moved_light_builds_nothing() {
    let (renderer, scene) = (renderer(), half_plane());
    let first = renderer.render(&scene, &settings()).unwrap();
    let second = renderer.render(&moved(&scene, Vec3::X), &settings()).unwrap();
    assert!(first.stats.seconds.build > 0.0);
    assert_eq!(second.stats.seconds.build, 0.0);
    assert_ne!(first.image.color(), second.image.color());
    let fresh = self::renderer().render(&moved(&scene, Vec3::X), &settings()).unwrap();
    assert_eq!(fresh.image.color(), second.image.color());
}

#[test]
fn changed_geometry_is_prepared_again() {
    let (renderer, mut scene) = (renderer(), half_plane());
    let prepare = |scene: &Scene| renderer.prepare(scene, &settings(), &Unobserved).unwrap().geometry;
    let before = prepare(&scene);
    assert!(Arc::ptr_eq(&before, &prepare(&scene.clone())));
    scene.geometry_mut().mesh.positions[0] += Vec3::X;
    assert!(!Arc::ptr_eq(&before, &prepare(&scene)));
}

#[test]
fn a_prepared_scene_crosses_threads_and_outlives_its_scene() {
    let scene = half_plane();
    let prepared = PreparedScene::new(&scene, &Acceleration::Auto, &Unobserved).unwrap();
    let lights = scene.lights.clone();
    drop(scene);
    let pictures = [0.0, 0.5].map(|shift: f32| {
        let mut lights = lights.clone();
        lights.list[0].intensity += Vec3::splat(shift);
        let prepared = prepared.with_lights(lights);
        std::thread::spawn(move || renderer().render_prepared(&prepared, &settings(), &Unobserved).unwrap())
    });
    let [dark, bright] = pictures.map(|picture| picture.join().unwrap().image.color().iter().flatten().sum::<f32>());
    assert!(bright > 1.2 * dark, "{dark} {bright}");
}

#[test]
fn another_structure_than_prepared_is_refused() {
    let prepared = PreparedScene::new(&half_plane(), &Acceleration::Grid(None), &Unobserved).unwrap();
    let render = |acceleration| {
        renderer().render_prepared(&prepared, &settings().with_acceleration(acceleration), &Unobserved).map(|_| ())
    };
    assert!(render(Acceleration::Grid(None)).is_ok());
    for other in [Acceleration::Auto, Acceleration::Bvh, Acceleration::Grid(Some([2, 2, 2])), Acceleration::BruteForce]
    {
        assert!(matches!(render(other), Err(RenderError::Setting { .. })));
    }
}
