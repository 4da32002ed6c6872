use glam::{DVec3, Vec3};
use lightmesh_scene::Objects;
use lightmesh_scene::internals::loaded_mesh::LoadedMesh;

#[test]
fn vertices_without_a_triangle_are_dropped() {
    let mut mesh = LoadedMesh {
        normals: Vec::new(),
        uvs: Vec::new(),
        materials: vec![0; 2],
        groups: Vec::new(),
        objects: Objects::default(),
        positions: (0..6).map(|x| DVec3::splat(f64::from(x))).collect(),
        colors: (0..6).map(|x| Vec3::splat(x as f32)).collect(),
        triangles: vec![[5, 1, 3], [1, 3, 4]],
    };
    let corners =
        |mesh: &LoadedMesh<DVec3>| mesh.triangles.iter().flatten().map(|&v| mesh.positions[v as usize]).collect();
    let before: Vec<DVec3> = corners(&mesh);
    mesh.drop_unused_vertices();
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(corners(&mesh), before);
    assert!(mesh.colors.iter().zip(&mesh.positions).all(|(color, position)| color.as_dvec3() == *position));
    assert!(mesh.normals.is_empty());
}
