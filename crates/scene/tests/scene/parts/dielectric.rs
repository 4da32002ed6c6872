use glam::Vec3;
use lightmesh_scene::Dielectric;

#[test]
fn attenuation_is_absorption_over_a_distance() {
    let glass = Dielectric::new(1.5).with_attenuation([0.25, 1.0, 0.0], 2.0);
    let left = |distance: f32| (-distance * glass.absorption).exp();
    assert!(left(2.0).abs_diff_eq(Vec3::new(0.25, 1.0, 1e-4), 1e-6), "{}", left(2.0));
    assert!(left(1.0).abs_diff_eq(Vec3::new(0.5, 1.0, 0.01), 1e-6), "{}", left(1.0));
    assert_eq!(Dielectric::new(1.5).with_attenuation([0.5; 3], f32::INFINITY).absorption, Vec3::ZERO);
}
