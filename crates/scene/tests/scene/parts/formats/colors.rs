use glam::Vec3;
use lightmesh_scene::internals::formats::colors::linear;

#[test]
fn middle_grey_is_a_fifth_of_the_light() {
    let grey = linear(Vec3::splat(0.5));
    assert!((grey - 0.214_041).abs().max_element() < 1e-6, "{grey}");
    assert_eq!(linear(Vec3::new(2.0, -1.0, f32::NAN)), Vec3::X);
}
