use glam::{Vec2, Vec3};
use lightmesh_scene::{Material, SceneBuilder, Up};

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
