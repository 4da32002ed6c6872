//! A BVH over shapes in many places gives the same bits as brute force over copies of them.

use glam::{DMat4, DQuat, DVec3, EulerRot, Vec3};
use lightmesh_render::accel::{
    Accelerator, BruteForce, Bvh, Region, ShortSegments, ShortTest, TangentPlanes, Triangle,
};
use lightmesh_render::internals::accel::AlphaMask;
use lightmesh_scene::{FIRST_INSTANCED, Mesh};
use proptest::prelude::*;

use super::agreement::{bits, blocked, closest, occluded};
use super::rays::Targets;
use super::scenes::{Scene, alpha_tested};
use super::{Random, grids, scenes};

/// Triangles as a mesh.
fn mesh(triangles: &[Triangle]) -> Mesh {
    Mesh {
        positions: triangles.iter().flat_map(Triangle::corners).collect(),
        triangles: (0..triangles.len() as u32).map(|first| [3 * first, 3 * first + 1, 3 * first + 2]).collect(),
        materials: vec![0; triangles.len()],
        ..Mesh::default()
    }
}

/// Turned, scaled by other factors along each axis, mirrored or not; not far from each other, or inside each other.
fn places(middle: DVec3, random: &mut Random) -> Vec<DMat4> {
    let count = 1 + random.below(8);
    let side = random.pick(&[0.1, 1.0, 4.0]);
    let place = |_| {
        let turn = (6.3 * random.signed()).as_dvec3();
        let size = 10f64.powf(random.unit() as f64 * 2.0 - 1.0);
        let scale = size * (1.5 + random.signed().as_dvec3()) * if random.below(3) == 0 { -1.0 } else { 1.0 };
        let turn = DQuat::from_euler(EulerRot::XYZ, turn.x, turn.y, turn.z);
        let to = (side * random.signed()).as_dvec3();
        DMat4::from_scale_rotation_translation(scale, turn, to) * DMat4::from_translation(-middle)
    };
    (0..count).map(place).collect()
}

/// A scene's own triangles and a shape in several places: the structure, and copies.
struct Shared {
    bvh: Bvh,
    copies: Vec<Triangle>,
    alpha_mask: AlphaMask,
}

impl Shared {
    fn new(shape: Scene, cut: bool, random: &mut Random) -> Shared {
        let shape = shape.triangles(random);
        let own = random.pick(&[Scene::Empty, Scene::Soup, Scene::Boxes]).triangles(random);
        let mut mesh = mesh(&own);
        let corners: Vec<Vec3> = shape.iter().filter(|it| it.is_usable()).flat_map(Triangle::corners).collect();
        let middle = corners.iter().map(|corner| corner.as_dvec3()).sum::<DVec3>() / corners.len().max(1) as f64;
        mesh.add_instances(&self::mesh(&shape), &places(middle, random), "shape").unwrap();
        let stored = (0..mesh.triangles.len()).map(|index| Triangle::new(mesh.corners(index), index as u32));
        let (stored, alpha_mask) = alpha_tested(stored.collect(), cut, random);
        let own = &stored[..own.len()];
        let bvh = Bvh::with_instances(own, &stored, mesh.instances.list(), None);
        let bvh = Bvh::with_instances(own, &stored, mesh.instances.list(), Some(&bvh)).with_alpha_mask(&alpha_mask);
        let flat = mesh.flattened().unwrap();
        let first = own.len();
        let copy = |index: usize| match index.checked_sub(first) {
            None => stored[index],
            Some(instanced) => {
                let index_of_instance = FIRST_INSTANCED + instanced as u32;
                let cut = stored[mesh.stored(index_of_instance)].cut();
                Triangle::new(flat.corners(index), index_of_instance).alpha_tested(cut)
            }
        };
        Shared { bvh, copies: (0..flat.triangles.len()).map(copy).collect(), alpha_mask }
    }
}

