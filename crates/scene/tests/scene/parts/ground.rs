use glam::{DMat4, Vec2, Vec3};
use lightmesh_scene::{Material, Mesh, Scene, SceneBuilder, Up};

#[test]
fn the_ground_is_below_the_scene_and_faces_up() {
    for up in [Up::Y, Up::Z] {
        let mut scene = SceneBuilder::new().finish_scene("test");
        let mesh = &mut scene.geometry_mut().mesh;
        mesh.positions = vec![Vec3::new(1.0, 2.0, 3.0), Vec3::new(2.0, 4.0, 4.0), Vec3::new(1.0, 2.0, 4.0)];
        (mesh.triangles, mesh.materials) = (vec![[0, 1, 2]], vec![0]);
        mesh.normals = vec![Vec3::X; 3];
        (mesh.uvs, mesh.colors, mesh.opacities) = (vec![Vec2::X; 3], vec![Vec3::X; 3], vec![0.5; 3]);
        scene.geometry_mut().materials.push(Material::default());
        let lowest = scene.geometry.mesh.bounds().min.dot(up.axis());
        scene.add_ground(up);
        let mesh = &scene.geometry.mesh;
        assert_eq!((mesh.triangles.len(), mesh.materials.len(), mesh.normals.len()), (3, 3, 7));
        assert_eq!(scene.geometry.check(), Ok(()));
        assert!(scene.geometry.materials[mesh.materials[2] as usize].catcher && scene.lights.ambient.is_some());
        for triangle in &mesh.triangles[1..] {
            let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            assert!((b - a).cross(c - a).normalize().distance(up.axis()) < 1e-5, "{up:?}");
            assert!([a, b, c].iter().all(|corner| corner.dot(up.axis()) < lowest), "{up:?}");
        }
    }
}

#[test]
fn an_empty_scene_gets_none() {
    let mut scene = SceneBuilder::new().finish_scene("empty");
    scene.add_ground(Up::Y);
    assert!(scene.geometry.mesh.triangles.is_empty());
}

/// A triangle of its own, and one that is stored once for some places.
fn with_shapes(places: &[DMat4], has_normals: bool) -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("shapes");
    let triangle = |size: f32| Mesh {
        positions: vec![Vec3::ZERO, size * Vec3::X, size * (Vec3::Y + Vec3::Z)],
        normals: if has_normals { vec![Vec3::X; 3] } else { Vec::new() },
        triangles: vec![[0, 1, 2]],
        materials: vec![0],
        ..Mesh::default()
    };
    let geometry = scene.geometry_mut();
    geometry.materials.push(Material::default());
    geometry.mesh = triangle(1.0);
    geometry.mesh.add_instances(&triangle(2.0), places, "shape").unwrap();
    scene
}

#[test]
fn shapes_that_are_stored_once_get_the_same_ground() {
    let places = [[3.0, -2.0, 0.5], [-1.0, 4.0, 7.0]].map(|place| DMat4::from_translation(place.into()));
    for (up, has_normals) in [(Up::Y, false), (Up::Z, true)] {
        let mut scene = with_shapes(&places, has_normals);
        let mut flat = scene.clone();
        flat.geometry_mut().mesh = scene.geometry.mesh.flattened().unwrap();
        for scene in [&mut scene, &mut flat] {
            scene.add_ground(up);
            assert_eq!(scene.geometry.check(), Ok(()));
        }
        let (mesh, copied) = (&scene.geometry.mesh, &flat.geometry.mesh);
        let of_ground = |mesh: &Mesh| mesh.flattened().unwrap().positions.into_iter().rev().take(4).collect::<Vec<_>>();
        assert_eq!((of_ground(mesh), mesh.bounds()), (of_ground(copied), copied.bounds()));
        assert_eq!(mesh.flattened().unwrap().triangles, copied.triangles);
        assert_eq!(scene.geometry.materials, flat.geometry.materials);
        assert_eq!(mesh.objects.name(mesh.instances.list().last().unwrap().object), "ground");
        // Nothing of the model is copied or moved.
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3 + 3 + 4, 1 + 1 + 2));
    }
}
