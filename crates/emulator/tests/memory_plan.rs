//! What happens to an image when a device's memory does not suffice, or launches must be short, and what a second image costs.
#![cfg(unix)]

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use glam::{DVec3, Vec3};
use lightmesh_emulator::{Emulator, Traffic};
use lightmesh_render::backend::Cuda;
use lightmesh_render::{
    Acceleration, Cache, Frame, Lookup, Mode, Observer, PreparedScene, RenderError, Setting, Settings, Stage, Step,
    Unobserved, render_on, render_on_with,
};
use lightmesh_scene::{Geometry, LightKind, Scene, Up};
use lightmesh_testkit::{Watch, pile, runs_all};

const ROWS: u32 = 40;

fn scene() -> Scene {
    let lamp = LightKind::Sphere { position: Vec3::new(2.0, 2.5, -1.0), radius: 0.3 };
    pile(DVec3::ZERO, &[LightKind::Point { position: Vec3::new(-1.5, 3.0, 1.0), spread: 0.0 }, lamp])
}

fn settings() -> Settings {
    Settings::default().with_mode(Mode::LightMesh).with_size([50, ROWS]).with_step(Step::Fixed(0.2)).with_layers(true)
}

/// Renders an image on the caller's device, and returns it with the traffic of its queue; the device's memory is free again
/// afterwards.
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
    let groups = layers.lights.iter().chain([&layers.rest]).flat_map(|plane| plane.as_flattened());
    let mattes = [&layers.object, &layers.material];
    let ranks = || mattes.iter().flat_map(|matte| &matte.ranks);
    let floats = layers.visibility.iter().flatten().chain(groups).chain(ranks().flat_map(|rank| &rank.share));
    let numbers = ranks().map(|rank| &rank.number).chain(mattes.map(|matte| &matte.nearest)).flatten();
    let shares = floats.map(|share| share.to_bits()).chain(numbers.copied()).collect();
    (frame.image.color().iter().map(|color| color.map(f32::to_bits)).collect(), shares)
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_picture_in_bands_is_the_same_picture() {
    same_in_bands(settings);
}

/// Requests cancellation when some bands have begun.
struct AfterBands {
    left: AtomicU32,
}

impl Observer for AfterBands {
    fn begin(&self, stage: Stage, _: u64) {
        if stage == Stage::Film {
            self.left.fetch_sub(1, Ordering::Relaxed);
        }
    }

