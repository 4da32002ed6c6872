use glam::{DMat4, DVec3, Vec3};
use lightmesh_scene::internals::builder::take;
use lightmesh_scene::internals::loaded_mesh::LoadedMesh;
use lightmesh_scene::{GeometryError, MeshPart, Objects, Position, SceneBuilder};

const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

fn part() -> MeshPart<'static> {
    MeshPart { positions: &CORNERS, triangles: &[[0, 1, 2]], ..Default::default() }
}

#[test]
fn a_scene_at_home_keeps_its_coordinates() {
    let mut builder = SceneBuilder::new();
    builder.add(part(), &DMat4::IDENTITY, |_| 0).unwrap();
    let (origin, mesh) = builder.finish();
    assert_eq!(origin, DVec3::ZERO);
    assert_eq!(mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn a_scene_far_away_keeps_its_shape() {
    let offset = DVec3::new(1e6 + 0.125, -3e5, 7e4);
    let mut builder = SceneBuilder::new();
    builder.add(part(), &DMat4::from_translation(offset), |_| 0).unwrap();
    let (origin, mesh) = builder.finish();
    let [a, b, c] = mesh.corners(0);
    assert!((b - a - Vec3::X).length() < 1e-6 && (c - a - Vec3::Y).length() < 1e-6);
    assert!((origin + a.as_dvec3() - offset).length() < 1e-6);
}

#[test]
fn a_map_that_is_not_affine_is_refused() {
    let moved = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
    let refused = Err(GeometryError::NotAffine { place: 0, row: "1, 2, 3, 1".to_owned() });
    let mut builder = SceneBuilder::new();
    assert_eq!(builder.add(part(), &moved.transpose(), |_| 0), refused);
    assert_eq!(builder.add_instances(part(), &[moved.transpose(), moved], "name", |_| 0), refused);
    assert!(builder.add(part(), &DMat4::from_scale(DVec3::ONE).mul_scalar(2.0), |_| 0).is_err());
    // What products and inverses round is no mistake.
    let turned = moved * DMat4::from_rotation_y(0.3) * DMat4::from_scale(DVec3::new(3.0, 0.1, 7.0));
    builder.add(part(), &turned.inverse().inverse(), |_| 0).unwrap();
    assert_eq!(builder.finish().1.triangles.len(), 1);
}

#[test]
fn a_mirror_keeps_the_front_in_front() {
    let mut builder = SceneBuilder::new();
    builder.add(part(), &DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)), |_| 0).unwrap();
    let [a, b, c] = builder.finish().1.corners(0);
    assert!((b - a).cross(c - a).z > 0.0);
}

#[test]
fn a_mesh_handed_over_is_the_same_as_a_part_added() {
    fn check<P: Position>(positions: [P; 3], placement: DMat4) {
        let loaded = || LoadedMesh {
            positions: positions.to_vec(),
            normals: vec![Vec3::new(1.0, 2.0, 3.0); 3],
            uvs: Vec::new(),
            colors: vec![Vec3::X; 3],
            triangles: vec![[0, 1, 2]],
            materials: vec![7],
            groups: Vec::new(),
            objects: Objects::default(),
        };
        let (mut added, mut taken) = (SceneBuilder::new(), SceneBuilder::new());
        // The first is moved in, the second is appended as a copy.
        for _ in 0..2 {
            added.add(loaded().part(), &placement, |_| 7).unwrap();
            take(&mut taken, loaded(), &placement);
        }
        assert_eq!(added.bounds(), taken.bounds());
        let (added, taken) = (added.finish().1, taken.finish().1);
        assert_eq!((added.positions, added.normals), (taken.positions, taken.normals));
        assert_eq!((added.triangles, added.materials), (taken.triangles, taken.materials));
        assert_eq!((added.colors, added.uvs), (taken.colors, taken.uvs));
    }
    let mirrored = DMat4::from_scale(DVec3::new(-2.0, 3.0, 1.0)) * DMat4::from_rotation_x(1.0);
    for placement in [DMat4::IDENTITY, mirrored] {
        check(CORNERS, placement);
        check(CORNERS.map(|corner| corner.as_vec3()), placement);
    }
}

#[test]
fn parts_without_normals_stand_beside_parts_with() {
    let mut builder = SceneBuilder::new();
    builder.add(part(), &DMat4::IDENTITY, |_| 0).unwrap();
    builder.add(MeshPart { normals: &[Vec3::Z; 3], ..part() }, &DMat4::IDENTITY, |_| 1).unwrap();
    builder.add(part(), &DMat4::IDENTITY, |_| 2).unwrap();
    let mesh = builder.finish().1;
    assert_eq!(mesh.normals.len(), 9);
    assert_eq!((mesh.normals[0], mesh.normals[3], mesh.normals[8]), (Vec3::ZERO, Vec3::Z, Vec3::ZERO));
    assert_eq!(mesh.materials, [0, 1, 2]);
}
