//! Directions and weights of mirrored rays.

use glam::Vec3;
use lightmesh_layout::constants::{DEEP, DIRECTION_SHIFT, MAX_DIRECTIONS, MIN_THICK, MIN_THICK_DEEP};
use lightmesh_render::accel::{Hit, Ray};
use lightmesh_render::backend::Wave;
use lightmesh_render::internals::stages::mirror_rays;
use lightmesh_render::{Acceleration, LightGroup, PreparedScene, RayList, RenderContext, Sampling, Unobserved, Window};
use lightmesh_scene::{Facets, Material, Opacity};
use lightmesh_testkit::SceneDraft;

fn mirror(ks: Vec3) -> Material {
    Material::default().with_ks(ks)
}

/// The mirrored rays of `list` on a floor of this material.
fn mirrored(material: Material, normals: Option<Vec3>, list: &RayList) -> RayList {
    let mut scene = SceneDraft::new().painted(material).floor(0.0, 10.0).finish("floor");
    scene.geometry_mut().mesh.normals =
        normals.map_or(Vec::new(), |normal| vec![normal; scene.geometry.mesh.positions.len()]);
    let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved).unwrap();
    let mut hits = vec![Hit::MISS; list.rays.len()];
    scene.geometry.accelerator.closest_hits(&list.rays, &mut hits);
    let context = RenderContext::new(&Unobserved, Sampling { samples: 1, seed: 0, spread: false });
    let list = &RayList { bounces: list.depth + 1, ..list.clone() };
    mirror_rays(&Wave { context: &context, scene: &scene, rays: list, hits: &hits, lights: LightGroup::ALL, parts: 1 })
}

/// Rays of unit length: two that meet the floor and, between them, one that does not.
fn rays(weights: Vec<Vec3>) -> RayList {
    let ray = |direction: Vec3| Ray { origin: Vec3::new(0.5, 2.0, 0.25), direction, t_max: f32::INFINITY };
    let directions = [Vec3::new(0.6, -0.8, 0.0), Vec3::Y, Vec3::new(0.0, -0.8, -0.6)];
    RayList { rays: directions.map(ray).to_vec(), pixels: vec![4, 5, 7], weights, ..RayList::default() }
}

#[test]
fn rays_leave_as_they_came_on_the_other_side() {
    let next = mirrored(mirror(Vec3::new(0.5, 0.25, 1.0)), None, &rays(Vec::new()));
    assert_eq!(next.pixels, [4, 7], "rays that miss end");
    assert_eq!(next.weights, [Vec3::new(0.5, 0.25, 1.0); 2]);
    for (ray, expected) in next.rays.iter().zip([Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.0, 0.8, -0.6)]) {
        assert!(ray.direction.distance(expected) < 1e-6, "{}", ray.direction);
        assert!((ray.direction.length() - 1.0).abs() < 1e-6);
        assert!(ray.origin.y >= 0.0 && ray.origin.y < 1e-4, "just off the floor: {}", ray.origin.y);
    }
    assert!(next.rays[0].origin.distance(Vec3::new(2.0, 0.0, 0.25)) < 1e-4);
}

#[test]
fn weights_are_products_along_the_way() {
    let weights = vec![Vec3::new(0.5, 1.0, 0.0); 3];
    let next = mirrored(mirror(Vec3::splat(0.5)), None, &rays(weights));
    assert_eq!(next.weights, [Vec3::new(0.25, 0.5, 0.0); 2]);
}

#[test]
fn what_does_not_mirror_ends_the_ray() {
    assert!(mirrored(mirror(Vec3::ZERO), None, &rays(Vec::new())).rays.is_empty());
    assert!(mirrored(mirror(Vec3::X), None, &rays(vec![Vec3::Y; 3])).rays.is_empty(), "no channel is left");
}

#[test]
fn smooth_normals_turn_the_mirror_but_not_into_the_surface() {
    // Leaning by 10 degrees against the first ray: it turns by 20.
    let lean = 10f32.to_radians();
    let next = mirrored(mirror(Vec3::ONE), Some(Vec3::new(-lean.sin(), lean.cos(), 0.0)), &rays(Vec::new()));
    let expected = Vec3::new(0.6, 0.8, 0.0);
    assert!((next.rays[0].direction.angle_between(expected) - 2.0 * lean).abs() < 1e-3);
    // A normal that would reflect into the floor: the geometric one is used instead.
    let next = mirrored(mirror(Vec3::ONE), Some(Vec3::new(0.99, 0.141, 0.0)), &rays(Vec::new()));
    assert!(next.rays.iter().all(|ray| ray.direction.y > 0.0), "{:?}", next.rays);
}

