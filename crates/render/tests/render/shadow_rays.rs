//! Shadow rays from surface points whose visibility follows from the geometry.

use glam::{DVec3, Vec3};
use lightmesh_render::Mode;
use lightmesh_scene::LightKind;
use lightmesh_testkit::{BALL_LIGHT, Picture, SceneDraft, open_floor, pile, render};

use crate::mode as settings;

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
