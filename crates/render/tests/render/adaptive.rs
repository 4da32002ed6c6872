//! Adaptive shadow rays: all samples where neighbours disagree, and elsewhere one ray.

use glam::{DVec3, Vec3};
use lightmesh_render::{Acceleration, Frame, Lookup, Mode, Quality, Settings, ShadowTests, Unobserved};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::{Picture, open_floor, pile, render, runs_all};

use crate::lists::{kinds, visibilities};
use crate::{LAMP, mode, prepared, renderer};

const SIZE: [u32; 2] = [80, 50];

fn adaptive(samples: u32) -> Settings {
    Settings::default().with_aa(1).with_lookup(Lookup::Adaptive).with_size(SIZE).with_samples(samples).with_layers(true)
}

fn rays(samples: u32) -> Settings {
    mode(Mode::Area, SIZE).with_shadow_tests(ShadowTests::Rays).with_samples(samples).with_layers(true)
}

/// Whether the 5 x 5 neighbours of a pixel that see something of the scene are all fully lit by a light, or all dark.
fn agrees(frame: &Frame, light: usize, [x, y]: [u32; 2]) -> bool {
    let layers = frame.layers().unwrap();
    let rows = y.saturating_sub(2)..SIZE[1].min(y + 3);
    let pixels = rows.flat_map(|y| (x.saturating_sub(2)..SIZE[0].min(x + 3)).map(move |x| (y * SIZE[0] + x) as usize));
    let mut shares =
        pixels.filter(|&pixel| layers.depth[pixel].is_finite()).map(|pixel| layers.visibility[light][pixel]);
    let first = shares.next().unwrap_or(0.0);
    (first == 0.0 || first == 1.0) && shares.all(|share| share == first)
}

#[test]
fn a_share_is_that_of_all_samples_or_one_answer() {
    let samples = [1, 2, 16, 64, 300];
    let park = if runs_all() { &samples[..] } else { &samples[2..3] };
    for (scene, samples) in
        [(pile(DVec3::ZERO, &kinds()), &samples[..]), (Scene::open("builtin:childpark").unwrap(), park)]
    {
        for &samples in samples {
            let (found, all) = (render(&scene, &adaptive(samples)), render(&scene, &rays(samples)));
            let (mut missed, mut partial) = (0, 0);
            for (&share, &expected) in visibilities(&found).iter().zip(&visibilities(&all)) {
                assert!(share.to_bits() == expected.to_bits() || share == 0.0 || share == 1.0, "{share}, {expected}");
                partial += usize::from(expected > 0.0 && expected < 1.0);
                missed += usize::from(share != expected);
            }
            assert!(8 * missed < partial || samples < 2, "{samples} samples: {missed} of {partial} are missed");
            // Of a single sample, some are lit by chance beyond the reach of the first rays.
            assert!(30 * missed < SIZE[0] as usize * SIZE[1] as usize * scene.lights.len(), "{samples}: {missed}");
        }
    }
}

#[test]
fn fewer_rays_are_cast_where_neighbors_agree() {
    let scene = pile(DVec3::ZERO, &[LAMP]);
    let frame = render(&scene, &adaptive(64));
    let surfaces = frame.stats.counts.hits;
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let agree = pixels.filter(|&pixel| agrees(&frame, 0, pixel)).count() as u64;
    let misses = u64::from(SIZE[0] * SIZE[1]) - surfaces;
    let cast = frame.stats.counts.shadow_rays;
    assert!(agree > surfaces / 3 + misses, "{agree} of {surfaces} surface points, {misses} pixels without");
    // Those whose neighbours agree cast no more than one.
    assert!(cast <= surfaces + 64 * (surfaces + misses - agree), "{cast} rays, {agree} agree");
    assert!(cast > 2 * surfaces, "{cast} rays");
}

