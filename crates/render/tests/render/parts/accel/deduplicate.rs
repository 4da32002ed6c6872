use glam::Vec3;
use lightmesh_render::accel::Triangle;
use lightmesh_render::internals::accel::deduplicate;

fn triangle(size: f32, index: u32) -> Triangle {
    Triangle::new([Vec3::ZERO, size * Vec3::X, size * Vec3::Y], index)
}

#[test]
fn one_of_identical_triangles_is_held() {
    let triangles = [triangle(1.0, 4), triangle(2.0, 3), triangle(1.0, 2), triangle(0.0, 1), triangle(2.0, 5)];
    assert_eq!(deduplicate(&triangles), [1, 2]);
    let mut cut = triangles.map(|triangle| triangle.alpha_tested(u32::from(triangle.index() != 3)));
    assert_eq!(deduplicate(&cut), [0, 1, 2, 4], "what is cut out may differ");
    cut[0] = triangle(1.0, 4);
    assert_eq!(deduplicate(&cut), [0, 1, 2, 4]);
    let turned = [Vec3::X, Vec3::Y, Vec3::ZERO];
    assert_eq!(deduplicate(&[triangle(1.0, 0), Triangle::new(turned, 1)]), [0, 1], "other corners come first");
}
