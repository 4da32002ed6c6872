//! Brute force, grids and BVH agree.

use glam::Vec3;
use lightmesh_render::accel::{Accelerator, BruteForce, Bvh, Hit, Ray, ShortSegments, ShortTest, Triangle, Triangles};
use lightmesh_render::internals::accel::{AlphaMask, Beams};
use lightmesh_scene::Bounds;
use proptest::prelude::*;

use super::rays::Targets;
use super::scenes::{Scene, alpha_tested};
use super::{Random, grids, scenes, structures, structures_over};

pub(super) fn closest(accelerator: &dyn Accelerator, rays: &[Ray]) -> Vec<Hit> {
    // Previous content must not matter.
    let mut hits = vec![Hit { t: 0.5, u: 0.5, v: 0.5, triangle: 0 }; rays.len()];
    accelerator.closest_hits(rays, &mut hits);
    hits
}

pub(super) fn occluded(accelerator: &dyn Accelerator, rays: &[Ray]) -> Vec<bool> {
    let mut occluded = vec![true; rays.len()];
    accelerator.occluded(rays, &mut occluded);
    occluded
}

pub(super) fn blocked(accelerator: &dyn Accelerator, segments: &ShortSegments) -> Vec<bool> {
    let mut blocked = vec![true; segments.directions.len()];
    accelerator.short_segments(segments, &mut blocked);
    blocked
}

/// All hits of each ray.
fn all(accelerator: &dyn Accelerator, rays: &[Ray]) -> Vec<Vec<Hit>> {
    let mut hits = vec![Vec::new(); rays.len()];
    accelerator.all_hits(rays, &mut |ray, all| hits[ray].extend_from_slice(all));
    hits
}

pub(super) fn bits(hit: &Hit) -> [u32; 4] {
    bytemuck::cast(*hit)
}

/// Compares all structures over a scene on batches of rays that suit it. Returns the number of rays that hit.
fn rays_agree(
    (triangles, alpha_mask): &(Vec<Triangle>, AlphaMask),
    mut batch: impl FnMut(&Targets) -> Vec<Ray>,
) -> Result<usize, TestCaseError> {
    let grids = grids(triangles);
    let rays = batch(&Targets { triangles, grids: &grids });
    let oracle = BruteForce::new(triangles).with_alpha_mask(alpha_mask);
    let (hits, shadows) = (closest(&oracle, &rays), occluded(&oracle, &rays));
    for (ray, (hit, shadow)) in rays.iter().zip(hits.iter().zip(&shadows)) {
        prop_assert_eq!(hit.is_some(), *shadow, "closest and any hit, {:?}", ray);
        prop_assert!(!hit.t.is_nan() && (0.0..=1.0).contains(&hit.u) && (0.0..=1.0).contains(&hit.v), "{:?}", hit);
    }
    let behind = all(&oracle, &rays);
    for (hits, first) in behind.iter().zip(&hits) {
        prop_assert_eq!(
            hits.first().map(bits),
            first.is_some().then(|| bits(first)),
            "the first of all is the closest"
        );
        let ordered = |pair: &[Hit]| pair[0].t <= pair[1].t && pair[0].triangle != pair[1].triangle;
        prop_assert!(hits.windows(2).all(ordered), "each once and in order: {:?}", hits);
    }
    for (name, accelerator) in &structures_over(triangles, alpha_mask) {
        for (index, (hits, expected)) in all(&**accelerator, &rays).iter().zip(&behind).enumerate() {
            let bits = |hits: &[Hit]| hits.iter().map(bits).collect::<Vec<_>>();
            prop_assert_eq!(bits(hits), bits(expected), "{}, {:?}: all hits", name, rays[index]);
        }
        for (index, (hit, expected)) in closest(&**accelerator, &rays).iter().zip(&hits).enumerate() {
            prop_assert_eq!(bits(hit), bits(expected), "{}, {:?}: {:?} / {:?}", name, rays[index], hit, expected);
        }
        let shadowed = occluded(&**accelerator, &rays);
        for (index, (shadow, expected)) in shadowed.iter().zip(&shadows).enumerate() {
            prop_assert_eq!(shadow, expected, "{}, {:?}: {:?}", name, rays[index], hits[index]);
        }
    }
    for grid in &grids {
        closest(grid, &rays);
        prop_assert_eq!(grid.overruns(), 0);
    }
    Ok(hits.iter().filter(|hit| hit.is_some()).count())
}

