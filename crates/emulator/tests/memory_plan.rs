//! What becomes of a picture when a device's memory does not suffice, and what a second picture costs.
#![cfg(unix)]

use std::sync::Arc;

use glam::{DVec3, Vec3};
use lightmesh_emulator::{Emulator, Traffic};
use lightmesh_render::backend::Cuda;
use lightmesh_render::{Acceleration, Frame, Mode, PreparedScene, RenderError, Settings, Step, Unobserved, render_on};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::pile;

const ROWS: u32 = 40;

fn scene() -> Scene {
    let lamp = LightKind::Sphere { position: Vec3::new(2.0, 2.5, -1.0), radius: 0.3 };
    pile(DVec3::ZERO, &[LightKind::Point { position: Vec3::new(-1.5, 3.0, 1.0), spread: 0.0 }, lamp])
}

fn settings() -> Settings {
    Settings {
        mode: Mode::LightMesh,
        size: [50, ROWS],
        step: Some(Step::Fixed(0.2)),
        layers: true,
        ..Settings::default()
    }
}

/// A picture on a device of the caller's own, with what went through its queue; the device's memory is free again afterwards.
fn render(scene: &Scene, emulator: Emulator, settings: &Settings) -> (Result<Frame, RenderError>, Traffic, u64) {
    let emulator = Arc::new(emulator);
    let cuda = Cuda::new(Arc::clone(&emulator));
    let prepared = PreparedScene::new(scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let frame = render_on(&cuda, &prepared, settings, &Unobserved);
    drop((cuda, prepared));
    assert_eq!(emulator.taken(), 0, "all memory is given back");
    let peak = frame.as_ref().map_or(0, |frame| frame.stats.memory.device_peak_bytes);
    (frame, emulator.take_traffic(), peak)
}

fn bits(frame: &Frame) -> (Vec<[u32; 3]>, Vec<u32>) {
    let layers = frame.image.layers().expect("asked for");
    let shares = layers.visibility.iter().flatten().map(|share| share.to_bits()).collect();
    (frame.image.color().iter().map(|color| color.map(f32::to_bits)).collect(), shares)
}

#[test]
fn a_picture_in_bands_is_the_same_picture() {
    let scene = scene();
    let (whole, _, peak) = render(&scene, Emulator::new(), &settings());
    let whole = whole.unwrap();
    assert_eq!(whole.stats.settings.rows_per_band, ROWS);
    let mut bands = Vec::new();
    for percent in [90, 70, 50, 40, 30] {
        let bytes = peak * percent / 100;
        let limited = Settings { memory_limit: Some(bytes), ..settings() };
        for (device, settings) in [(Emulator::with_memory(bytes), settings()), (Emulator::new(), limited)] {
            let (frame, _, used) = render(&scene, device, &settings);
            let Ok(frame) = frame else { continue };
            assert!(bits(&frame) == bits(&whole), "{percent} %: another picture");
            assert!(used <= bytes, "{used} bytes were used of {bytes}");
            bands.push(frame.stats.settings.rows_per_band);
        }
    }
    assert!(bands.iter().any(|&rows| rows < ROWS / 2), "small memory makes bands: {bands:?}");
}

#[test]
fn too_little_memory_is_an_error_that_names_the_buffer() {
    for bytes in [1, 1000, 5000] {
        let (frame, ..) = render(&scene(), Emulator::with_memory(bytes), &settings());
        let Err(RenderError::DeviceMemory { device, buffer, needed, free }) = frame.map(|_| ()) else {
            panic!("{bytes} bytes cannot suffice")
        };
        assert_eq!(device, "emulated CUDA device");
        assert!(
            !buffer.is_empty() && needed > 0 && free.is_some_and(|free| free <= bytes),
            "{buffer} {needed} {free:?}"
        );
    }
}

/// Whatever allocation fails: the picture is made in smaller bands, or the error says which buffer it was.
#[test]
fn any_allocation_may_fail() {
    let scene = scene();
    let (whole, traffic, _) = render(&scene, Emulator::new(), &settings());
    let whole = whole.unwrap();
    let mut recovered = 0;
    for number in 1..=traffic.allocations {
        let device = Emulator::new();
        device.fail_allocation(number);
        match render(&scene, device, &settings()).0 {
            Ok(frame) => {
                assert!(bits(&frame) == bits(&whole), "allocation {number}: another picture");
                assert!(frame.stats.settings.rows_per_band < ROWS, "allocation {number}");
                recovered += 1;
            }
            Err(RenderError::DeviceMemory { buffer, .. }) => assert!(!buffer.is_empty()),
            Err(error) => panic!("allocation {number}: {error}"),
        }
    }
    assert!(2 * recovered > traffic.allocations, "{recovered} of {} failures were made good", traffic.allocations);
}

#[test]
fn a_second_picture_of_a_scene_uploads_next_to_nothing() {
    let scene = Scene::open("builtin:gazebo").unwrap();
    let prepared = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let emulator = Arc::new(Emulator::new());
    let cuda = Cuda::new(Arc::clone(&emulator));
    let settings = Settings { step: Some(Step::Fixed(2.0)), ..settings() };
    let written = || {
        render_on(&cuda, &prepared, &settings, &Unobserved).unwrap();
        emulator.take_traffic().written
    };
    let (first, second) = (written(), written());
    assert!(first > 40_000, "{first} bytes: the scene");
    assert!(second < 1000, "{second} bytes: the camera goes with the launches");
}
