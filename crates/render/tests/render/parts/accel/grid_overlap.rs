use glam::{DVec3, Vec3};
use lightmesh_render::internals::accel::triangle_meets_box;

fn meets(corners: [[f32; 3]; 3]) -> bool {
    triangle_meets_box(corners.map(Vec3::from), DVec3::ZERO, DVec3::ONE)
}

#[test]
fn each_kind_of_axis_separates() {
    assert!(!meets([[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 1.0, 0.0]]), "box axis");
    assert!(!meets([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]]), "normal");
    assert!(!meets([[2.2, 0.0, 0.0], [0.0, 2.2, 0.0], [2.2, 2.2, 0.5]]), "edge");
    assert!(meets([[2.9, 0.0, 0.0], [0.0, 2.9, 0.0], [0.0, 0.0, 2.9]]), "cuts off a corner");
    assert!(meets([[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]]), "no corner inside");
    assert!(meets([[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]), "touches");
}
