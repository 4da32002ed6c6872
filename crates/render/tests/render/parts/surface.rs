use glam::Vec3;
use lightmesh_render::SurfacePoint;
use lightmesh_render::accel::{Hit, Ray, Triangle};
use lightmesh_render::internals::surface::long_segment;

#[test]
fn the_normal_faces_the_viewer_and_the_origin_leaves_the_surface() {
    let triangle = Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y].map(|corner| corner + Vec3::splat(100.0)), 0);
    let hit = Hit { t: 1.0, u: 0.25, v: 0.25, triangle: 0 };
    for z in [1.0, -1.0] {
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::new(0.0, 0.0, -z), t_max: f32::INFINITY };
        let point = SurfacePoint::new(&ray, &hit, &triangle);
        assert_eq!(point.position, Vec3::new(100.25, 100.25, 100.0));
        assert_eq!(point.normal, Vec3::new(0.0, 0.0, z));
        let height = (point.origin.z - 100.0) * z;
        assert!(height > 1e-5 && height < 1e-3, "{height}");
    }
}

#[test]
fn a_floor_at_height_zero_is_left_too() {
    let triangle = Triangle::new([Vec3::ZERO, Vec3::X * 30.0, Vec3::NEG_Z * 30.0], 0);
    let hit = Hit { t: 1.0, u: 0.25, v: 0.25, triangle: 0 };
    let ray = Ray { origin: Vec3::Y, direction: Vec3::NEG_Y, t_max: f32::INFINITY };
    assert!(SurfacePoint::new(&ray, &hit, &triangle).origin.y > 1e-6);
}

#[test]
fn a_long_segment_stops_before_its_end() {
    let ray = long_segment(Vec3::ZERO, Vec3::new(0.0, 100.0, 0.0));
    assert!(ray.t_max < 1.0 && ray.t_max > 0.9999);
    assert_eq!(long_segment(Vec3::ONE, Vec3::ONE).direction, Vec3::ZERO);
}