    fn cancelled(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn what_is_finished_when_an_image_is_stopped_is_that_of_the_whole_image() {
    let settings = || settings().with_lookup(Lookup::Lists).with_samples(9).with_aa(4);
    let (whole, ..) = render(&scene(), Emulator::new(), &settings());
    let (colors, _) = bits(&whole.unwrap());
    let stopped = |bands: u32| {
        let emulator = Arc::new(Emulator::new());
        let cuda = Cuda::new(Arc::clone(&emulator));
        let prepared = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
        let observer = AfterBands { left: AtomicU32::new(bands) };
        let frame = render_on(&cuda, &prepared, &settings().with_partial(true), &observer);
        drop((cuda, prepared));
        assert_eq!(emulator.taken(), 0, "all memory is given back");
        frame
    };
    assert!(matches!(stopped(1), Err(RenderError::Cancelled)));
    for bands in 2..=4 {
        let frame = stopped(bands).unwrap();
        assert_eq!(frame.finished_rows(), 8 * (bands - 1));
        let places = (50 * frame.finished_rows()) as usize;
        let (found, _) = bits(&frame);
        assert!(found[..places] == colors[..places] && found[places..].iter().all(|color| *color == [0; 3]));
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn pixels_see_neighbors_in_other_bands() {
    same_in_bands(|| settings().with_lookup(Lookup::Adaptive).with_samples(9));
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn samples_are_counted_by_what_they_see_in_bands_too() {
    same_in_bands(|| settings().with_lookup(Lookup::Lists).with_samples(4).with_aa(5).with_bounces(1));
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn many_lights_need_no_more_memory_and_no_bands() {
    let settings = || settings().with_lookup(Lookup::Lists).with_samples(9).with_bounces(1);
    let lights = |count: usize| {
        let ball = |index: usize| {
            let (z, x) = (index as f32).sin_cos();
            LightKind::Sphere { position: Vec3::new(2.0 * x, 2.5, 2.0 * z), radius: 0.3 }
        };
        let mut scene = pile(DVec3::ZERO, &(0..count).map(ball).collect::<Vec<_>>());
        let material = scene.geometry.materials[0].clone().with_ks([0.4, 0.3, 0.2]);
        scene.geometry_mut().materials.fill(material);
        scene
    };
    // Layers are what the user asks for; without them memory does not grow but by the lights themselves.
    let peak = |count: usize| {
        let (frame, _, peak) = render(&lights(count), Emulator::new(), &settings().with_layers(false));
        assert_eq!(frame.unwrap().stats.settings.rows_per_band, ROWS);
        peak
    };
    let (few, many) = (peak(5), peak(33));
    assert!(many < few + 28 * 1024, "{few} bytes with 5 lights, {many} with 33");
    same_bands_of(&lights(6), settings);
}

fn same_in_bands(settings: impl Fn() -> Settings) {
    same_bands_of(&scene(), settings);
}

fn same_bands_of(scene: &Scene, settings: impl Fn() -> Settings) {
    let (whole, _, peak) = render(scene, Emulator::new(), &settings());
    let whole = whole.unwrap();
    assert_eq!(whole.stats.settings.rows_per_band, ROWS);
    let mut bands = Vec::new();
    for percent in [90, 70, 50, 40, 30] {
        let bytes = peak * percent / 100;
        let limited = settings().with_memory_limit(bytes);
        for (device, settings) in [(Emulator::with_memory(bytes), settings()), (Emulator::new(), limited)] {
            let (frame, _, used) = render(scene, device, &settings);
            let Ok(frame) = frame else { continue };
            assert!(bits(&frame) == bits(&whole), "{percent} %: another image");
            assert!(used <= bytes, "{used} bytes were used of {bytes}");
            bands.push(frame.stats.settings.rows_per_band);
        }
    }
    assert!(bands.iter().any(|&rows| rows < ROWS / 2), "small memory makes bands: {bands:?}");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn too_little_memory_is_an_error_that_names_the_buffer() {
    for bytes in [1, 1000, 5000] {
        let (frame, ..) = render(&scene(), Emulator::with_memory(bytes), &settings());
        let Err(error) = frame else { panic!("{bytes} bytes cannot suffice") };
        assert!(
            error.settings().contains(&Setting::Size) && error.to_string().contains("or a smaller image"),
            "{error}"
        );
        let RenderError::DeviceMemory { device, buffer, needed, free, .. } = error else { panic!("{error}") };
        assert_eq!(device, "emulated CUDA device");
        assert!(
            !buffer.is_empty() && needed > 0 && free.is_some_and(|free| free <= bytes),
            "{buffer} {needed} {free:?}"
        );
    }
}

/// The first, the last and every third of some allocations; all of them with `LIGHTMESH_TESTS=all`.
fn chosen(allocations: u64) -> impl Iterator<Item = u64> {
    let step = if runs_all() { 1 } else { 3 };
    (1..=allocations).filter(move |number| (number - 1) % step == 0 || *number == allocations)
}

/// Whichever allocation fails: the image is rendered in smaller bands, or the error names the buffer.
#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn any_allocation_may_fail() {
    let scene = scene();
    let (whole, traffic, _) = render(&scene, Emulator::new(), &settings());
    let whole = whole.unwrap();
    let (mut recovered, mut tried) = (0, 0);
    for number in chosen(traffic.allocations) {
        tried += 1;
        let device = Emulator::new();
        device.fail_allocation(number);
        match render(&scene, device, &settings()).0 {
            Ok(frame) => {
                assert!(bits(&frame) == bits(&whole), "allocation {number}: another image");
                assert!(frame.stats.settings.rows_per_band < ROWS, "allocation {number}");
                // The host counts rays, the device hits: neither counts what was begun again.
                let counted = |frame: &Frame| [frame.stats.counts.rays, frame.stats.counts.hits];
                assert_eq!(counted(&frame), counted(&whole), "allocation {number}: counted twice");
                recovered += 1;
            }
            Err(RenderError::DeviceMemory { buffer, .. }) => assert!(!buffer.is_empty()),
            Err(error) => panic!("allocation {number}: {error}"),
        }
    }
    assert!(2 * recovered > tried, "{recovered} of {tried} failures were made good");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_second_picture_of_a_scene_uploads_next_to_nothing() {
    let scene = Scene::open("builtin:gazebo").unwrap();
    let prepared = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let emulator = Arc::new(Emulator::new());
    let cuda = Cuda::new(Arc::clone(&emulator));
    let settings = settings().with_step(Step::Fixed(2.0));
    let written = || {
        render_on(&cuda, &prepared, &settings, &Unobserved).unwrap();
        emulator.take_traffic().written
    };
    let (first, second) = (written(), written());
    assert!(first > 40_000, "{first} bytes: the scene");
    assert!(second < 1000, "{second} bytes: the camera goes with the launches");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn geometry_is_uploaded_once_and_freed_when_it_is_gone() {
    let emulator = Arc::new(Emulator::new());
    let cuda = Cuda::new(Arc::clone(&emulator));
    let prepared = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let settings = Settings::default().with_mode(Mode::RayTrace).with_size([9, 9]);
    let picture = |prepared: &PreparedScene| {
        let frame = render_on(&cuda, prepared, &settings, &Unobserved).unwrap();
        (frame.stats.seconds.upload, emulator.taken())
    };
    let (first, taken) = picture(&prepared);
    assert!(first > 0.0);
    let mut lights = prepared.scene.lights.clone();
    lights.list[0].intensity *= 2.0;
    assert_eq!(picture(&prepared.with_lights(lights)), (0.0, taken), "nothing is uploaded again, nothing more is held");
    drop(prepared);
    let empty = PreparedScene::new(&Scene::new("empty", Geometry::default()), &Acceleration::Bvh, &Unobserved).unwrap();
    let (_, rest) = picture(&empty);
    assert!(rest < taken, "{rest} of {taken} bytes are held by nobody");
}

/// Renders two images with a cache, the second with another camera and an injected failure before it. Returns the second, its
/// allocations, and whether the cache was dropped in between.
fn render_twice(scene: &PreparedScene, settings: &Settings, accident: impl Fn(&Emulator)) -> (Frame, Traffic, bool) {
    let emulator = Arc::new(Emulator::new());
    let cuda = Cuda::new(Arc::clone(&emulator));
    let mut kept = Cache::default();
    let mut first = settings.clone().with_camera(scene.scene.default_camera(Up::Y));
    first.memory_limit = None;
    render_on_with(&cuda, &mut kept, scene, &first, &Unobserved).unwrap();
    assert!(!kept.is_empty() && kept.memory() > 0);
    emulator.take_traffic();
    accident(&emulator);
    let notes = Notes::default();
    let frame = render_on_with(&cuda, &mut kept, scene, settings, &notes).unwrap();
    let traffic = emulator.take_traffic();
    let forgotten = notes.heard("dropped");
    drop((cuda, kept));
    assert_eq!(emulator.taken(), 0, "all memory is given back");
    (frame, traffic, forgotten)
}

#[derive(Default)]
struct Notes(Mutex<String>);

impl Notes {
    fn heard(&self, word: &str) -> bool {
        self.0.lock().unwrap().contains(word)
    }
}

impl Observer for Notes {
    fn note(&self, text: &str) {
        *self.0.lock().unwrap() += text;
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_cache_gives_way_where_an_allocation_fails() {
    let settings = settings();
    let scene = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let whole = render_on(&Cuda::new(Arc::new(Emulator::new())), &scene, &settings, &Unobserved).unwrap();
    let (frame, traffic, forgotten) = render_twice(&scene, &settings, |_| ());
    assert!(bits(&frame) == bits(&whole) && !forgotten && frame.stats.counts.long_tests_saved > 0);
    for number in (1..=traffic.allocations).step_by(4) {
        let (frame, _, forgotten) = render_twice(&scene, &settings, |device| device.fail_allocation(number));
        assert!(bits(&frame) == bits(&whole), "allocation {number}: another image");
        assert!(forgotten, "allocation {number}");
        assert_eq!(frame.stats.settings.rows_per_band, ROWS, "allocation {number}: the image keeps its bands");
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_cache_gives_way_to_a_limit() {
    let scene = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let whole = render_on(&Cuda::new(Arc::new(Emulator::new())), &scene, &settings(), &Unobserved).unwrap();
    let peak = whole.stats.memory.device_peak_bytes;
    for percent in [100, 80, 60] {
        let limited = settings().with_memory_limit(peak * percent / 100);
        let (frame, _, _) = render_twice(&scene, &limited, |_| ());
        assert!(bits(&frame) == bits(&whole), "{percent} %: another image");
    }
}

/// A film of which everything cannot be kept: the bricks that were used last are.
#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_cache_under_a_limit_keeps_what_was_used_last() {
    let scene = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let film = |limit: Option<u64>| {
        let cuda = Cuda::new(Arc::new(Emulator::new()));
        let mut kept = Cache::default();
        let (mut saved, mut most, mut peak, notes) = (0, 0, 0, Notes::default());
        let base = scene.scene.default_camera(Up::Y);
        let (right, _, forward) = base.basis();
        for frame in 0..12 {
            // From so far that half of a cache holds what an image needs.
            let position = base.position - forward + 0.15 * frame as f32 * right;
            let camera = base.clone().with_position(position);
            let mut settings = settings().with_size([50, 40]).with_step(Step::Fixed(0.04)).with_camera(camera);
            settings.memory_limit = limit;
            let with = render_on_with(&cuda, &mut kept, &scene, &settings, &notes).unwrap();
            settings.memory_limit = None;
            let fresh = render_on(&Cuda::new(Arc::new(Emulator::new())), &scene, &settings, &Unobserved).unwrap();
            assert!(bits(&with) == bits(&fresh), "{limit:?}, frame {frame}: another image");
            saved += with.stats.counts.long_tests_saved;
            most = most.max(kept.memory());
            peak = with.stats.memory.device_peak_bytes;
        }
        assert!(!notes.heard("dropped"), "{limit:?}");
        (saved, most, peak, kept.len())
    };
    let all = film(None);
    let limit = 5 * all.1 / 2;
    let some = film(Some(limit));
    assert!(some.2 <= limit && some.1 <= limit / 4, "{limit}: {all:?} {some:?}");
    assert!(some.0 > all.0 / 4 && some.3 < all.3, "{limit}: {all:?} {some:?}");
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn a_cache_grows_and_forgets_nothing() {
    let scene = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let cuda = Cuda::new(Arc::new(Emulator::new()));
    let mut kept = Cache::default();
    let mut picture = |size| {
        let settings = settings().with_size(size).with_step(Step::Fixed(0.04));
        let frame = render_on_with(&cuda, &mut kept, &scene, &settings, &Unobserved).unwrap();
        let fresh = render_on(&cuda, &scene, &settings, &Unobserved).unwrap();
        assert!(bits(&frame) == bits(&fresh), "{size:?}");
        (frame.stats.counts.long_tests, kept.memory(), kept.len())
    };
    let small = picture([9, 9]);
    let large = picture([50, 40]);
    assert!(large.1 >= 2 * small.1 && large.2 > small.2, "{small:?} {large:?}");
    let again = picture([9, 9]);
    assert_eq!((again.0, again.1, again.2), (0, large.1, large.2));
}

/// Of the first image, most kernels have one launch; of the second, as many as there are blocks or bundles.
#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn short_launches_make_the_same_picture() {
    let prepared = PreparedScene::new(&scene(), &Acceleration::Bvh, &Unobserved).unwrap();
    let ways =
        [(Mode::LightMesh, Lookup::Lists), (Mode::LightMesh, Lookup::Adaptive), (Mode::LightMesh, Lookup::HalfBall)];
    for (mode, lookup) in ways.into_iter().chain([(Mode::Area, Lookup::Auto), (Mode::RayTrace, Lookup::Auto)]) {
        let settings = settings().with_mode(mode).with_lookup(lookup).with_samples(4).with_aa(4).with_bounces(1);
        let emulator = Arc::new(Emulator::new().slow());
        let cuda = Cuda::new(Arc::clone(&emulator));
        let [first, second] = [(); 2].map(|()| {
            let watch = Watch::default();
            let frame = render_on(&cuda, &prepared, &settings, &watch).unwrap();
            drop(watch.finished());
            (bits(&frame), emulator.take_traffic().launches)
        });
        assert!(first.0 == second.0, "{mode:?}, {lookup:?}: another image");
        let more = second.1.iter().filter(|(kernel, launches)| **launches > 2 * first.1[*kernel]).count();
        assert!(more > 3, "{mode:?}, {lookup:?}: {first:?}, {second:?}", first = first.1, second = second.1);
    }
}

#[test]
#[cfg_attr(no_cxx, ignore = "no C++ compiler worked; install one, or set CXX")]
fn every_stage_ends_at_its_total_in_bands_too() {
    let scene = scene();
    let prepared = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let (_, _, peak) = render(&scene, Emulator::new(), &settings());
    for (mode, memory) in [(Mode::LightMesh, u64::MAX), (Mode::LightMesh, peak / 2), (Mode::Area, u64::MAX)] {
        let cuda = Cuda::new(Arc::new(Emulator::with_memory(memory)));
        let watch = Watch::default();
        let settings = settings().with_mode(mode).with_bounces(1).with_samples(3);
        render_on(&cuda, &prepared, &settings, &watch).unwrap();
        let watched: Vec<_> = watch.finished().iter().map(|watched| watched.stage).collect();
        let of_the_mesh = [Stage::Cells, Stage::ShortTests, Stage::Collect, Stage::LongTests, Stage::Interpolate];
        for stage in of_the_mesh {
            assert_eq!(watched.contains(&stage), mode == Mode::LightMesh, "{mode:?}: {stage:?} in {watched:?}");
        }
        assert_eq!(watched.contains(&Stage::AreaShadows), mode == Mode::Area, "{mode:?}: {watched:?}");
        for stage in [Stage::CameraRays, Stage::PrimaryRays, Stage::Shade, Stage::Film, Stage::Download] {
            assert!(watched.contains(&stage), "{mode:?}: no {stage:?} in {watched:?}");
        }
    }
}
