use glam::{DMat4, DVec3, Vec2, Vec3};
use lightmesh_scene::internals::geometry_check::first_beyond;
use lightmesh_scene::{Geometry, GeometryError, Material, Mesh, MeshPart, SceneBuilder};

const CORNERS: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];

fn geometry() -> Geometry {
    let mesh = Mesh {
        positions: CORNERS.map(|corner| corner.as_vec3()).to_vec(),
        triangles: vec![[0, 1, 2], [1, 2, 3]],
        materials: vec![0, 1],
        ..Mesh::default()
    };
    Geometry { mesh, materials: vec![Material::default(); 2], ..Geometry::default() }
}

fn message(change: impl FnOnce(&mut Geometry)) -> String {
    let mut geometry = geometry();
    assert_eq!(geometry.check(), Ok(()));
    change(&mut geometry);
    geometry.check().unwrap_err().to_string()
}

#[test]
fn indices_that_lead_nowhere_are_named() {
    let vertex = message(|geometry| geometry.mesh.triangles[1][2] = 99);
    assert_eq!(vertex, "triangle 1 has the vertex index 99, but there are 4 vertices: indices count from 0");
    assert!(message(|geometry| geometry.mesh.triangles[0][0] = 4).contains("triangle 0 has the vertex index 4"));
    assert!(message(|geometry| geometry.mesh.materials[1] = 2).contains("triangle 1 has the material 2"));
    assert!(message(|geometry| geometry.materials.clear()).contains("there are 0 materials"));
    let bright = Material::default().with_ks([0.5, 1.25, 0.5]).named("lamp");
    assert!(
        message(|geometry| geometry.materials[1] = bright)
            .contains("material 1 (`lamp`) has a specular coefficient of 1.25")
    );
}

#[test]
fn lengths_that_do_not_fit_are_named() {
    let normals = message(|geometry| geometry.mesh.normals = vec![Vec3::X; 3]);
    assert_eq!(normals, "there are 3 normals for 4 vertices: give one per vertex, or none at all");
    assert!(message(|geometry| geometry.mesh.uvs = vec![Vec2::X; 5]).contains("5 uvs for 4"));
    assert!(message(|geometry| geometry.mesh.colors = vec![Vec3::X]).contains("1 colors for 4"));
    assert!(message(|geometry| geometry.mesh.opacities = vec![0.5; 3]).contains("3 opacities for 4"));
    assert!(message(|geometry| geometry.mesh.materials.truncate(1)).contains("1 material indices for 2"));
}

#[test]
fn the_first_of_many_is_found() {
    let mut indices = vec![7; 100_000];
    assert_eq!(first_beyond(&indices, 8), None);
    for place in [99_999, 70_000, 16_384, 16_383, 0] {
        indices[place] = 8;
        assert_eq!(first_beyond(&indices, 8), Some(place));
    }
    assert_eq!((first_beyond(&[], 0), first_beyond(&[u32::MAX], u32::MAX as usize)), (None, Some(0)));
}

#[test]
fn a_part_that_does_not_hold_together_is_not_added() {
    let mut builder = SceneBuilder::new();
    let good = MeshPart { positions: &CORNERS, triangles: &[[0, 1, 3]], ..Default::default() };
    builder.add(good, &DMat4::IDENTITY, |_| 0).unwrap();
    let beyond = MeshPart { triangles: &[[0, 1, 2], [0, 99, 1]], ..good };
    let error = builder.add(beyond, &DMat4::IDENTITY, |_| 0).unwrap_err();
    assert_eq!(error, GeometryError::Vertex { triangle: 1, index: 99, vertices: 4 });
    let short = MeshPart { colors: &[Vec3::ONE; 3], ..good };
    assert!(matches!(builder.add(short, &DMat4::IDENTITY, |_| 0), Err(GeometryError::Attribute { .. })));
    assert_eq!((builder.triangle_count(), builder.vertex_count()), (1, 4));
    assert_eq!(builder.finish_scene("one").geometry.check(), Ok(()));
}
