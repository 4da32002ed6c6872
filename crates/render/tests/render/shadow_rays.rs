//! Shadow rays from surface points whose visibility follows from the geometry.

use std::f32::consts::PI;

use glam::{DVec3, Vec3};
use lightmesh_render::Mode;
use lightmesh_scene::LightKind;
use lightmesh_testkit::{BALL_LIGHT, Picture, SceneDraft, open_floor, pile, render, rms_difference};

use crate::{light_mesh, mode as settings};

const SIZE: [u32; 2] = [48, 48];

#[test]
fn a_small_area_light_casts_hard_shadows() {
    // A ball of 1e-4 differs from its centre only where its penumbra, some 1e-4 wide, meets a pixel's centre.
    let position = Vec3::new(2.0, 4.0, 1.0);
    let hard =
        render(&pile(DVec3::ZERO, &[LightKind::Point { position, spread: 0.0 }]), &settings(Mode::RayTrace, SIZE));
    let sphere = LightKind::Sphere { position, radius: 1e-4 };
    let soft = render(&pile(DVec3::ZERO, &[sphere]), &settings(Mode::Area, SIZE).with_samples(16));
    let (hard, soft) = (Picture::new(&hard).visibilities(0), Picture::new(&soft).visibilities(0));
    let differing = hard.iter().zip(&soft).filter(|(a, b)| a != b).count();
    assert!(differing * 500 < hard.len(), "{differing} of {}", hard.len());
    assert!(hard.contains(&0.0) && hard.contains(&1.0));
}

#[test]
fn spread_lights_are_strewn_in_area_mode_alone() {
    let light = |spread| [LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread }];
    let shares = |mode, spread| {
        let frame = render(&pile(DVec3::ZERO, &light(spread)), &settings(mode, SIZE));
        Picture::new(&frame).visibilities(0)
    };
    assert_eq!(shares(Mode::RayTrace, 0.5), shares(Mode::RayTrace, 0.0));
    let soft = shares(Mode::Area, 0.5);
    assert!(soft.iter().filter(|&&share| share > 0.0 && share < 1.0).count() > soft.len() / 50);
    assert!(shares(Mode::Area, 0.0).iter().all(|&share| share == 0.0 || share == 1.0));
}

#[test]
fn the_penumbra_of_a_post_is_as_wide_as_the_sun() {
    // A square post, 2 high, under a sun 45 degrees high; its far upper edge, at x = 0.5, ends the shadow. From the floor's point
    // (x, 0, z) that edge is a line across the sun's disk. In the strip that the camera sees, the post's sides are too far to matter.
    let (elevation, angle) = (45f32.to_radians(), 10f32.to_radians());
    let sun = LightKind::Directional { direction: Vec3::new(elevation.cos(), -elevation.sin(), 0.0), angle };
    let scene = SceneDraft::new()
        .floor(0.0, 8.0)
        .cuboid([-0.5, -0.1, -0.5], [0.5, 2.0, 0.5])
        .light(sun)
        .orthographic([2.5, 5.0, 0.0], [2.5, 0.0, 0.0], 0.25)
        .finish("post");
    let size @ [width, height] = [160, 20];
    let half_angle = 0.5 * angle;
    let [start, end] = [half_angle, -half_angle].map(|rim| 0.5 + 2.0 / (elevation + rim).tan());
    let line = |x: f32| (((2.0 / (x - 0.5)).atan() - elevation).tan() / half_angle.tan()).clamp(-1.0, 1.0);
    // The share of the disk, and that of the light of so wide a sun: of its places by their cosine on the floor and their solid angle.
    let share = |x: f32| (line(x).acos() - line(x) * (1.0 - line(x) * line(x)).sqrt()) / PI;
    let lit = |x: f32| {
        let (mut all, mut seen) = (0.0, 0.0);
        let places = (0..400).map(|place| (place as f32 + 0.5) / 200.0 - 1.0);
        for (aside, above) in places.clone().flat_map(|aside| places.clone().map(move |above| (aside, above))) {
            let square = aside * aside + above * above;
            if square < 1.0 {
                let tangent = half_angle.tan();
                let cosine = elevation.sin() + above * tangent * elevation.cos();
                let weight = cosine / (1.0 + tangent * tangent * square).powi(2);
                all += weight;
                seen += if above > line(x) { weight } else { 0.0 };
            }
        }
        seen / all
    };

    let frame = render(&scene, &settings(Mode::Area, size).with_samples(1024));
    let picture = Picture::new(&frame);
    let shares = picture.visibilities(0);
    assert_eq!(shares.len(), (width * height) as usize);
    let expected: Vec<f32> = picture.hits().map(|pixel| share(picture.position(pixel).x)).collect();
    // Rows are alike.
    let weighed: Vec<f32> = picture.hits().take(width as usize).map(|pixel| lit(picture.position(pixel).x)).collect();
    let worst = shares.iter().zip(weighed.iter().cycle()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst < 0.01, "{worst}");
    let pixel = 4.0 * 0.5 / width as f32;
    for (row, shares) in shares.chunks(width as usize).enumerate() {
        let partial = |share: &f32| *share > 0.0 && *share < 1.0;
        let first = shares.iter().position(partial).expect("a penumbra");
        let last = shares.iter().rposition(partial).expect("a penumbra");
        let [first, last] = [first, last].map(|column| picture.position(column).x);
        assert!(
            (first - start).abs() < 2.0 * pixel && (last - end).abs() < 2.0 * pixel,
            "row {row}: {first} to {last}"
        );
    }

    let error = |step| {
        let frame = render(&scene, &light_mesh(size, step, 2.1).with_samples(16));
        rms_difference(&Picture::new(&frame).visibilities(0), &expected)
    };
    let errors = [0.1, 0.05, 0.025].map(error);
    assert!(errors.is_sorted_by(|coarse, fine| coarse > fine) && errors[2] < 0.015, "{errors:?}");
}

#[test]
fn half_of_a_light_over_the_horizon_is_half_seen() {
    // A ball whose centre lies in the floor's plane: half of its samples are below.
    let ball = LightKind::Sphere { position: Vec3::new(0.0, 0.0, -30.0), radius: 1.0 };
    let scene = SceneDraft::new().floor(0.0, 4.0).light(ball).camera([0.0, 3.0, 1.0], [0.0; 3]).finish("sunset");
    let frame = render(&scene, &settings(Mode::Area, SIZE).with_samples(64));
    for share in Picture::new(&frame).visibilities(0) {
        // 64 stratified points in three dimensions: far closer to a half than 8 of them.
        assert!((share - 0.5).abs() < 0.125, "{share}");
    }
}

#[test]
fn every_ray_is_counted() {
    let point = LightKind::Point { position: Vec3::new(-2.0, 3.0, 0.7), spread: 0.0 };
    for (mode, light, rays) in [(Mode::RayTrace, point, 1), (Mode::Area, BALL_LIGHT, 9)] {
        let counts = render(&open_floor(light), &settings(mode, SIZE).with_samples(9)).stats.counts;
        assert_eq!(counts.shadow_rays, rays * counts.hits, "{mode:?}");
        assert_eq!((counts.light_points, counts.short_tests, counts.template), (0, 0, 0));
    }
}
