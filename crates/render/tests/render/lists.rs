//! Occluder lists give the bits of the reference, and ordinary rays to the same samples nearly so.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use lightmesh_render::{Acceleration, Crop, Frame, Lookup, Mode, Quality, Settings, ShadowTests};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::{Picture, SceneDraft, open_floor, pile, render, soup};

use crate::{LAMP, POINT, mode};

const SIZE: [u32; 2] = [70, 45];

/// A light of every kind, some of them crossing the horizon of surfaces or touching them.
pub(crate) fn kinds() -> Vec<LightKind> {
    let (position, slanted) = (Vec3::new(-1.5, 3.0, 1.0), Vec3::new(0.6, -0.8, 0.0));
    vec![
        LAMP,
        POINT,
        LightKind::Point { position, spread: 0.4 },
        LightKind::Directional { direction: slanted, angle: 0.0 },
        LightKind::Directional { direction: Vec3::new(-0.95, -0.3, 0.1).normalize(), angle: 0.5 },
        LightKind::Spot { position, direction: -position.normalize(), inner: 0.2, outer: 0.6, radius: 0.0 },
        LightKind::Spot { position: -position, direction: position.normalize(), inner: 0.2, outer: 1.2, radius: 0.3 },
        LightKind::Disk { position: Vec3::new(2.0, 1.0, -2.0), normal: slanted, radius: 1.1 },
        LightKind::Rectangle { position: Vec3::new(0.0, 2.5, 2.0), half_u: 0.3 * Vec3::X, half_v: 0.9 * Vec3::Z },
        LightKind::Sphere { position: Vec3::new(0.0, 0.2, 0.0), radius: 0.5 },
    ]
}

fn lists(samples: u32) -> Settings {
    Settings::default().with_aa(1).with_lookup(Lookup::Lists).with_size(SIZE).with_samples(samples).with_layers(true)
}

fn area(samples: u32) -> Settings {
    mode(Mode::Area, SIZE).with_samples(samples).with_layers(true)
}

/// The visibility of every light at every pixel.
pub(crate) fn visibilities(frame: &Frame) -> Vec<f32> {
    frame.layers().expect("asked for").visibility.concat()
}

fn same_bits(a: &Frame, b: &Frame) -> bool {
    let bits = |frame: &Frame| visibilities(frame).into_iter().map(f32::to_bits).collect::<Vec<_>>();
    bits(a) == bits(b) && a.color() == b.color()
}

#[test]
fn lists_are_the_reference_for_every_light_and_number_of_samples() {
    for offset in [DVec3::ZERO, DVec3::new(1e5, -2e4, 3e5)] {
        let scene = pile(offset, &kinds());
        for samples in [1, 2, 3, 5, 16, 64, 225, 256, 700] {
            let frame = render(&scene, &lists(samples));
            assert!(same_bits(&frame, &render(&scene, &area(samples))), "{samples} samples at {offset}");
            let seen = visibilities(&frame);
            let partial = seen.iter().filter(|&&share| share > 0.0 && share < 1.0).count();
            assert!(samples == 1 || partial > seen.len() / 100, "{samples} samples: {partial} of {}", seen.len());
        }
    }
}

#[test]
fn a_soft_spot_casts_the_shadows_of_a_ball() {
    let (position, radius) = (Vec3::new(1.0, 6.0, 2.0), 0.7);
    let direction = -position.normalize();
    let spot = |inner, outer| LightKind::Spot { position, direction, inner, outer, radius };
    let [whole, narrow] = [spot(1.5, 1.5), spot(0.1, 0.3)].map(|kind| pile(DVec3::ZERO, &[kind]));
    let ball = pile(DVec3::ZERO, &[LightKind::Sphere { position, radius }]);
    let mesh = mode(Mode::LightMesh, SIZE).with_lookup(Lookup::HalfBall).with_samples(16).with_layers(true);
    let adaptive = lists(16).with_lookup(Lookup::Adaptive);
    for settings in [lists(16), area(16), adaptive, mesh] {
        let [ball, whole, narrow] = [&ball, &whole, &narrow].map(|scene| render(scene, &settings));
        assert!(same_bits(&whole, &ball), "{settings:?}");
        assert_eq!(visibilities(&narrow), visibilities(&ball), "{settings:?}");
        let seen = visibilities(&ball);
        assert!(seen.iter().filter(|&&share| share > 0.0 && share < 1.0).count() > seen.len() / 100, "{settings:?}");
        let lit = |frame: &Frame| frame.color().iter().filter(|color| color[0] > 0.0).count();
        assert!(0 < lit(&narrow) && 2 * lit(&narrow) < lit(&ball), "{} of {}", lit(&narrow), lit(&ball));
    }
}

/// A coarse ball with the normals of a sphere, on a floor.
fn smooth_ball() -> Scene {
    let draft =
        SceneDraft::new().floor(-1.0, 5.0).smooth_ball(DVec3::ZERO, 1.0, [7, 9]).camera([1.0, 2.0, 4.0], [0.0; 3]);
    kinds().into_iter().fold(draft, SceneDraft::light).finish("smooth ball")
}

#[test]
fn lists_are_the_reference_on_smooth_surfaces() {
    let scene = smooth_ball();
    let facets = {
        let mut scene = scene.clone();
        scene.geometry_mut().mesh.normals.clear();
        scene
    };
    for samples in [1, 16, 64] {
        let frame = render(&scene, &lists(samples));
        assert!(same_bits(&frame, &render(&scene, &area(samples))), "{samples} samples");
        let (smooth, flat) = (visibilities(&frame), visibilities(&render(&facets, &lists(samples))));
        let lighter = smooth.iter().zip(&flat).filter(|(smooth, flat)| **smooth > **flat + 0.4).count();
        assert!(lighter > 10, "{samples} samples: {lighter} where facets alone hide a light");
    }
}

