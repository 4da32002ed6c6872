use glam::{DMat4, DVec3, Vec3};
use lightmesh_scene::Positions;
use lightmesh_scene::internals::vertices::Vertices;

#[test]
fn both_precisions_are_placed_in_their_order() {
    let far = DVec3::new(1e7 + 0.5, 0.0, 0.0);
    let mut vertices = Vertices::default();
    vertices.add(Positions::Single(&[Vec3::X]), &DMat4::from_translation(far));
    vertices.add(Positions::Double(&[far]), &DMat4::IDENTITY);
    vertices.add(Positions::Double(&[DVec3::Y]), &DMat4::from_translation(far));
    vertices.add(Positions::Single(&[Vec3::ZERO, Vec3::Z]), &DMat4::from_translation(far));
    assert_eq!(vertices.count(), 5);
    assert_eq!(vertices.bounds(), Some((far, far + DVec3::ONE)));
    assert_eq!(vertices.finish(far), [Vec3::X, Vec3::ZERO, Vec3::Y, Vec3::ZERO, Vec3::Z]);
}

#[test]
fn what_is_not_finite_has_no_part_in_the_box() {
    let mut vertices = Vertices::default();
    vertices.add(Positions::Single(&[Vec3::NAN]), &DMat4::IDENTITY);
    assert_eq!(vertices.bounds(), None);
    vertices.add(Positions::Single(&[Vec3::X, Vec3::INFINITY]), &DMat4::IDENTITY);
    assert_eq!(vertices.bounds(), Some((DVec3::X, DVec3::X)));
}
