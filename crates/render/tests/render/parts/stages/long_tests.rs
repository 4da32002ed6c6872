//! What light points see, compared with one ray each through every triangle.

use glam::{DVec3, Vec3};
use lightmesh_render::accel::{Accelerator, BruteForce, Ray};
use lightmesh_render::backend::{Backend, Cpu, Wave};
use lightmesh_render::light_mesh::{Lattice, LightMesh, Template, UsedPoints, point_bit};
use lightmesh_render::{
    Acceleration, LightGroup, LightPointVisibility, PreparedScene, RenderContext, Sampling, Tally, Unobserved, View,
    VisibilityOfLight,
};
use lightmesh_scene::{LightKind, Weight};
use lightmesh_testkit::pile;

const CENTER: Vec3 = Vec3::new(2.0, 4.0, 1.0);
const SAMPLES: u32 = 6;

/// A point light, a sun, and a ball of radius `radius` around the point light.
fn lights(radius: f32) -> [LightKind; 3] {
    [
        LightKind::Point { position: CENTER, spread: 0.5 },
        LightKind::Directional { direction: Vec3::new(0.6, -0.8, 0.0), angle: 0.0 },
        LightKind::Sphere { position: CENTER, radius },
    ]
}

/// Passes the tested light points, what they see, and the context to `judge`.
fn with_light_points(
    radius: f32,
    judge: impl Fn(&PreparedScene, &LightMesh, &UsedPoints, &LightPointVisibility, &RenderContext),
) {
    let scene = pile(DVec3::ZERO, &lights(radius));
    let scene = PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap();
    let lattice = Lattice::around(&scene, 0.2, 2.1).unwrap();
    let mesh = LightMesh { lattice, template: Template::new(2.1).unwrap(), radius: 0.42, weight: Weight::Smooth };
    let context = RenderContext::new(&Unobserved, Sampling { samples: SAMPLES, seed: 0, spread: false });
    let cpu = Cpu;
    let rays = cpu.camera_rays(&View::new(&scene.scene.cameras[0], [64, 64]), 0..64, 0).unwrap();
    let hits = cpu.primary_rays(&context, &scene, &rays).unwrap();
    let wave = Wave { context: &context, scene: &scene, rays: &rays, hits: &hits, lights: LightGroup::ALL, parts: 1 };
    let cells = cpu.cells(&wave, &mesh).unwrap();
    let masks = cpu.short_tests(&wave, &cells, &mesh).unwrap();
    let points = cpu.light_points(&context, &cells, &masks, &mesh).unwrap();
    let lit = cpu.long_tests(&wave, &points, &mesh, None).unwrap();
    judge(&scene, &mesh, &points, &lit, &context);
}

#[test]
fn bits_are_what_a_ray_through_all_triangles_finds() {
    with_light_points(0.4, |scene, mesh, points, lit, _| {
        let oracle = BruteForce::new(scene.geometry.triangles.stored());
        let far = scene.geometry.sun_distance(Vec3::ZERO) * 4.0;
        for (light, direction) in [(0, None), (1, Some(Vec3::new(-0.6, 0.8, 0.0)))] {
            let VisibilityOfLight::Bits(words) = &lit.lights[light] else { panic!("seen or not") };
            let (mut seen, mut hidden) = (0, 0);
            for (brick, word) in words.iter().enumerate() {
                assert_eq!(word & !points.used()[brick], 0, "only used points are lit");
                for point in points.points(brick) {
                    let origin = mesh.lattice.point(point);
                    let direction = direction.map_or(CENTER - origin, |direction| far * direction);
                    let mut occluded = [false];
                    oracle.occluded(&[Ray { origin, direction, t_max: 1.0 }], &mut occluded);
                    assert_eq!(word >> point_bit(point) & 1 == 0, occluded[0], "light {light} from {origin}");
                    *if occluded[0] { &mut hidden } else { &mut seen } += 1;
                }
            }
            assert!(seen > 100 && hidden > 100, "light {light}: {seen} seen, {hidden} hidden");
        }
    });
}

#[test]
fn a_light_with_a_size_is_seen_in_shares() {
    with_light_points(0.8, |_, _, points, lit, context| {
        let VisibilityOfLight::Share { seen, samples } = &lit.lights[2] else { panic!("a share") };
        assert_eq!((*samples, seen.len()), (SAMPLES, points.count()));
        for share in 0..=SAMPLES as u16 {
            assert!(seen.contains(&share), "no light point sees {share} of {SAMPLES}");
        }
        assert!(seen.iter().all(|&share| u32::from(share) <= SAMPLES));
        // One ray to the point light, one to the sun, and the samples.
        assert_eq!(Tally::get(&context.tally.long_tests), points.count() as u64 * u64::from(2 + SAMPLES));
    });
}

#[test]
fn a_light_of_hardly_any_size_is_seen_as_a_point_light() {
    with_light_points(1e-6, |_, _, points, lit, _| {
        let (VisibilityOfLight::Bits(words), VisibilityOfLight::Share { seen, .. }) = (&lit.lights[0], &lit.lights[2])
        else {
            panic!("one bit for the point, shares for the ball")
        };
        let mut differing = 0;
        for (brick, word) in words.iter().enumerate() {
            for point in points.points(brick) {
                let share = u32::from(seen[points.rank(brick, point_bit(point))]);
                let whole = if word >> point_bit(point) & 1 != 0 { SAMPLES } else { 0 };
                differing += usize::from(share != whole);
            }
        }
        // Light points within 1e-6 of a shadow's border may differ.
        assert!(differing * 1000 < points.count(), "{differing} of {}", points.count());
    });
}
