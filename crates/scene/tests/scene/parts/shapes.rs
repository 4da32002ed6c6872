use std::f64::consts::PI;

use glam::DVec3;
use lightmesh_scene::internals::shapes::{Shape, tangents};

/// Six times the signed volume, and whether every directed edge meets its opposite exactly once.
fn volume_and_closed(shape: &Shape) -> (f64, bool) {
    use std::collections::HashSet;
    // Vertices are distinguished by position, as caps have their own.
    let key = |v: u32| shape.positions[v as usize].to_array().map(|x| (x * 1e9).round() as i64);
    let mut edges = HashSet::new();
    let mut volume = 0.0;
    for &[a, b, c] in &shape.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert!(edges.insert((key(from), key(to))), "an edge is used twice the same way");
        }
        let [a, b, c] = [a, b, c].map(|v| shape.positions[v as usize]);
        volume += a.dot(b.cross(c)) / 6.0;
    }
    (volume, edges.iter().all(|&(from, to)| edges.contains(&(to, from))))
}

#[test]
fn a_box_has_its_volume_outside_out() {
    let (volume, closed) = volume_and_closed(&Shape::cuboid(DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 4.0, 6.0)));
    assert!(closed);
    assert!((volume - 6.0).abs() < 1e-12);
}

#[test]
fn a_sphere_is_closed_and_its_vertices_lie_on_it() {
    let center = DVec3::new(3.0, -1.0, 2.0);
    let shape = Shape::sphere(center, 2.0, 96);
    let (volume, closed) = volume_and_closed(&shape);
    assert!(closed);
    assert!((volume / (4.0 / 3.0 * PI * 8.0) - 1.0).abs() < 2e-3, "{volume}");
    for (position, normal) in shape.positions.iter().zip(&shape.normals) {
        assert!((position.distance(center) - 2.0).abs() < 1e-12);
        assert!(((*position - center) / 2.0 - normal.as_dvec3()).length() < 1e-7);
    }
}

#[test]
fn a_cylinder_is_closed_by_its_caps_only() {
    let [base, top] = [DVec3::new(1.0, 0.0, 2.0), DVec3::new(1.0, 3.0, 6.0)];
    let (volume, closed) = volume_and_closed(&Shape::cylinder(base, top, 0.5, 96, true));
    assert!(closed);
    assert!((volume / (PI * 0.25 * 5.0) - 1.0).abs() < 1e-3, "{volume}");
    assert!(!volume_and_closed(&Shape::cylinder(base, top, 0.5, 96, false)).1);
}

#[test]
fn the_smallest_solids_are_closed_too() {
    assert!(volume_and_closed(&Shape::sphere(DVec3::ZERO, 1.0, 3)).1);
    assert!(volume_and_closed(&Shape::cylinder(DVec3::Y, DVec3::NEG_Y, 1.0, 3, true)).1);
}

/// Signed area in the image: positive if the image is not mirrored seen from outside. v points downwards.
fn covered(shape: &Shape) -> Vec<f32> {
    shape.corners.iter().map(|[a, b, c]| -0.5 * (*b - *a).perp_dot(*c - *a)).collect()
}

#[test]
fn a_picture_covers_every_face_once_and_is_not_mirrored() {
    let solids = [
        (Shape::rectangle(DVec3::ZERO, DVec3::X, DVec3::Y), 1.0),
        (Shape::cuboid(DVec3::ZERO, DVec3::ONE), 6.0),
        (Shape::sphere(DVec3::ZERO, 1.0, 12), 1.0 - 1.0 / 6.0),
        (Shape::cylinder(DVec3::ZERO, DVec3::Y, 1.0, 96, false), 1.0),
        (Shape::cylinder(DVec3::ZERO, DVec3::Y, 1.0, 96, true), 1.0 + 2.0 * 0.25 * std::f32::consts::PI),
    ];
    for (shape, area) in solids {
        let covered = covered(&shape);
        assert!(covered.iter().all(|&area| area > 0.0), "{covered:?}");
        let sum: f32 = covered.iter().sum();
        assert!((sum - area).abs() < 2e-3, "{sum} of {area}");
    }
}

#[test]
fn textured_solids_keep_their_triangles() {
    for shape in [Shape::sphere(DVec3::ONE, 2.0, 7), Shape::cuboid(DVec3::ZERO, DVec3::ONE)] {
        let textured = shape.clone().textured();
        assert_eq!(textured.triangles.len(), shape.triangles.len());
        for (index, (a, b)) in shape.triangles.iter().zip(&textured.triangles).enumerate() {
            for corner in 0..3 {
                let (a, b) = (a[corner] as usize, b[corner] as usize);
                assert_eq!(shape.positions[a], textured.positions[b]);
                assert_eq!(shape.normals.get(a), textured.normals.get(b));
                assert_eq!(textured.uvs[b], shape.corners[index][corner]);
            }
        }
    }
    // A seam from pole to pole.
    let (plain, textured) = (Shape::sphere(DVec3::ZERO, 1.0, 8), Shape::sphere(DVec3::ZERO, 1.0, 8).textured());
    assert_eq!(textured.positions.len() - plain.positions.len(), 3 + 2 * 7);
}

#[test]
fn pictures_stand_upright() {
    // The middle of the upper edge of the image on each side of a box that is 2 wide.
    let shape = Shape::cuboid(DVec3::splat(-1.0), DVec3::ONE).textured();
    for face in [0, 1, 4, 5] {
        for &vertex in shape.triangles[2 * face..][..2].iter().flatten() {
            let (position, uv) = (shape.positions[vertex as usize], shape.uvs[vertex as usize]);
            assert_eq!(f64::from(uv.y), 0.5 - 0.5 * position.y, "face {face}");
        }
    }
}

#[test]
fn normals_of_a_cylinder_agree_with_its_triangles() {
    let shape = Shape::cylinder(DVec3::ZERO, DVec3::new(1.0, -2.0, 0.5), 1.0, 8, true);
    for triangle in &shape.triangles {
        let [a, b, c] = triangle.map(|v| shape.positions[v as usize]);
        let face = (b - a).cross(c - a).normalize();
        assert!(triangle.iter().all(|&v| face.dot(shape.normals[v as usize].as_dvec3()) > 0.9));
    }
}

#[test]
fn a_rectangle_faces_along_the_cross_of_its_edges() {
    for normal in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::Z, DVec3::new(1.0, 2.0, -1.0).normalize()] {
        let (u, v) = tangents(normal);
        assert!((u.cross(v) - normal).length() < 1e-12, "{normal}");
        let shape = Shape::rectangle(DVec3::ONE, 2.0 * u, 4.0 * v);
        let [a, b, c] = shape.triangles[0].map(|v| shape.positions[v as usize]);
        assert!(((b - a).cross(c - a) / 8.0 - normal).length() < 1e-12);
    }
}
