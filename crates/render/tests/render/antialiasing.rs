//! Several samples of a pixel: edges, floors to the horizon, what is shared, and what does not change.

use glam::{DVec3, Vec3};
use lightmesh_render::{Device, Filter, Frame, Lookup, Mode, Quality, RenderError, Renderer, Settings, Sharing};
use lightmesh_scene::{LightKind, Material, Scene};
use lightmesh_testkit::{Picture, SceneDraft, pile, render};

const SIZE: [u32; 2] = [48, 36];

/// Every technique.
const WAYS: [(Mode, Lookup); 5] = [
    (Mode::LightMesh, Lookup::Lists),
    (Mode::LightMesh, Lookup::Adaptive),
    (Mode::LightMesh, Lookup::HalfBall),
    (Mode::RayTrace, Lookup::Auto),
    (Mode::Area, Lookup::Auto),
];

fn settings((mode, lookup): (Mode, Lookup)) -> Settings {
    let settings = Settings::default().with_mode(mode).with_lookup(lookup).with_size(SIZE).with_step(0.2);
    settings.with_samples(16).with_bounces(1).with_layers(true)
}

/// Boxes that mirror a little, under a ball and a hard light.
fn boxes() -> Scene {
    let ball = LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.6 };
    let point = LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 };
    let mut scene = pile(DVec3::ZERO, &[ball, point]);
    scene.geometry_mut().materials[0].ks = Vec3::splat(0.3);
    scene
}

/// The mean colour.
fn mean(frame: &Frame) -> f64 {
    let sum: f64 = frame.color().iter().flatten().map(|&channel| f64::from(channel)).sum();
    sum / (3 * frame.color().len()) as f64
}

/// The root of the mean square of the differences between the colours of two images.
fn error(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.color().as_flattened().iter().zip(b.color().as_flattened());
    let sum: f64 = pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / (3 * a.color().len()) as f64).sqrt()
}

