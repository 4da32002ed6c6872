//! Known answers of facets.

use std::f64::consts::PI;

use glam::Vec3;
use lightmesh_render::internals::shading::{Coefficients, Lobe, Sight};
use lightmesh_scene::Facets;

/// Coefficients with a base colour and a layer.
fn coefficients(base: Vec3, layer: Vec3) -> Coefficients {
    let none = Vec3::ZERO;
    Coefficients {
        ka: none,
        kd: base,
        ks: layer,
        emission: none,
        transmittance: none,
        opacity: 1.0,
        roughness: 0.0,
        metallic: 0.0,
        all: none,
        mirrored: none,
    }
}

fn sight(cosine: f32) -> Sight {
    Sight { cosine, spread: 0.0, followed: false, mirrored: false }
}

/// ∫ f cos over the hemisphere by brute force, for an eye at this cosine.
fn reflected(facets: &Facets, base: Vec3, layer: Vec3, cosine: f32) -> Vec3 {
    let lobe = Lobe::new(facets, &mut coefficients(base, layer), &sight(cosine));
    let eye = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    // Even steps of the angles, so that lobes at the horizon are not missed.
    let steps = 300;
    let step = std::f32::consts::FRAC_PI_2 / steps as f32;
    let mut sum = glam::DVec3::ZERO;
    for i in 0..steps {
        let (sin, cos) = ((i as f32 + 0.5) * step).sin_cos();
        for j in 0..2 * steps {
            let (y, x) = ((j as f32 + 0.5) * step).sin_cos();
            let direction = Vec3::new(sin * x, sin * y, cos);
            sum += (cos * sin * lobe.toward(Vec3::Z, eye, direction, 0.0)).as_dvec3();
        }
    }
    // Half of the circle stands for all of it.
    (2.0 * f64::from(step * step) / PI * sum).as_vec3()
}

#[test]
fn the_table_is_the_integral_of_the_formula() {
    let gold = Vec3::new(1.0, 0.77, 0.34);
    for (roughness, cosine) in [(0.35, 0.9), (0.5, 0.3), (0.8, 0.6), (1.0, 0.15), (0.63, 1.0)] {
        for (metallic, base) in [(1.0, gold), (0.0, gold), (1.0, Vec3::ONE)] {
            let facets = Facets::new(roughness).with_metallic(metallic);
            let layer = Vec3::splat(0.04);
            let mut known = coefficients(base, layer);
            Lobe::new(&facets, &mut known, &sight(cosine));
            let found = reflected(&facets, base, layer, cosine);
            let expected = known.all - known.kd;
            assert!((found - expected).abs().max_element() < 0.015, "{facets:?} {cosine}: {found}, not {expected}");
        }
    }
}

#[test]
fn nothing_is_lost_in_a_white_furnace() {
    for step in 0..=40 {
        let roughness = step as f32 / 40.0;
        for cosine in [0.0, 0.01, 0.2, 0.5, 0.99, 1.0] {
            for metallic in [0.0, 0.4, 1.0] {
                let mut white = coefficients(Vec3::ONE, Vec3::splat(0.04));
                let facets = Facets::new(roughness).with_metallic(metallic);
                Lobe::new(&facets, &mut white, &sight(cosine));
                assert!((white.all - Vec3::ONE).abs().max_element() < 1e-5, "{facets:?} {cosine}: {}", white.all);
            }
        }
    }
}

#[test]
fn light_goes_both_ways() {
    let facets = Facets::new(0.4).with_metallic(1.0);
    let at = |z: f32, x: f32| Vec3::new(x, (1.0 - z * z - x * x).sqrt(), z);
    for (a, b) in [(at(0.9, 0.1), at(0.3, -0.2)), (at(0.5, 0.5), at(0.6, -0.5)), (at(0.2, 0.9), at(0.99, 0.0))] {
        let way = |light: Vec3, eye: Vec3| {
            let lobe = Lobe::new(&facets, &mut coefficients(Vec3::ONE, Vec3::ZERO), &sight(eye.z));
            lobe.toward(Vec3::Z, eye, light, 0.0) / lobe.gain
        };
        assert!((way(a, b) - way(b, a)).abs().max_element() < 1e-5 * way(a, b).x, "{a}, {b}");
    }
}