#[test]
fn a_lit_floor_costs_a_ray_a_pixel_and_one_turned_away_none() {
    let lamp = |y| LightKind::Sphere { position: Vec3::new(0.3, y, 0.1), radius: 0.4 };
    for (y, share, rays) in [(3.0, 1.0, 1), (-3.0, 0.0, 0)] {
        let frame = render(&open_floor(lamp(y)), &adaptive(64));
        assert!(Picture::new(&frame).visibilities(0).iter().all(|&found| found == share), "{y}");
        let counts = &frame.stats.counts;
        assert_eq!(counts.shadow_rays, rays * counts.hits, "{y}");
    }
}

#[test]
fn a_light_that_straddles_the_horizon_is_sampled() {
    let lamp = LightKind::Sphere { position: Vec3::new(0.3, 0.1, 0.1), radius: 0.4 };
    let (found, all) = [adaptive(64), rays(64)].map(|settings| render(&open_floor(lamp.clone()), &settings)).into();
    assert_eq!(visibilities(&found), visibilities(&all));
    let partial = visibilities(&all).iter().filter(|&&share| share > 0.0 && share < 1.0).count();
    assert!(partial as u64 > all.stats.counts.hits / 2, "{partial}");
}

#[test]
fn lights_without_a_size_have_hard_shadows() {
    let hard = kinds().into_iter().filter(|kind| match kind {
        LightKind::Point { spread, .. } => *spread == 0.0,
        LightKind::Directional { angle, .. } => *angle == 0.0,
        LightKind::Spot { radius, .. } => *radius == 0.0,
        _ => false,
    });
    let scene = pile(DVec3::ZERO, &hard.collect::<Vec<_>>());
    assert_eq!(scene.lights.len(), 3);
    let (found, expected) =
        (render(&scene, &adaptive(64)), render(&scene, &mode(Mode::RayTrace, SIZE).with_layers(true)));
    assert_eq!(visibilities(&found), visibilities(&expected));
    assert_eq!(found.stats.counts.shadow_rays, expected.stats.counts.shadow_rays);
}

#[test]
fn every_structure_gives_the_same_bits() {
    let scene = pile(DVec3::new(1e4, -2e3, 3e4), &kinds());
    let reference = render(&scene, &adaptive(16).with_acceleration(Acceleration::BruteForce));
    for structure in [Acceleration::Bvh, Acceleration::Grid(None)] {
        let frame = render(&scene, &adaptive(16).with_acceleration(structure.clone()));
        assert_eq!(visibilities(&frame), visibilities(&reference), "{structure:?}");
    }
}

/// They have no neighbours.
#[test]
fn given_points_and_mirrors_have_all_samples() {
    let mut scene = pile(DVec3::ZERO, &[LAMP]);
    for material in &mut scene.geometry_mut().materials {
        (material.kd, material.ks) = (Vec3::ZERO, Vec3::ONE);
    }
    // What the camera sees has no colour of its own but highlights.
    let mirrored = |settings: Settings| render(&scene, &settings.with_bounces(1)).stats.counts.shadow_rays;
    let in_mirrors =
        |settings: Settings| mirrored(settings.clone()) - render(&scene, &settings).stats.counts.shadow_rays;
    assert_eq!(in_mirrors(adaptive(16)), in_mirrors(rays(16)));

    let scene = prepared(&scene);
    let points: Vec<Vec3> =
        (0..2000).map(|i| Vec3::new((i % 50) as f32 / 15.0 - 1.7, 0.0, (i / 50) as f32 / 12.0 - 1.7)).collect();
    let normals = vec![Vec3::Y; points.len()];
    let [found, all] = [adaptive(9), rays(9)].map(|settings| {
        renderer().visibility(&scene, &points, &normals, &settings, &Unobserved).unwrap().into_shares()
    });
    assert_eq!(found, all);
    assert!(found.iter().any(|&share| share > 0.0 && share < 1.0));
}

#[test]
fn quality_is_a_number_of_samples() {
    let scene = pile(DVec3::ZERO, &[LAMP]);
    let mut settings = adaptive(1).with_quality(Quality::Draft);
    settings.samples = None;
    let frame = render(&scene, &settings);
    let used = &frame.stats.settings;
    assert_eq!((used.samples, used.lookup, used.quality), (16, Some("adaptive"), Some("draft")));
    assert_eq!(visibilities(&frame), visibilities(&render(&scene, &adaptive(16))));
}