/// Rays of all kinds through a scene.
fn single_rays_agree(scene: Scene, cut: bool, seed: u64) -> Result<(), TestCaseError> {
    let random = &mut Random(seed);
    let held = alpha_tested(scene.triangles(random), cut, random);
    let hits = rays_agree(&held, |targets| (0..400).map(|_| targets.ray(random)).collect())?;
    // A comparison of misses would prove little.
    prop_assert!(matches!(scene, Scene::Empty | Scene::One | Scene::Flat) || hits > 40, "{} rays hit", hits);
    Ok(())
}

/// By rounding, a ray nearly parallel to a plane reached the border of a nested grid before it left the cell around it, and the
/// walk through the nested grid ended there, before the hit.
#[test]
fn a_nested_grid_is_not_left_before_the_cell_that_holds_it() {
    single_rays_agree(Scene::Sheet, false, 10_938_381_108_378_275_224).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(96) })]

    #[test]
    fn closest_and_any_hits_agree(scene in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        single_rays_agree(scene, cut, seed)?;
    }

    #[test]
    fn coherent_rays_agree(scene in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let held = alpha_tested(scene.triangles(random), cut, random);
        // Beams one after another in one batch: packets begin and end anywhere.
        let hits = rays_agree(&held, |targets| (0..40).flat_map(|_| targets.beam(random)).collect())?;
        prop_assert!(matches!(scene, Scene::Empty | Scene::One | Scene::Flat) || hits > 40, "{} rays hit", hits);
    }

    #[test]
    fn packets_agree_with_single_rays(scene in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let (triangles, alpha_mask) = alpha_tested(scene.triangles(random), cut, random);
        let grids = grids(&triangles);
        let targets = Targets { triangles: &triangles, grids: &grids };
        let bvh = Bvh::new(&triangles).with_alpha_mask(&alpha_mask);
        for _ in 0..20 {
            let rays = targets.beam(random);
            let (hits, shadows) = (closest(&bvh, &rays), occluded(&bvh, &rays));
            for (index, ray) in rays.iter().enumerate() {
                let alone = closest(&bvh, &[*ray])[0];
                prop_assert_eq!(bits(&hits[index]), bits(&alone), "{} of {}: {:?}", index, rays.len(), ray);
                prop_assert_eq!(shadows[index], occluded(&bvh, &[*ray])[0], "{} of {}: {:?}", index, rays.len(), ray);
            }
        }
    }

    #[test]
    fn beams_agree(scene in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let (triangles, alpha_mask) = alpha_tested(scene.triangles(random), cut, random);
        let grids = grids(&triangles);
        let targets = Targets { triangles: &triangles, grids: &grids };
        let bvh = Bvh::new(&triangles).with_alpha_mask(&alpha_mask);
        let usable = triangles.iter().filter(|triangle| triangle.is_usable());
        let (bounds, held) = (Bounds::around(usable.flat_map(Triangle::corners)), Triangles::from(triangles.clone()));
        let mut beams = Beams::new(&bvh, &held, &alpha_mask, &bounds);
        for _ in 0..20 {
            let unit = |ray: Ray| Ray { direction: ray.direction.try_normalize().unwrap_or(ray.direction), ..ray };
            let rays: Vec<Ray> = targets.beam(random).into_iter().map(unit).collect();
            let expected = closest(&bvh, &rays);
            // Nothing, about as far as they go, or exactly so far; wrong guesses cost time alone.
            let depths: Vec<f32> = expected.iter().map(|hit| hit.t).filter(|t| t.is_finite()).collect();
            let exact = depths.iter().copied().fold(0.0, f32::max);
            let size = random.pick(&[1, 8, 20, 64]);
            for far in [None, Some(exact), Some(1.1 * exact), Some(0.5 * exact), Some(0.0)] {
                let mut hits = vec![Hit { t: 0.5, u: 0.5, v: 0.5, triangle: 0 }; rays.len()];
                beams.closest_hits(&rays, size, |_| far, &mut hits);
                for (index, (hit, expected)) in hits.iter().zip(&expected).enumerate() {
                    prop_assert_eq!(bits(hit), bits(expected), "{:?}: {:?} / {:?}", rays[index], hit, expected);
                }
            }
        }
    }

    #[test]
    fn short_segments_agree(scene in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let (triangles, alpha_mask) = alpha_tested(scene.triangles(random), cut, random);
        let all = structures_over(&triangles, &alpha_mask);
        let oracle = BruteForce::new(&triangles).with_alpha_mask(&alpha_mask);
        for _ in 0..20 {
            let usable: Vec<_> = triangles.iter().filter(|triangle| triangle.is_usable()).collect();
            let near = if usable.is_empty() { Vec3::ZERO } else { random.pick(&usable).corners()[0] };
            let length = random.pick(&[0.05, 0.5, 2.0]);
            let (origin, normal) = (near + random.signed() * length, random.signed().normalize_or(Vec3::Z));
            let directions: Vec<_> = (0..40).map(|_| random.signed() * length).collect();
            let directions: Vec<_> = directions.into_iter().filter(|direction| direction.dot(normal) > 0.0).collect();
            let test = ShortTest { origin, normal, edge_on: 1e-3 * length };
            // The plane form rounds relative to the triangles' size, here up to 1e3.
            let segments = ShortSegments { test, directions: &directions, slack: 1e-2 * length, alpha_mask: &alpha_mask };
            let expected = blocked(&oracle, &segments);
            for (name, accelerator) in &all {
                prop_assert_eq!(&blocked(&**accelerator, &segments), &expected, "{} from {:?}", name, origin);
            }
        }
    }
}

