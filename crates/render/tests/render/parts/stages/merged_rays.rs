use glam::Vec3;
use lightmesh_layout::constants::{FADE_SHIFT, THROUGHS_MASK, THROUGHS_SHIFT};
use lightmesh_render::accel::{Hit, Ray};
use lightmesh_render::backend::Wave;
use lightmesh_render::internals::stages::merged_rays;
use lightmesh_render::{Acceleration, Cone, LightGroup, PreparedScene, RayList, RenderContext, Sampling, Unobserved};
use lightmesh_scene::Material;
use lightmesh_testkit::SceneDraft;

/// What is left of rays straight down from these places, in these pixels, above a floor that mirrors `ks` and, at x < 0, a higher one.
fn left(ks: f32, rays: &[(f32, u32)], throughs: u32) -> (RayList, Vec<Hit>) {
    left_of(ks, rays, throughs << THROUGHS_SHIFT, 1.0)
}

/// The same with marks on the numbers of samples, and of so many times the weight.
fn left_of(ks: f32, rays: &[(f32, u32)], marks: u32, times: f32) -> (RayList, Vec<Hit>) {
    let throughs = marks >> THROUGHS_SHIFT & THROUGHS_MASK;
    let floor = |x: f64, y: f64| [[x, y, -5.0], [x, y, 5.0], [x + 5.0, y, 5.0], [x + 5.0, y, -5.0]];
    let draft = SceneDraft::new().painted(Material::default().with_ks(Vec3::splat(ks)));
    let scene = draft.quad(floor(0.0, 0.0)).quad(floor(-5.0, 1.0)).finish("floors");
    let scene = PreparedScene::new(&scene, &Acceleration::BruteForce, &Unobserved).unwrap();
    let down = |x: f32| Ray { origin: Vec3::new(x, 4.0, 0.2), direction: Vec3::NEG_Y, t_max: f32::INFINITY };
    let list = RayList {
        rays: rays.iter().map(|&(x, _)| down(x)).collect(),
        pixels: rays.iter().map(|&(_, pixel)| pixel).collect(),
        samples: (0..rays.len() as u32).map(|ray| ray + 1 + marks).collect(),
        weights: (0..rays.len()).map(|ray| Vec3::splat(times * (0.25 + ray as f32 / 64.0))).collect(),
        cones: vec![Cone { width: 0.5, spread: -0.25 }; rays.len()],
        depth: 1 + throughs,
        bounces: 2,
        spacing: [0.0, 0.01],
        eye: Vec3::splat(2.0),
        ..RayList::default()
    };
    let mut hits = vec![Hit::MISS; rays.len()];
    scene.geometry.accelerator.closest_hits(&list.rays, &mut hits);
    let context = RenderContext::new(&Unobserved, Sampling { samples: 1, seed: 0, spread: false });
    merged_rays(&Wave { context: &context, scene: &scene, rays: &list, hits: &hits, lights: LightGroup::ALL, parts: 1 })
}

const RAYS: [(f32, u32); 7] = [(1.0, 3), (-1.0, 3), (1.1, 3), (9.0, 3), (-1.1, 3), (1.2, 5), (8.0, 5)];

#[test]
fn rays_of_a_pixel_on_one_surface_are_one() {
    let (rays, hits) = left(0.0, &RAYS, 0);
    let origins: Vec<f32> = rays.rays.iter().map(|ray| ray.origin.x).collect();
    assert_eq!(origins, [1.0, -1.0, 9.0, 1.2, 8.0], "what sees nothing stays apart");
    assert_eq!(rays.pixels, [3, 3, 3, 5, 5]);
    assert_eq!(rays.samples, [1, 2, 4, 6, 7]);
    let weights: Vec<f32> = rays.weights.iter().map(|weight| 64.0 * weight.x).collect();
    assert_eq!(weights, [34.0, 37.0, 19.0, 21.0, 22.0]);
    assert_eq!(hits.iter().map(|hit| hit.is_some()).collect::<Vec<_>>(), [true, true, false, true, false]);
    let root = 2.0_f32.sqrt();
    let widths: Vec<f32> = rays.cones.iter().map(|cone| cone.width).collect();
    assert_eq!(widths, [0.5 * root, 0.5 * root, 0.5, 0.5, 0.5]);
    assert_eq!((rays.depth, rays.bounces, rays.spacing), (1, 2, [0.0, 0.01]));
}

#[test]
fn rays_that_meet_clear_mirrors_or_went_through_something_stay_apart() {
    assert_eq!(left(0.05, &RAYS, 0).1.len(), 5, "a twentieth of half a pixel's light may be merged");
    assert_eq!(left(0.5, &RAYS, 0).1.len(), RAYS.len());
    assert_eq!(left(0.0, &RAYS, 1).1.len(), RAYS.len());
}

#[test]
fn many_rays_of_one_pixel_are_merged_32_at_a_time() {
    let rays: Vec<(f32, u32)> = (0..2100).map(|ray| (1.0, ray / 70)).collect();
    let (rays, _) = left(0.0, &rays, 0);
    assert_eq!(rays.pixels, (0..30).flat_map(|pixel| [pixel; 3]).collect::<Vec<u32>>());
}

/// What a rough mirror shows of a surface is not one thing, even where this surface is matt.
#[test]
fn rays_from_rough_mirrors_are_merged_if_little_of_them_is_seen() {
    let faded = 15 << FADE_SHIFT;
    assert_eq!(left_of(0.0, &RAYS, faded, 1.0).1.len(), RAYS.len());
    assert_eq!(left_of(0.0, &RAYS, faded, 1.0 / 32.0).1.len(), 5);
}
