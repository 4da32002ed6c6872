//! Formula (3) against its evaluation in double precision.

use glam::{DVec3, Vec3};
use lightmesh_render::backend::{Backend, Cpu, Seen, Wave};
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, brick_of, point_bit, point_of};
use lightmesh_render::{
    Acceleration, LightGroup, PreparedScene, RenderContext, Sampling, SurfacePoint, Unobserved, View, VisibilityOfLight,
};
use lightmesh_scene::{LightKind, Weight};
use lightmesh_testkit::{WEIGHTS, pile};

const LIGHTS: [LightKind; 2] = [
    LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 },
    LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.4 },
];

/// w of formula (3) as defined by the method.
fn w(weight: Weight, q: f64) -> f64 {
    match weight {
        Weight::Constant => 1.0,
        Weight::Quadratic => 1.0 - q * q,
        Weight::Smooth => (1.0 - q * q).powi(2),
    }
}

#[test]
fn visibility_is_the_weighted_mean_of_the_light_points() {
    let scene = pile(DVec3::ZERO, &LIGHTS);
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    for (weight, radius) in WEIGHTS.into_iter().zip([2.1, 3.1, 4.1]) {
        let lattice = Lattice::around(&scene, 0.2, radius).unwrap();
        let template = Template::new(radius).unwrap();
        let mesh = LightMesh { lattice, template, radius: 0.2 * radius, weight };
        let context = RenderContext::new(&Unobserved, Sampling { samples: 5, seed: 0, spread: false });
        let cpu = Cpu;
        let rays = cpu.camera_rays(&View::new(&scene.scene.cameras[0], [64, 64]), 0..64, 0).unwrap();
        let hits = cpu.primary_rays(&context, &scene, &rays).unwrap();
        let wave =
            Wave { context: &context, scene: &scene, rays: &rays, hits: &hits, lights: LightGroup::ALL, parts: 1 };
        let cells = cpu.cells(&wave, &mesh).unwrap();
        let masks = cpu.short_tests(&wave, &cells, &mesh).unwrap();
        let points = cpu.light_points(&context, &cells, &masks, &mesh).unwrap();
        let lit = cpu.long_tests(&wave, &points, &mesh, None).unwrap();
        let seen = Seen { mesh: &mesh, cells: &cells, masks: &masks, points: &points, lit: &lit };
        let found = cpu.interpolate(&wave, &seen).unwrap();

        let mut partial = 0;
        for group in 0..cells.len() {
            let cell = point_of(cells.cell(group));
            for slot in cells.slots(group) {
                let ray = cells.members()[slot] as usize;
                let hit = &hits[ray];
                let point = SurfacePoint::new(&rays.rays[ray], hit, &scene.geometry.triangles.at(hit.triangle));
                let used = mesh.template.offsets().iter().enumerate();
                let used = used.filter(|(bit, _)| masks.mask(slot)[bit / 32] >> (bit % 32) & 1 != 0);
                let used: Vec<_> = used.map(|(_, &offset)| cell + offset).collect();
                assert_eq!(found.used[ray] as usize, used.len());
                for (light, seen) in lit.lights.iter().enumerate() {
                    let center = scene.scene.lights[light].position().unwrap();
                    let facing = point.normal.dot(center - point.position);
                    if facing.abs() < 0.5 || used.is_empty() {
                        // χ and the fallback have separate tests.
                        continue;
                    }
                    let (mut sum, mut weights) = (0.0, 0.0);
                    for &index in &used {
                        let brick = points.bricks().find(brick_of(index)).unwrap();
                        let value = match seen {
                            VisibilityOfLight::Bits(words) => (words[brick] >> point_bit(index) & 1) as f64,
                            VisibilityOfLight::Share { seen, samples } => {
                                f64::from(seen[points.rank(brick, point_bit(index))]) / f64::from(*samples)
                            }
                        };
                        let distance = mesh.lattice.point(index).as_dvec3().distance(point.position.as_dvec3());
                        let weight = w(weight, distance / f64::from(mesh.radius));
                        (sum, weights) = (sum + weight * value, weights + weight);
                    }
                    let expected = if facing < 0.0 { 0.0 } else { sum / weights };
                    let share = f64::from(found.of(light, ray));
                    // Sums of a hundred products in `f32`, and weights near the rim that cancel to few digits.
                    assert!((share - expected).abs() < 2e-5, "{weight:?}: {share} instead of {expected}");
                    partial += usize::from(share > 0.01 && share < 0.99);
                }
            }
        }
        assert!(partial > 100, "{partial} partial shadows were compared");
    }
}