#[test]
fn unusable_rays_miss() {
    let triangles = scenes::indexed(&scenes::icosphere(1));
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X, t_max: f32::INFINITY };
    let rays = [
        Ray { direction: Vec3::ZERO, ..ray },
        Ray { direction: Vec3::new(-0.0, 0.0, -0.0), ..ray },
        Ray { direction: Vec3::NAN, ..ray },
        Ray { direction: Vec3::INFINITY, ..ray },
        Ray { origin: Vec3::NAN, ..ray },
        Ray { origin: Vec3::NEG_INFINITY, ..ray },
        Ray { t_max: 0.0, ..ray },
        Ray { t_max: -1.0, ..ray },
        Ray { t_max: f32::NAN, ..ray },
    ];
    let mut all = structures(&triangles);
    all.push(("brute force", Box::new(BruteForce::new(&triangles))));
    for (name, accelerator) in &all {
        assert!(closest(&**accelerator, &[ray])[0].is_some(), "{name}");
        assert!(closest(&**accelerator, &rays).iter().all(|hit| *hit == Hit::MISS), "{name}");
        assert!(occluded(&**accelerator, &rays).iter().all(|&occluded| !occluded), "{name}");
    }
}

#[test]
fn both_ends_of_a_segment_are_open() {
    let triangles = scenes::indexed(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    let segment =
        |height: f32, t_max: f32| Ray { origin: Vec3::new(0.25, 0.25, height), direction: Vec3::NEG_Z, t_max };
    let segments = [segment(1.0, 1.0), segment(0.0, 1.0), segment(1.0, 1.0 + f32::EPSILON), segment(-1.0, 5.0)];
    let all = structures(&triangles);
    for (name, accelerator) in &all {
        assert_eq!(occluded(&**accelerator, &segments), [false, false, true, false], "{name}");
    }
}

#[test]
fn equal_hits_go_to_the_smallest_index() {
    let corners = scenes::icosphere(1);
    let doubled: Vec<_> = corners.iter().chain(&corners).copied().collect();
    let all = structures(&scenes::indexed(&doubled));
    let random = &mut Random(1);
    let rays: Vec<Ray> =
        (0..200).map(|_| Ray { origin: Vec3::ZERO, direction: random.signed(), t_max: f32::INFINITY }).collect();
    for (name, accelerator) in &all {
        for hit in closest(&**accelerator, &rays) {
            assert!((hit.triangle as usize) < corners.len(), "{name}");
        }
    }
}
