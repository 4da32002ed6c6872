use glam::{DVec3, Vec3};
use lightmesh_scene::internals::smooth::{corner_angle, normal};

#[test]
fn needles_and_points_have_no_normal() {
    let shape = |height: f64| normal([DVec3::ZERO, DVec3::X, DVec3::new(0.3, height, 0.0)]);
    assert_eq!([1.0, -1e-5].map(|height| shape(height).map(DVec3::as_vec3)), [Vec3::Z, Vec3::NEG_Z].map(Some));
    assert_eq!([0.0, 1e-7, f64::NAN, f64::INFINITY].map(shape), [None; 4]);
    assert_eq!(normal([DVec3::ONE; 3]), None);
}

#[test]
fn small_triangles_are_not_degenerate() {
    assert_eq!(normal([DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| 1e-30 * corner)), Some(DVec3::Z));
}

#[test]
fn angles_are_exact_at_both_ends() {
    let angle = |x: f64, y: f64| corner_angle(DVec3::X, DVec3::new(x, y, 0.0));
    assert!((angle(1.0, 1e-9) - 1e-9).abs() < 1e-20 && (angle(-1.0, 0.0) - std::f64::consts::PI).abs() < 1e-15);
}
