use glam::Vec3;
use lightmesh_render::accel::triangle::RayShear;
use lightmesh_render::accel::{ShortTest, Triangle};

const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

fn intersect(origin: Vec3, direction: Vec3) -> Option<(f32, f32, f32)> {
    RayShear::new(origin, direction).intersect(&Triangle::new(TRIANGLE, 0))
}

#[test]
fn a_hit_has_its_distance_and_barycentric_weights() {
    let (t, u, v) = intersect(Vec3::new(0.25, 0.5, 3.0), Vec3::new(0.0, 0.0, -2.0)).unwrap();
    assert_eq!((t, u, v), (1.5, 0.25, 0.5));
}

#[test]
fn both_sides_and_all_borders_count() {
    for direction in [Vec3::NEG_Z, Vec3::Z] {
        for point in [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.5, 0.5, 0.0), Vec3::new(0.3, 0.0, 0.0)] {
            let hit = intersect(point - direction, direction);
            assert_eq!(hit.map(|hit| hit.0), Some(1.0), "{point} along {direction}");
        }
    }
}

#[test]
fn rays_beside_or_in_the_plane_miss() {
    let outside = Vec3::new(0.6, 0.6, 1.0);
    assert!(intersect(outside, Vec3::NEG_Z).is_none());
    assert!(intersect(Vec3::new(-1.0, 0.2, 0.0), Vec3::X).is_none());
}

#[test]
fn the_short_test_blocks_what_lies_between() {
    let test = ShortTest { origin: Vec3::new(0.25, 0.25, -1.0), normal: Vec3::Z, edge_on: 1e-4 };
    let occluder = test.occluder(TRIANGLE).unwrap();
    assert!(occluder.blocks(Vec3::new(0.0, 0.0, 1.5)));
    assert!(!occluder.blocks(Vec3::new(0.0, 0.0, 0.9)), "ends before the triangle");
    assert!(!occluder.blocks(Vec3::new(1.5, 0.0, 1.5)), "passes next to it");
    assert!(!occluder.blocks(Vec3::new(0.0, 0.0, -1.5)), "points away");
    let turned = test.occluder([TRIANGLE[0], TRIANGLE[2], TRIANGLE[1]]).unwrap();
    assert!(turned.blocks(Vec3::new(0.0, 0.0, 1.5)), "the back side blocks too");
}

#[test]
fn the_short_test_drops_what_cannot_block() {
    let behind = ShortTest { origin: Vec3::new(0.25, 0.25, 1e-3), normal: Vec3::Z, edge_on: 1e-4 };
    assert!(behind.occluder(TRIANGLE).is_none());
    let edge_on = ShortTest { origin: Vec3::new(-1.0, 0.25, 1e-5), normal: Vec3::X, edge_on: 1e-4 };
    assert!(edge_on.occluder(TRIANGLE).is_none());
}
