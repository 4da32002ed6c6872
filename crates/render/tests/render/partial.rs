//! What is left of an image whose render is stopped.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};
use lightmesh_render::{
    Acceleration, Device, Frame, Lookup, Mode, Observer, RenderError, Renderer, Settings, Unobserved,
};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::pile;

const SIZE: [u32; 2] = [20, 40];
const LAMP: LightKind = LightKind::Sphere { position: Vec3::new(1.0, 3.0, 1.0), radius: 0.4 };
const BACKGROUND: Vec3 = Vec3::new(0.125, 0.25, 0.5);

/// Requests cancellation from a given poll on.
struct Patience(AtomicU64);

impl Observer for Patience {
    fn cancelled(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
    }
}

fn scene() -> Scene {
    let mut scene = pile(DVec3::ZERO, &[LAMP]);
    scene.lights.background = Some(BACKGROUND);
    scene
}

fn ways() -> impl Iterator<Item = Settings> {
    let lookups = [Lookup::Lists, Lookup::Adaptive, Lookup::HalfBall];
    let meshes = lookups.map(|lookup| Settings::default().with_lookup(lookup).with_step(0.2).with_aa(2));
    let others = [Mode::Area, Mode::RayTrace].map(|mode| Settings::default().with_mode(mode));
    let all = meshes.into_iter().chain(others).map(|way| way.with_size(SIZE).with_samples(4).with_layers(true));
    all.flat_map(|way| [way.clone(), way.with_transparent(true)])
}

/// Renders until the observer has been asked `patience` times; `None` if nothing is finished then.
fn stopped(renderer: &Renderer, settings: &Settings, patience: u64) -> Option<Frame> {
    let scene = renderer.prepare(&scene(), settings, &Unobserved).unwrap();
    match renderer.render_prepared(&scene, settings, &Patience(AtomicU64::new(patience))) {
        Ok(frame) => Some(frame),
        Err(RenderError::Cancelled) => None,
        Err(error) => panic!("{error}"),
    }
}

/// Checks the finished rows against the whole image in the same bands, and that the others are empty.
fn check(frame: &Frame, whole: &Frame, settings: &Settings) {
    let places = (frame.finished_rows() * SIZE[0]) as usize;
    let empty = if settings.transparent { Vec3::ZERO } else { BACKGROUND };
    assert!(frame.color()[..places] == whole.color()[..places], "{settings:?}");
    assert!(frame.color()[places..].iter().all(|color| *color == empty.to_array()));
    if let Some((alpha, all)) = frame.image.alpha().zip(whole.image.alpha()) {
        assert!(alpha[..places] == all[..places] && alpha[places..].iter().all(|alpha| *alpha == 0.0));
    }
    let (layers, all) = (frame.layers().unwrap(), whole.layers().unwrap());
    assert!(layers.depth[..places] == all.depth[..places]);
    assert!(layers.visibility[0][..places] == all.visibility[0][..places]);
    assert!(layers.depth[places..].iter().all(|depth| *depth == f32::INFINITY));
    assert!(layers.visibility[0][places..].iter().all(|share| *share == 0.0));
    assert!(layers.rest[..places] == all.rest[..places] && layers.lights[0][..places] == all.lights[0][..places]);
    assert!(layers.rest[places..].iter().all(|color| *color == empty.to_array()));
    for (matte, all) in [(&layers.object, &all.object), (&layers.material, &all.material)] {
        assert!(matte.nearest[..places] == all.nearest[..places] && matte.of(1)[..places] == all.of(1)[..places]);
        assert!(
            matte.nearest[places..].iter().all(|id| *id == 0)
                && matte.of(1)[places..].iter().all(|share| *share == 0.0)
        );
    }
    assert_eq!(frame.stats.counts.pixels, places as u64);
    assert!(frame.stats.counts.hits <= whole.stats.counts.hits);
}

#[test]
fn the_finished_rows_are_those_of_the_whole_image_and_the_others_are_background() {
    let renderer = Renderer::with_threads(Device::Cpu, Some(2)).unwrap();
    for settings in ways() {
        let whole = stopped(&renderer, &settings, u64::MAX).unwrap();
        assert_eq!((whole.finished_rows(), whole.stats.finished_rows), (SIZE[1], None));
        let settings = settings.with_partial(true);
        let banded = stopped(&renderer, &settings, u64::MAX).unwrap();
        assert!(banded.finished_rows() == SIZE[1] && banded.color() == whole.color(), "{settings:?}");
        let mut rows: Vec<u32> = Vec::new();
        for patience in (0..).map(|turn| 7 * turn) {
            let Some(frame) = stopped(&renderer, &settings, patience) else { continue };
            check(&frame, &banded, &settings);
            rows.push(frame.finished_rows());
            if frame.stats.finished_rows.is_none() {
                break;
            }
        }
        assert!(rows.is_sorted() && rows.first() < rows.last(), "{settings:?}: {rows:?}");
        rows.dedup();
        assert!(rows.iter().all(|rows| rows % 8 == 0) && rows.len() > 2, "{settings:?}: {rows:?}");
    }
}

#[test]
fn without_the_setting_a_stopped_render_is_an_error() {
    let renderer = Renderer::with_threads(Device::Cpu, Some(2)).unwrap();
    let settings = ways().next().unwrap().with_acceleration(Acceleration::Bvh);
    assert!((0..40).all(|patience| stopped(&renderer, &settings, patience).is_none()));
}