/// A black half in front of white, with a slanted edge, without shadows.
fn edge() -> Scene {
    let black = Material::default().with_ka([0.0; 3]).with_kd([0.0; 3]);
    SceneDraft::new()
        .painted(black)
        .triangles(
            &[
                DVec3::new(-9.0, -9.0, 0.0),
                DVec3::new(9.0, -9.0, 0.0),
                DVec3::new(9.0, 4.0, 0.0),
                DVec3::new(-9.0, -4.0, 0.0),
            ],
            &[[0, 1, 2], [0, 2, 3]],
        )
        .orthographic([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 6.0)
        .background(Vec3::ONE)
        .finish("edge")
}

#[test]
fn an_edge_is_a_ramp() {
    let scene = edge();
    for filter in [Filter::Box, Filter::Gauss, Filter::BlackmanHarris] {
        let with = |aa| render(&scene, &Settings::default().with_size(SIZE).with_aa(aa).with_filter(filter));
        let hard = with(1);
        assert!(hard.color().iter().all(|color| *color == [0.0; 3] || *color == [1.0; 3]));
        for aa in [4, 8, 16] {
            let soft = with(aa);
            let between = soft.color().iter().filter(|color| color[0] > 0.0 && color[0] < 1.0).count();
            assert!(between >= 30, "{filter:?}, {aa}: {between}");
            // The edge goes through the middle.
            assert!((mean(&soft) - 0.5).abs() < 0.005, "{filter:?}, {aa}: {}", mean(&soft));
            // Shares are multiples of a sample's.
            let shares = soft.color().iter().map(|color| color[0] * aa as f32);
            shares.for_each(|share| assert!((share - share.round()).abs() < 1e-4, "{share}"));
        }
        // More samples, less error.
        let reference = with(256);
        let errors = [1, 4, 16].map(|aa| error(&with(aa), &reference));
        assert!(errors[0] > 1.75 * errors[1] && errors[1] > 1.5 * errors[2], "{filter:?}: {errors:?}");
    }
}

/// A floor of black and white squares up to the horizon.
fn checkers() -> Scene {
    let mut draft = SceneDraft::new().ambient(1.0);
    for white in [false, true] {
        let shade = [f32::from(u8::from(white)); 3];
        draft = draft.painted(Material::default().with_ka(shade).with_kd([0.0; 3]));
        for x in -60..60_i32 {
            for z in -120..4_i32 {
                if (x + z).rem_euclid(2) == i32::from(white) {
                    let [x, z] = [f64::from(x), f64::from(z)];
                    draft = draft.quad([[x, 0.0, z], [x, 0.0, z + 1.0], [x + 1.0, 0.0, z + 1.0], [x + 1.0, 0.0, z]]);
                }
            }
        }
    }
    draft.camera([0.0, 1.5, 3.0], [0.0, 1.2, 0.0]).background(Vec3::splat(0.5)).finish("checkers")
}

#[test]
fn a_checker_floor_has_no_moire_and_keeps_its_energy() {
    let scene = checkers();
    let with = |aa| render(&scene, &Settings::default().with_size([96, 72]).with_aa(aa).with_filter(Filter::Box));
    let (reference, good, centers) = (with(256), with(8), with(1));
    assert!((mean(&good) / mean(&reference) - 1.0).abs() < 0.01, "{} {}", mean(&good), mean(&reference));
    // Moiré is an error that neighbours share: of means over 4x4 pixels. Without it they are those of independent samples.
    let coarse = |frame: &Frame| -> f64 {
        let difference =
            |x: usize, y: usize| f64::from(frame.color()[y * 96 + x][0] - reference.color()[y * 96 + x][0]);
        let blocks = (0..18 * 24).map(|block| {
            let (x, y) = (4 * (block % 24), 4 * (block / 24));
            let sum: f64 = (0..16).map(|i| difference(x + i % 4, y + i / 4)).sum();
            (sum / 16.0).powi(2)
        });
        (blocks.sum::<f64>() / 432.0).sqrt()
    };
    let fine = error(&good, &reference);
    assert!(coarse(&good) < 0.4 * fine, "{} of {fine}", coarse(&good));
    assert!(coarse(&good) < 0.25 * coarse(&centers), "{} of {}", coarse(&good), coarse(&centers));
}

#[test]
fn one_sample_is_the_centre() {
    let scene = boxes();
    for way in WAYS {
        let one = render(&scene, &settings(way).with_aa(1));
        let filtered = render(&scene, &settings(way).with_aa(1).with_filter(Filter::Box).with_sharing(Sharing::Never));
        assert!(Picture::new(&one).bits() == Picture::new(&filtered).bits(), "{way:?}");
        assert_eq!(one.stats.settings.aa, 1);
        assert_eq!(one.stats.counts.pixels, u64::from(SIZE[0] * SIZE[1]));
    }
    // The thesis' settings have one by default.
    for (way, aa) in WAYS.into_iter().zip([8, 8, 1, 1, 1]) {
        assert_eq!(render(&scene, &settings(way)).stats.settings.aa, aa, "{way:?}");
    }
    for (quality, aa) in [(Quality::Draft, 4), (Quality::Good, 8), (Quality::Final, 16)] {
        let frame = render(&scene, &settings(WAYS[0]).with_quality(quality));
        assert_eq!(frame.stats.settings.aa, aa);
    }
}

#[test]
fn sharing_changes_nothing_on_average() {
    let scene = boxes();
    for way in WAYS {
        let settings = settings(way).with_bounces(0);
        let reference = render(&scene, &settings.clone().with_aa(96));
        let apart = render(&scene, &settings.clone().with_aa(8).with_sharing(Sharing::Never));
        let shared = render(&scene, &settings.clone().with_aa(8));
        let one = render(&scene, &settings.with_aa(1));
        assert!((mean(&shared) / mean(&reference) - 1.0).abs() < 0.01, "{way:?}");
        assert!((mean(&apart) / mean(&reference) - 1.0).abs() < 0.01, "{way:?}");
        let errors = [&one, &shared, &apart].map(|frame| error(frame, &reference));
        // Part of a pixel is shaded at one of its samples, which is noise at the edge of a hard shadow.
        assert!(errors[1] < 0.6 * errors[0] && errors[1] < 1.5 * errors[2], "{way:?}: {errors:?}");
        let points = [&shared, &apart].map(|frame| frame.stats.counts.surface_points);
        assert!(points[0] < points[1] / 2, "{way:?}: {points:?}");
    }
}

#[test]
fn layers_are_means_and_the_nearest_sample() {
    let scene = boxes();
    for way in WAYS {
        let [shared, apart] = [Sharing::Unseen, Sharing::Never].map(|sharing| {
            let frame = render(&scene, &settings(way).with_aa(8).with_sharing(sharing));
            assert_eq!(Picture::new(&frame).fault(), None, "{way:?}");
            frame
        });
        let (a, b) = (shared.layers().unwrap(), apart.layers().unwrap());
        // What samples see does not depend on what is shaded.
        assert!(a.depth == b.depth && a.normal == b.normal && a.position == b.position, "{way:?}");
        for (a, b) in a.visibility.iter().zip(&b.visibility) {
            let difference: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
            assert!(difference / (a.len() as f32) < 0.02, "{way:?}: {difference}");
        }
        let centers = render(&scene, &settings(way).with_aa(1));
        let nearer = a.depth.iter().zip(&centers.layers().unwrap().depth).filter(|(a, b)| *a < *b).count();
        assert!(nearer > a.depth.len() / 2, "{way:?}: {nearer}");
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let scene = boxes();
    let on = |threads, settings: &Settings| {
        Renderer::with_threads(Device::Cpu, Some(threads)).unwrap().render(&scene, settings)
    };
    for way in WAYS {
        for sharing in [Sharing::Unseen, Sharing::Never] {
            let settings = settings(way).with_aa(8).with_sharing(sharing);
            let whole = on(2, &settings).unwrap();
            let one = on(1, &settings).unwrap();
            assert!(Picture::new(&one).bits() == Picture::new(&whole).bits(), "{way:?} {sharing:?} on one thread");
        }
    }
}

#[test]
fn impossible_numbers_are_refused() {
    for aa in [0, 65537] {
        let renderer = Renderer::with_threads(Device::Cpu, Some(1)).unwrap();
        let refused = renderer.render(&edge(), &Settings::default().with_aa(aa));
        assert!(matches!(refused, Err(RenderError::Setting { .. })), "{aa}");
    }
}
