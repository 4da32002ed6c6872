//! The same image, whatever the threads; a different one for another seed.

use glam::{DVec3, Vec3};
use lightmesh_render::{Device, Frame, Lookup, Mode, RenderError, Renderer, Settings};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::{MODES, Picture, pile};

use crate::{light_mesh, mode};

const SIZE: [u32; 2] = [80, 48];

fn scene() -> Scene {
    let sphere = LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.6 };
    let point = LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.3 };
    let mut scene = pile(DVec3::ZERO, &[sphere, point]);
    for material in &mut scene.geometry_mut().materials {
        material.ks = Vec3::splat(0.3);
    }
    scene
}

/// All modes, and adaptive shadow rays, whose pixels depend on their neighbours.
fn ways() -> Vec<Settings> {
    let adaptive = settings(Mode::LightMesh).with_lookup(Lookup::Adaptive);
    MODES.into_iter().map(settings).chain([adaptive]).collect()
}

fn settings(which: Mode) -> Settings {
    let settings = if which == Mode::LightMesh { light_mesh(SIZE, 0.15, 2.1) } else { mode(which, SIZE) };
    settings.with_aa(1).with_samples(7).with_bounces(1).with_layers(true)
}

fn render(threads: usize, settings: &Settings) -> Result<Frame, RenderError> {
    Renderer::with_threads(Device::Cpu, Some(threads)).unwrap().render(&scene(), settings)
}

#[test]
fn threads_do_not_change_a_bit() {
    for settings in ways() {
        let one = render(1, &settings).unwrap();
        for threads in [2, 3] {
            let many = render(threads, &settings).unwrap();
            assert!(Picture::new(&many).bits() == Picture::new(&one).bits(), "{settings:?} on {threads} threads");
        }
    }
}

#[test]
fn the_seed_chooses_the_pattern_of_sized_lights() {
    for which in [Mode::LightMesh, Mode::Area] {
        let seeded = |seed| render(2, &settings(which).with_seed(seed)).unwrap();
        let first = seeded(5);
        assert!(Picture::new(&seeded(5)).bits() == Picture::new(&first).bits(), "{which:?}: same seed, same image");
        assert!(Picture::new(&seeded(6)).bits() != Picture::new(&first).bits(), "{which:?}: another seed, another one");
    }
}

#[test]
fn hard_shadows_know_no_seed() {
    let seeded = |seed| render(2, &settings(Mode::RayTrace).with_seed(seed)).unwrap();
    assert!(Picture::new(&seeded(5)).bits() == Picture::new(&seeded(6)).bits());
}
