use std::path::Path;

use glam::{DMat4, DVec3, Vec3};
use lightmesh_scene::internals::draft::Draft;
use lightmesh_scene::{LoadOptions, MeshPart};

#[test]
fn triangles_without_a_place_are_left_out_and_counted() {
    let positions = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(f64::NAN, 0.0, 0.0), DVec3::splat(1e300)];
    let triangles = [[0, 1, 3], [0, 1, 2], [2, 1, 4]];
    let part = MeshPart { positions: &positions, triangles: &triangles, ..Default::default() };
    let mut draft = Draft::new(Path::new("scene.obj"), &LoadOptions::default());
    draft.add(part, &DMat4::IDENTITY, |index| index as u32).unwrap();
    let scene = draft.finish().unwrap();
    assert_eq!(scene.geometry.mesh.triangles, [[0, 1, 2]]);
    assert_eq!(scene.geometry.mesh.materials, [1]);
    assert_eq!(scene.geometry.mesh.corners(0), [Vec3::X, Vec3::Y, Vec3::Z]);
    assert!(scene.warnings[0].starts_with("2 triangles"), "{:?}", scene.warnings);
}

#[test]
fn strict_reading_ends_at_a_warning() {
    let strict = LoadOptions::default().with_strict(true);
    let message = Draft::new(Path::new("a.obj"), &strict).finish().unwrap_err().to_string();
    assert_eq!(message, "the scene has no triangles, a.obj; fix this, or load the scene without strict checks");
}
