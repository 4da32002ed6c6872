use std::f32::consts::FRAC_PI_2;

use glam::Vec2;
use lightmesh_scene::internals::formats::gltf::affine;

/// The example in the extension's text: the lower left quarter of the image, rotated clockwise by a right angle.
#[test]
fn a_quarter_of_a_picture_is_shown_turned() {
    let transform = affine(Vec2::splat(0.5), FRAC_PI_2, Vec2::Y);
    let at = |u, v| transform.transform_point2(Vec2::new(u, v));
    // What was in the lower left corner of the quarter is in its upper left one, as seen on the surface.
    for (surface, picture) in
        [((0.0, 0.0), (0.0, 1.0)), ((1.0, 0.0), (0.0, 0.5)), ((1.0, 1.0), (0.5, 0.5)), ((0.0, 1.0), (0.5, 1.0))]
    {
        let found = at(surface.0, surface.1);
        assert!(found.distance(Vec2::new(picture.0, picture.1)) < 1e-6, "{surface:?}: {found}");
    }
}

#[test]
fn scale_comes_before_offset() {
    let transform = affine(Vec2::new(2.0, -1.0), 0.0, Vec2::Y);
    assert_eq!(transform.transform_point2(Vec2::new(0.25, 0.25)), Vec2::new(0.5, 0.75));
}
