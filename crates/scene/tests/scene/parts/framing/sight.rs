use glam::Vec3;
use lightmesh_scene::Mesh;
use lightmesh_scene::internals::framing::{Seen, Sight, distance};

/// Triangles of different sizes and directions in no order.
fn soup(count: usize) -> Mesh {
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut point = |size: f32| size * Vec3::new(random(), random(), random());
    let mut mesh = Mesh::default();
    for index in 0..count as u32 {
        let center = point(10.0);
        mesh.positions.extend((0..3).map(|_| center + point(2.0)));
        mesh.triangles.push([3 * index, 3 * index + 1, 3 * index + 2]);
    }
    mesh
}

#[test]
fn the_tree_finds_what_all_triangles_say() {
    let mut hits = 0;
    for count in [0, 1, 5, 333] {
        let mesh = soup(count);
        let sight = Sight::new(&mesh);
        for step in 0..400 {
            let turn = 0.37 * step as f32;
            let origin = Vec3::new(4.0 * turn.sin(), 3.0 * (2.0 * turn).cos(), 0.01 * step as f32);
            let direction = [Vec3::X, Vec3::NEG_Y, Vec3::new(turn.cos(), 0.3, turn.sin())][step % 3];
            let all = (0..count).map(|index| distance(mesh.corners(index), origin, direction));
            let nearest = all.fold(f32::INFINITY, f32::min);
            let found = sight.first(origin, direction).map_or(f32::INFINITY, |seen| seen.distance);
            assert_eq!(found, nearest, "{count} triangles, ray {step}");
            hits += usize::from(found.is_finite());
        }
    }
    assert!((100..1500).contains(&hits), "{hits}");
}

#[test]
fn a_wall_has_a_front_which_vertex_normals_may_turn() {
    let mut mesh =
        Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let from = Vec3::new(0.2, 0.2, 3.0);
    let sight = Sight::new(&mesh);
    assert_eq!(sight.first(from, Vec3::NEG_Z), Some(Seen { distance: 3.0, triangle: 0 }));
    assert_eq!((sight.free(from, Vec3::NEG_Z, 2.0), sight.free(from, Vec3::Z, 2.0)), (2.0, 2.0));
    assert!(sight.is_free(from, from - 2.0 * Vec3::Z) && !sight.is_free(from, from - 4.0 * Vec3::Z));
    assert_eq!(sight.normal(0), Vec3::Z);
    mesh.normals = vec![Vec3::NEG_Z; 3];
    assert_eq!(Sight::new(&mesh).normal(0), Vec3::NEG_Z);
}