#[test]
fn every_structure_gives_the_same_bits() {
    let lamp = LightKind::Sphere { position: Vec3::new(0.5, 7.0, 1.0), radius: 2.0 };
    let mut scene = soup(3, 300);
    scene.lights.clear();
    scene.lights.push(lightmesh_scene::Light::new(lamp));
    let structures =
        [Acceleration::Bvh, Acceleration::Grid(None), Acceleration::Grid(Some([3, 5, 2])), Acceleration::BruteForce];
    let reference = render(&scene, &area(64).with_acceleration(Acceleration::BruteForce));
    for structure in structures {
        for settings in [lists(64), area(64)] {
            let frame = render(&scene, &settings.with_acceleration(structure.clone()));
            assert!(same_bits(&frame, &reference), "{structure:?}");
        }
    }
}

/// A ball of many small triangles on a floor, under a light as wide as itself.
fn fine_ball() -> Scene {
    const RINGS: u32 = 96;
    let corner = |k: u32| {
        let (latitude, longitude) =
            (PI * f64::from(k / RINGS) / f64::from(RINGS), TAU * f64::from(k % RINGS) / f64::from(RINGS));
        DVec3::new(latitude.sin() * longitude.cos(), 1.0 + latitude.cos(), latitude.sin() * longitude.sin())
    };
    let corners: Vec<DVec3> = (0..RINGS * (RINGS + 1)).map(corner).collect();
    let square = |k: u32| {
        let next = k / RINGS * RINGS + (k + 1) % RINGS;
        [[k, next, next + RINGS], [k, next + RINGS, k + RINGS]]
    };
    let triangles: Vec<[u32; 3]> = (0..RINGS * RINGS).flat_map(square).collect();
    SceneDraft::new()
        .floor(0.0, 5.0)
        .triangles(&corners, &triangles)
        .light(LightKind::Sphere { position: Vec3::new(1.0, 4.0, 0.5), radius: 1.5 })
        .camera([2.5, 3.1, 4.2], [0.0, 0.4, 0.0])
        .finish("fine ball")
}

#[test]
fn rays_that_replace_long_lists_give_the_same_bits() {
    let scene = fine_ball();
    // The lower half of the ball and its shadow.
    let part = Crop::new([20, 18], [32, 20]);
    for samples in [16, 64, 300] {
        let (lists, area) = (lists(samples).with_crop(part), area(samples).with_crop(part));
        assert!(same_bits(&render(&scene, &lists), &render(&scene, &area)), "{samples} samples");
    }
}

#[test]
fn ordinary_rays_to_the_same_samples_rarely_decide_differently() {
    // Ordinary rays to a wide sun count all alike.
    let kinds: Vec<LightKind> = kinds()
        .into_iter()
        .map(|kind| match kind {
            LightKind::Directional { direction, .. } => LightKind::Directional { direction, angle: 0.05 },
            kind => kind,
        })
        .collect();
    let mut scenes: Vec<(String, Scene)> = vec![("pile".to_owned(), pile(DVec3::ZERO, &kinds))];
    scenes
        .extend(["gazebo", "childpark"].map(|name| (name.to_owned(), Scene::open(format!("builtin:{name}")).unwrap())));
    for (name, scene) in scenes {
        let rows = visibilities(&render(&scene, &area(64)));
        let rays = visibilities(&render(&scene, &area(64).with_shadow_tests(ShadowTests::Rays)));
        let apart: f64 = rows.iter().zip(&rays).map(|(a, b)| f64::from((a - b).abs())).sum();
        // A few samples at most of a million.
        assert!(
            apart / rows.len() as f64 <= 1e-6 + 3.0 / (64 * rows.len()) as f64,
            "{name}: {apart} of {}",
            rows.len()
        );
    }
}

#[test]
fn a_light_above_an_open_floor_is_fully_seen_and_one_below_it_not_at_all() {
    let lamp = |y| LightKind::Sphere { position: Vec3::new(0.3, y, 0.1), radius: 0.4 };
    for (y, expected) in [(3.0, 1.0), (-3.0, 0.0)] {
        let scene = open_floor(lamp(y));
        let frame = render(&scene, &lists(64));
        assert!(Picture::new(&frame).visibilities(0).iter().all(|&share| share == expected), "{y}");
    }
}

#[test]
fn quality_is_a_number_of_samples() {
    let scene = pile(DVec3::ZERO, &[LAMP]);
    for (quality, samples) in [(Quality::Draft, 16), (Quality::Good, 64), (Quality::Final, 256)] {
        let frame =
            render(&scene, &Settings::default().with_aa(1).with_size(SIZE).with_layers(true).with_quality(quality));
        assert_eq!((frame.stats.settings.samples, frame.stats.settings.lookup), (samples, Some("lists")));
        assert!(same_bits(&frame, &render(&scene, &lists(samples))), "{quality:?}");
    }
}

#[test]
fn more_samples_come_nearer_to_the_truth() {
    let scene = pile(DVec3::ZERO, &[LAMP, kinds()[7].clone(), kinds()[6].clone()]);
    let truth = visibilities(&render(&scene, &lists(4096)));
    let error = |samples| {
        let seen = visibilities(&render(&scene, &lists(samples)));
        let sum: f64 = seen.iter().zip(&truth).map(|(a, b)| f64::from(a - b).powi(2)).sum();
        (sum / truth.len() as f64).sqrt()
    };
    let errors = [4, 16, 64, 256].map(error);
    assert!(errors.is_sorted_by(|few, many| *few > 2.0 * *many), "{errors:?}");
}
