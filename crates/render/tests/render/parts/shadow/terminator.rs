use glam::{DVec3, Vec3};
use lightmesh_render::accel::{Hit, Ray};
use lightmesh_render::internals::shadow::ShadowPoint;
use lightmesh_render::internals::surface::{long_segment, shading_normal};
use lightmesh_render::sampling::light_center;
use lightmesh_render::{Acceleration, PreparedScene, SurfacePoint, Unobserved};
use lightmesh_scene::Light;
use lightmesh_testkit::{Random, SceneDraft};

/// Half the brightness of a code of 8 bits.
const UNSEEN: f32 = 0.5 / 255.0;

/// A ball of 200 triangles with the normals of a sphere.
fn ball() -> PreparedScene {
    let scene = SceneDraft::new().smooth_ball(DVec3::ZERO, 1.0, [11, 10]).finish("ball");
    assert_eq!(scene.geometry.mesh.triangles.len(), 200);
    PreparedScene::new(&scene, &Acceleration::Bvh, &Unobserved).unwrap()
}

/// A random way, and what a ray from far outside sees of the ball.
fn seen(scene: &PreparedScene, random: &mut Random) -> Option<(Ray, Hit)> {
    let eye = 10.0 * random.in_cube().as_vec3().normalize();
    let target = 0.9 * random.in_cube().as_vec3().clamp_length_max(1.0);
    let ray = Ray { origin: eye, direction: (target - eye).normalize(), t_max: f32::INFINITY };
    let mut hit = [Hit::MISS];
    scene.geometry.accelerator.closest_hits(&[ray], &mut hit);
    hit[0].is_some().then_some((ray, hit[0]))
}

/// The largest cosine of the way to a light that a ball hides from itself: with shadow rays from its triangles, and from the curved surface.
fn darkest(light: impl Fn(Vec3) -> Light) -> [f32; 2] {
    let scene = ball();
    let (geometry, mesh) = (&scene.geometry, &scene.scene.geometry.mesh);
    let mut random = Random::new(7);
    let mut worst = [0.0_f32; 2];
    for _ in 0..20_000 {
        let Some((ray, hit)) = seen(&scene, &mut random) else { continue };
        let triangle = &geometry.triangles.at(hit.triangle);
        let flat = SurfacePoint::new(&ray, &hit, triangle);
        let normal = shading_normal(mesh, &hit, flat.normal);
        let way = random.in_cube().as_vec3().normalize();
        let light = light(way);
        let points = [flat, ShadowPoint::new(flat, mesh, &hit, triangle).toward(&light, geometry)];
        for (worst, point) in worst.iter_mut().zip(points) {
            let target = light_center(&light, point.origin, geometry.sun_distance(point.origin));
            let shaded = light_center(&light, flat.origin, geometry.sun_distance(flat.origin)) - flat.position;
            let cosine = normal.dot(shaded.normalize());
            let mut hidden = [point.normal.dot(target - point.origin) <= 0.0];
            if !hidden[0] {
                geometry.accelerator.occluded(&[long_segment(point.origin, target)], &mut hidden);
            }
            if hidden[0] {
                *worst = worst.max(cosine);
            }
        }
    }
    worst
}

#[test]
fn a_coarse_ball_does_not_hide_the_sun_from_itself() {
    let [flat, curved] = darkest(|way| Light::directional(-way).unwrap());
    assert!(flat > 0.1, "without curvature facets are dark: {flat}");
    assert!(curved <= UNSEEN, "{curved}");
}

#[test]
fn a_coarse_ball_does_not_hide_a_lamp_from_itself() {
    let [flat, curved] = darkest(|way| Light::point(3.0 * way));
    assert!(flat > 0.1, "without curvature facets are dark: {flat}");
    assert!(curved <= UNSEEN, "{curved}");
}

#[test]
fn what_is_high_over_a_triangle_is_looked_for_from_there() {
    let scene = ball();
    let (geometry, mesh) = (&scene.geometry, &scene.scene.geometry.mesh);
    let mut random = Random::new(8);
    let mut lifted = 0;
    for _ in 0..1000 {
        let Some((ray, hit)) = seen(&scene, &mut random) else { continue };
        let triangle = &geometry.triangles.at(hit.triangle);
        let flat = SurfacePoint::new(&ray, &hit, triangle);
        let point = ShadowPoint::new(flat, mesh, &hit, triangle);
        let from = |direction: Vec3, angle: f32| {
            point.toward(&Light::directional(direction).unwrap().with_angle(angle), geometry).origin
        };
        let across = flat.normal.any_orthonormal_vector();
        assert_eq!(from(-flat.normal, 0.1), flat.origin);
        // It moves steadily as a light sinks.
        let away =
            |height: f32| (from(-(across + height * flat.normal).normalize(), 0.0) - flat.origin).dot(flat.normal);
        assert!(away(0.2) == 0.0 && away(0.05) >= 0.0 && away(0.0) >= away(0.05) && away(-0.05) >= away(0.0));
        lifted += u32::from(away(0.0) > away(0.05));
    }
    assert!(lifted > 100, "{lifted}");
}

#[test]
fn surfaces_that_are_flat_bent_inwards_or_creased_stay() {
    let scene = ball();
    let mesh = &scene.scene.geometry.mesh;
    let mut random = Random::new(9);
    let mut checked = 0;
    while checked < 100 {
        let Some((ray, hit)) = seen(&scene, &mut random) else { continue };
        let triangle = &scene.geometry.triangles.at(hit.triangle);
        let flat = SurfacePoint::new(&ray, &hit, triangle);
        let curved = |normals: &dyn Fn(Vec3) -> Vec3, viewer: f32| {
            let mut mesh = mesh.clone();
            mesh.normals.iter_mut().for_each(|normal| *normal = normals(*normal));
            let point = SurfacePoint { normal: viewer * flat.normal, ..flat };
            ShadowPoint::new(point, &mesh, &hit, triangle).is_curved()
        };
        assert!(curved(&|normal| normal, 1.0) && !curved(&|normal| normal, -1.0), "seen from inside");
        // Normals on the wrong side say the same.
        assert!(curved(&|normal| -normal, 1.0));
        assert!(!curved(&|_| Vec3::ZERO, 1.0));
        let creased = |normal: Vec3| (normal + 2.0 * flat.normal.any_orthonormal_vector()).normalize();
        assert!(!curved(&creased, 1.0), "creased");
        checked += 1;
    }
}
