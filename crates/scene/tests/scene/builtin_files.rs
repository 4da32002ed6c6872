//! Built-in scenes written as files show the same.

use glam::Vec3;
use lightmesh_scene::Scene;

/// Object, material and corners of each triangle, in the order of the first two: an export has the triangles of each material together.
pub(crate) fn triangles(scene: &Scene) -> Vec<(String, u32, [Vec3; 3])> {
    let mesh = &scene.geometry.mesh;
    let name = |triangle: usize| mesh.objects.name(mesh.objects.of(triangle as u32)).to_owned();
    let triangle = |it: usize| (name(it), mesh.materials[it], mesh.corners(it));
    let mut all: Vec<_> = (0..mesh.triangles.len()).map(triangle).collect();
    all.sort_by(|one, other| (&one.0, one.1).cmp(&(&other.0, other.1)));
    all
}

#[test]
fn a_built_in_scene_survives_being_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    for builtin in ["builtin:gazebo", "builtin:childpark?lights=3"] {
        let scene = Scene::open(builtin).unwrap();
        for name in ["copy.glb", "copy.toml"] {
            let path = folder.path().join(name);
            scene.export(&path).unwrap();
            let copy = Scene::open(&path).unwrap_or_else(|error| panic!("{builtin}: {error}"));
            assert!(triangles(&copy) == triangles(&scene), "{builtin}, {name}");
            assert_eq!(
                (&copy.geometry.materials, &copy.lights),
                (&scene.geometry.materials, &scene.lights),
                "{builtin}, {name}"
            );
            assert_eq!(
                (copy.lights.ambient, copy.lights.background),
                (scene.lights.ambient, scene.lights.background),
                "{builtin}, {name}"
            );
            // The copy's `up` stands at a right angle to the view; the image's axes are the same.
            for (copy, camera) in copy.cameras.iter().zip(&scene.cameras) {
                assert_eq!(
                    (copy.position, copy.direction, copy.projection),
                    (camera.position, camera.direction, camera.projection)
                );
                assert!(copy.basis().1.distance(camera.basis().1) < 1e-6, "{builtin}, {name}");
            }
            assert_eq!(copy.cameras.len(), scene.cameras.len(), "{builtin}, {name}");
        }
    }
}
