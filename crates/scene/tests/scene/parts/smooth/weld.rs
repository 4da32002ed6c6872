use glam::{DVec3, Vec3};
use lightmesh_scene::internals::smooth::weld;

#[test]
fn equal_positions_are_the_point_of_the_first() {
    assert_eq!(weld(&[Vec3::X, Vec3::Y, Vec3::X, Vec3::ZERO, Vec3::Y, -Vec3::ZERO]), [0, 1, 0, 3, 1, 3]);
    assert_eq!(weld(&[DVec3::X, DVec3::X + DVec3::splat(f64::EPSILON)]), [0, 1]);
    assert!(weld::<Vec3>(&[]).is_empty());
}