fn near(triangles: &[Triangle], random: &mut Random) -> Vec3 {
    let usable: Vec<_> = triangles.iter().filter(|triangle| triangle.is_usable()).collect();
    if usable.is_empty() { Vec3::ZERO } else { random.pick(&usable).corners()[0] }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(96) })]

    #[test]
    fn rays_hit_places_like_copies(shape in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let Shared { bvh, copies, alpha_mask } = Shared::new(shape, cut, random);
        let grids = grids(&copies);
        let targets = Targets { triangles: &copies, grids: &grids };
        let mut rays: Vec<_> = (0..200).map(|_| targets.ray(random)).collect();
        rays.extend((0..20).flat_map(|_| targets.beam(random)).collect::<Vec<_>>());
        let oracle = BruteForce::new(&copies).with_alpha_mask(&alpha_mask);
        let (hits, shadows) = (closest(&oracle, &rays), occluded(&oracle, &rays));
        for bvh in [bvh.clone().at_level(fearless_simd::Level::baseline()), bvh] {
            for (index, (hit, expected)) in closest(&bvh, &rays).iter().zip(&hits).enumerate() {
                prop_assert_eq!(bits(hit), bits(expected), "{:?}: {:?} / {:?}", rays[index], hit, expected);
            }
            for (index, (shadow, expected)) in occluded(&bvh, &rays).iter().zip(&shadows).enumerate() {
                prop_assert_eq!(shadow, expected, "{:?}: {:?}", rays[index], hits[index]);
            }
        }
    }

    #[test]
    fn short_segments_meet_places_like_copies(shape in prop::sample::select(&scenes::ALL), cut: bool, seed: u64) {
        let random = &mut Random(seed);
        let Shared { bvh, copies, alpha_mask } = Shared::new(shape, cut, random);
        let oracle = BruteForce::new(&copies).with_alpha_mask(&alpha_mask);
        for _ in 0..20 {
            let length = random.pick(&[0.05, 0.5, 2.0]);
            let origin = near(&copies, random) + random.signed() * length;
            let normal = random.signed().normalize_or(Vec3::Z);
            let directions: Vec<_> = (0..40).map(|_| random.signed() * length).collect();
            let directions: Vec<_> = directions.into_iter().filter(|direction| direction.dot(normal) > 0.0).collect();
            let test = ShortTest { origin, normal, edge_on: 1e-3 * length };
            let segments = ShortSegments { test, directions: &directions, slack: 1e-2 * length, alpha_mask: &alpha_mask };
            prop_assert_eq!(blocked(&bvh, &segments), blocked(&oracle, &segments), "from {:?}", origin);
        }
    }

    #[test]
    fn regions_hold_places_like_copies(shape in prop::sample::select(&scenes::ALL), seed: u64) {
        let random = &mut Random(seed);
        let Shared { bvh, copies, .. } = Shared::new(shape, false, random);
        let oracle = BruteForce::new(&copies);
        for _ in 0..20 {
            let middle = near(&copies, random);
            let half = random.pick(&[0.01, 0.3, 2.0]) * random.signed().abs();
            let origins = lightmesh_scene::Bounds { min: middle - half, max: middle + half };
            let light = middle + 5.0 * random.signed();
            let emitter = lightmesh_scene::Bounds { min: light - half, max: light + half };
            let normal = random.signed().normalize_or(Vec3::Y);
            for region in [Region::within(origins), Region::near(origins, half.x), Region::shaft(origins, emitter)] {
                let region = region.above(TangentPlanes::new(origins.min, [(middle, normal)].into_iter(), 0.0));
                let found = |structure: &dyn Accelerator| {
                    let mut found = Vec::new();
                    structure.triangles_in(&region, &mut found);
                    // What becomes a line where it is placed is in no copy, and nothing hits it.
                    let is_usable = |index: &u32| {
                        copies.iter().find(|copy| copy.index() == *index).is_some_and(Triangle::is_usable)
                    };
                    found.retain(is_usable);
                    found.sort_unstable();
                    found
                };
                prop_assert_eq!(found(&bvh), found(&oracle), "{:?}", region);
            }
        }
    }
}