/// What a rough mirror reflects in each of its directions, another one reflects in its own.
#[test]
fn rays_from_a_rough_mirror_leave_another_in_different_directions() {
    let down = Ray { origin: Vec3::new(0.5, 2.0, 0.25), direction: Vec3::NEG_Y, t_max: f32::INFINITY };
    let list = RayList {
        rays: vec![down; MAX_DIRECTIONS as usize],
        pixels: vec![4; MAX_DIRECTIONS as usize],
        samples: (0..MAX_DIRECTIONS).map(|number| 1 | number << DIRECTION_SHIFT).collect(),
        window: Window::all([8, 8]),
        depth: 1,
        ..RayList::default()
    };
    let metal = Material::matt(Vec3::ONE).with_facets(Facets::new(0.5).with_metallic(1.0));
    let next = mirrored(metal, None, &list);
    assert_eq!(next.rays.len(), MAX_DIRECTIONS as usize, "one of each");
    for (first, ray) in next.rays.iter().enumerate() {
        for other in &next.rays[..first] {
            assert!(ray.direction.distance(other.direction) > 1e-3, "{} and {}", ray.direction, other.direction);
        }
    }
}

/// Many rays of this depth and weight, `each` of each pixel of an image of 64 × 64, onto a floor of this material.
fn faint(material: Material, depth: u32, weight: f32, each: usize) -> RayList {
    let ray = Ray { origin: Vec3::new(0.5, 2.0, 0.25), direction: Vec3::new(0.6, -0.8, 0.0), t_max: f32::INFINITY };
    let count = 64 * 64 * each;
    let list = RayList {
        rays: vec![ray; count],
        pixels: (0..count).map(|ray| (ray / each) as u32).collect(),
        weights: vec![Vec3::splat(weight); count],
        samples: vec![1; count],
        window: Window::all([64; 2]),
        depth,
        ..RayList::default()
    };
    mirrored(material, None, &list)
}

/// What the rays of each pixel carry together.
fn carried(list: &RayList) -> Vec<f64> {
    let mut sums = vec![0.0; 64 * 64];
    list.pixels.iter().zip(&list.weights).for_each(|(&pixel, weight)| sums[pixel as usize] += f64::from(weight.x));
    sums
}

#[test]
fn faint_rays_are_thinned_and_carry_what_they_did() {
    let glass = mirror(Vec3::ONE).with_opacity(Opacity::blend(0.5));
    let deep = [(1.0 / 1000.0, 13), (1.0 / 5000.0, 40), (1.0 / 20_000.0, 7)].map(|rays| (DEEP, MIN_THICK_DEEP, rays));
    let other = [(1.0 / 5000.0, 40), (1.0 / 90_000.0, 30)].map(|rays| (DEEP - 1, MIN_THICK, rays));
    for (depth, thick, (weight, each)) in deep.into_iter().chain(other) {
        let thick = f64::from(thick);
        let next = faint(glass.clone(), depth, weight, each);
        let (sums, expected) = (carried(&next), f64::from(weight) * each as f64);
        for &sum in &sums {
            assert!((sum - expected).abs() < 1.01 * thick, "a pixel errs by less than one ray: {sum}, {expected}");
        }
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        assert!((mean / expected - 1.0).abs() < 0.03, "{mean} instead of {expected}");
        let count = next.rays.len() as f64 / sums.len() as f64;
        assert!((count * thick / expected - 1.0).abs() < 0.03, "{count} rays of a pixel");
    }
}

#[test]
fn what_is_seen_well_is_not_thinned() {
    let half = |next: &RayList, share: f32| next.weights.iter().all(|&weight| weight == Vec3::splat(share));
    let glass = mirror(Vec3::ONE).with_opacity(Opacity::blend(0.5));
    for (depth, thick) in [(0, MIN_THICK), (DEEP - 1, MIN_THICK), (DEEP, MIN_THICK_DEEP)] {
        let next = faint(glass.clone(), depth, 2.0 * thick, 3);
        assert!(next.rays.len() == 2 * 3 * 64 * 64 && half(&next, thick), "both rays of each go on as they are");
    }
    // Opaque mirrors make one ray each.
    let next = faint(mirror(Vec3::splat(0.5)), 0, 1.0 / 1024.0, 3);
    assert!(next.rays.len() == 3 * 64 * 64 && half(&next, 1.0 / 2048.0));
    assert!(faint(mirror(Vec3::splat(0.5)), 0, 1.0 / 4096.0, 3).rays.is_empty());
}
