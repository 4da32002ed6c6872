//! Shapes that a program places in a mesh.

use glam::{DMat4, DVec3, Vec3};
use lightmesh_scene::{FIRST_INSTANCED, Geometry, GeometryError, Material, Mesh};

fn triangle() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: vec![[0, 1, 2]],
        materials: vec![0],
        ..Mesh::default()
    }
}

fn at(x: f64) -> DMat4 {
    DMat4::from_translation(DVec3::new(x, 0.0, 0.0))
}

#[test]
fn shapes_are_placed_behind_what_a_mesh_has() {
    let mut mesh = triangle();
    mesh.add_instances(&triangle(), &[], "none").unwrap();
    assert_eq!((mesh.triangles.len(), mesh.triangle_count()), (1, 1));
    mesh.add_instances(&triangle(), &[at(2.0), at(5.0)], "two").unwrap();
    mesh.add_instances(&triangle(), &[DMat4::from_scale(DVec3::new(-1.0, 3.0, 1.0))], "mirrored").unwrap();
    // Of the last one, there is also a mirrored copy.
    assert_eq!((mesh.triangles.len(), mesh.triangle_count(), mesh.own_triangles().count()), (4, 4, 1));
    let bounds = mesh.bounds();
    assert_eq!((bounds.min, bounds.max), (Vec3::new(-1.0, 0.0, 0.0), Vec3::new(6.0, 3.0, 0.0)));
    let names: Vec<&str> = (0..3).map(|k| mesh.objects.name(mesh.object_of(FIRST_INSTANCED + k))).collect();
    assert_eq!(names, ["two", "two", "mirrored"]);
    let flat = mesh.flattened().unwrap();
    let last = [Vec3::ZERO, Vec3::new(0.0, 3.0, 0.0), Vec3::new(-1.0, 0.0, 0.0)];
    assert_eq!((flat.corners(2)[1], flat.corners(3)), (Vec3::new(6.0, 0.0, 0.0), last));
    let geometry = Geometry { mesh, materials: vec![Material::default()], ..Geometry::default() };
    assert_eq!(geometry.check(), Ok(()));
}

#[test]
fn what_cannot_be_placed_is_refused() {
    let mut mesh = triangle();
    let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    for place in [flat, DMat4::from_scale(DVec3::splat(1e7)), DMat4::NAN, at(f64::INFINITY)] {
        let refused = mesh.add_instances(&triangle(), &[at(1.0), place], "shape");
        assert_eq!(refused, Err(GeometryError::Place { place: 1 }), "{place}");
    }
    mesh.add_instances(&triangle(), &[at(1.0)], "shape").unwrap();
    mesh.triangles.push([0, 1, 2]);
    mesh.materials.push(0);
    assert_eq!(mesh.add_instances(&triangle(), &[at(1.0)], "shape"), Err(GeometryError::ShapesNotLast));
    mesh.triangles.clear();
    mesh.materials.clear();
    let geometry = Geometry { mesh, materials: vec![Material::default()], ..Geometry::default() };
    assert_eq!(geometry.check(), Err(GeometryError::ShapesNotLast));
}
