//! Built-in scenes written as files show the same.

use lightmesh_scene::Scene;

#[test]
fn a_built_in_scene_survives_being_written_and_read() {
    let folder = tempfile::tempdir().unwrap();
    for builtin in ["builtin:gazebo", "builtin:childpark?lights=3"] {
        let scene = Scene::open(builtin).unwrap();
        for name in ["copy.glb", "copy.toml"] {
            let path = folder.path().join(name);
            scene.export(&path).unwrap();
            let copy = Scene::open(&path).unwrap_or_else(|error| panic!("{builtin}: {error}"));
            let corners = |scene: &Scene| {
                (0..scene.geometry.mesh.triangles.len())
                    .map(|index| scene.geometry.mesh.corners(index))
                    .collect::<Vec<_>>()
            };
            assert!(corners(&copy) == corners(&scene), "{builtin}, {name}");
            assert_eq!(copy.geometry.mesh.materials, scene.geometry.mesh.materials, "{builtin}, {name}");
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