#[test]
fn smooth_facets_are_mirrors_of_fresnels_reflectance() {
    let facets = Facets::new(0.0);
    for (cosine, expected) in [(1.0, 0.04), (0.5, 0.04 + 0.96 / 32.0)] {
        let mut seen = coefficients(Vec3::splat(0.5), Vec3::splat(0.04));
        let lobe = Lobe::new(&facets, &mut seen, &Sight { followed: true, ..sight(cosine) });
        assert!((seen.mirrored - Vec3::splat(expected)).abs().max_element() < 2e-3, "{}", seen.mirrored);
        assert_eq!((lobe.unmirrored, seen.all), (0.0, seen.kd), "the mirror ray shows all");
    }
}

#[test]
fn a_wide_light_has_a_highlight_of_the_same_strength() {
    // What arrives from a light 0.2 wide, by points on it, with lobes as wide as their parts and without.
    let facets = Facets::new(0.3).with_metallic(1.0);
    let lobe = Lobe::new(&facets, &mut coefficients(Vec3::ONE, Vec3::ZERO), &sight(0.8));
    let eye = Vec3::new(0.6, 0.0, 0.8);
    let sum = |points: i32, part: f32| {
        let place = |index: i32| 0.2 * ((index as f32 + 0.5) / points as f32 - 0.5);
        let places = (0..points * points).map(|index| (place(index % points), place(index / points)));
        let each = places.map(|(x, y)| lobe.toward(Vec3::Z, eye, Vec3::new(-0.6 + x, y, 0.8).normalize(), part).x);
        each.sum::<f32>() / (points * points) as f32
    };
    let (few, many) = (sum(3, 0.033), sum(60, 0.0));
    assert!((few / many - 1.0).abs() < 0.1, "{few}, not {many}");
}

/// What `drawn` shows of a sky whose radiance depends on the direction: the mean over many directions.
fn drawn(lobe: &Lobe, eye: Vec3, sky: impl Fn(Vec3) -> f32) -> Vec3 {
    const STEPS: u32 = 400;
    let place = |index: u32| (index as f32 + 0.5) / STEPS as f32;
    let all = (0..STEPS * STEPS).map(|index| lobe.drawn(Vec3::Z, eye, [place(index / STEPS), place(index % STEPS)]));
    all.map(|(direction, share)| sky(direction) * share).sum::<Vec3>() / (STEPS * STEPS) as f32
}

#[test]
fn mirror_rays_show_what_the_formula_does() {
    let gold = Vec3::new(1.0, 0.77, 0.34);
    // A panel that a highlight shows the middle and one side of.
    let panel = |direction: Vec3| f32::from(direction.x < -0.45 && direction.y > -0.1);
    for (roughness, cosine) in [(0.2, 0.8), (0.35, 0.5), (0.5, 0.8), (0.5, 0.2)] {
        for metallic in [0.0, 1.0] {
            let facets = Facets::new(roughness).with_metallic(metallic);
            let mut seen = coefficients(gold, Vec3::splat(0.04));
            let lobe = Lobe::new(&facets, &mut seen, &Sight { followed: true, ..sight(cosine) });
            let eye = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);

            let all = drawn(&lobe, eye, |_| 1.0);
            assert!((all / seen.mirrored - 1.0).abs().max_element() < 0.02, "{facets:?}: {all}, not {}", seen.mirrored);

            let steps = 600;
            let step = std::f32::consts::FRAC_PI_2 / steps as f32;
            let mut sum = glam::DVec3::ZERO;
            for (i, j) in (0..steps).flat_map(|i| (0..4 * steps).map(move |j| (i, j))) {
                let (sin, cos) = ((i as f32 + 0.5) * step).sin_cos();
                let (y, x) = ((j as f32 + 0.5) * step).sin_cos();
                let direction = Vec3::new(sin * x, sin * y, cos);
                if panel(direction) > 0.0 {
                    sum += (cos * sin * lobe.toward(Vec3::Z, eye, direction, 0.0)).as_dvec3();
                }
            }
            let expected = (f64::from(step * step) / PI * sum).as_vec3();
            let found = drawn(&lobe, eye, panel);
            assert!(
                (found / expected - 1.0).abs().max_element() < 0.03,
                "{facets:?} {cosine}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn smooth_mirrors_reflect_one_way() {
    let lobe = Lobe::new(&Facets::new(0.0), &mut coefficients(Vec3::ONE, Vec3::ONE), &sight(0.6));
    for u in [[0.0, 0.0], [0.3, 0.99], [0.999, 0.5]] {
        let (direction, _) = lobe.drawn(Vec3::Z, Vec3::new(0.8, 0.0, 0.6), u);
        assert!(direction.distance(Vec3::new(-0.8, 0.0, 0.6)) < 1e-6, "{direction}");
    }
}
