//! Known answers: cube, cylinder, ball, fold; and hostile meshes.

mod buckets;
mod crease;
mod facets;
mod files;
mod weld;

use std::f64::consts::TAU;

use glam::{DVec3, Vec2, Vec3};
use lightmesh_memory::Budget;
use lightmesh_scene::CreaseAngle;
use lightmesh_scene::internals::loaded_mesh::LoadedMesh;
use lightmesh_scene::internals::smooth::{STEPS, Unsmooth, smooth};

fn mesh(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> LoadedMesh<DVec3> {
    let materials = vec![0; triangles.len()];
    let (normals, uvs, colors, groups) = Default::default();
    LoadedMesh {
        positions,
        normals,
        uvs,
        colors,
        triangles,
        materials,
        groups,
        objects: lightmesh_scene::Objects::default(),
    }
}

/// The same triangles, each with its own vertices.
fn soup(mesh: &LoadedMesh<DVec3>) -> LoadedMesh<DVec3> {
    let positions = mesh.triangles.iter().flatten().map(|&vertex| mesh.positions[vertex as usize]).collect();
    let triangles = (0..mesh.triangles.len() as u32).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]).collect();
    self::mesh(positions, triangles)
}

fn smoothed(mesh: &mut LoadedMesh<DVec3>, degrees: f64) -> usize {
    let crease = CreaseAngle::from_degrees(degrees).unwrap();
    let (corners, materials) = (corners(mesh), mesh.materials.clone());
    let count = smooth(mesh, crease, |position| position.is_finite(), &Budget::default()).unwrap();
    // What rays hit is the same, bit by bit.
    assert_eq!(self::corners(mesh), corners);
    assert_eq!(mesh.materials, materials);
    assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.positions.len());
    let is_unit = |normal: &&Vec3| (normal.length() - 1.0).abs() < 1e-6;
    assert_eq!(mesh.normals.iter().filter(is_unit).count(), count);
    assert_eq!(mesh.normals.iter().filter(|&&normal| normal != Vec3::ZERO).count(), count);
    count
}

/// Bits of the corners of all triangles.
fn corners(mesh: &LoadedMesh<DVec3>) -> Vec<[[u64; 3]; 3]> {
    let at = |vertex: u32| mesh.positions[vertex as usize].to_array().map(f64::to_bits);
    mesh.triangles.iter().map(|triangle| triangle.map(at)).collect()
}

fn normals_of(mesh: &LoadedMesh<DVec3>, triangle: usize) -> [Vec3; 3] {
    mesh.triangles[triangle].map(|vertex| mesh.normals[vertex as usize])
}

/// Two triangles to each quad.
fn cut(quads: &[[u32; 4]]) -> Vec<[u32; 3]> {
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect()
}

fn cube() -> LoadedMesh<DVec3> {
    let bit = |index: u32, bit: u32| f64::from(index >> bit & 1);
    let positions = (0..8).map(|index| DVec3::new(bit(index, 0), bit(index, 1), bit(index, 2))).collect();
    mesh(positions, cut(&[[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]))
}

/// Around Z, from height 0 to 1, with caps: side triangles first. Positions as a file with six decimals has them.
fn cylinder(sides: u32) -> LoadedMesh<DVec3> {
    let rounded = |x: f64| (1e6 * x).round() / 1e6;
    let around = |side: u32| {
        let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
        DVec3::new(rounded(cos), rounded(sin), 0.0)
    };
    let positions = (0..sides).map(around).chain((0..sides).map(|side| around(side) + DVec3::Z)).collect();
    let quads: Vec<[u32; 4]> =
        (0..sides).map(|side| [side, (side + 1) % sides, sides + (side + 1) % sides, sides + side]).collect();
    let mut triangles = cut(&quads);
    triangles.extend((2..sides).flat_map(|side| [[0, side, side - 1], [sides, sides + side - 1, sides + side]]));
    mesh(positions, triangles)
}

/// An icosahedron whose triangles are divided in four, again and again.
fn icosphere(levels: usize) -> LoadedMesh<DVec3> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut positions: Vec<DVec3> = [(0.0, 1.0), (0.0, -1.0)]
        .iter()
        .flat_map(|&(zero, one)| [(one, golden), (one, -golden)].map(|(one, long)| DVec3::new(zero, one, long)))
        .flat_map(|p| [p, DVec3::new(p.z, p.x, p.y), DVec3::new(p.y, p.z, p.x)])
        .map(DVec3::normalize)
        .collect();
    let edge = positions.iter().skip(1).map(|p| p.distance(positions[0])).fold(f64::INFINITY, f64::min);
    let mut triangles = Vec::new();
    for (a, b, c) in (0..12_u32).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c)))) {
        let [p, q, r] = [a, b, c].map(|index| positions[index as usize]);
        if [p.distance(q), q.distance(r), r.distance(p)].iter().all(|length| (length - edge).abs() < 1e-9) {
            triangles.push(if (q - p).cross(r - p).dot(p) > 0.0 { [a, b, c] } else { [a, c, b] });
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..levels {
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let mut middle = |a: u32, b: u32| {
                    // The same bits from both sides.
                    positions.push((positions[a.min(b) as usize] + positions[a.max(b) as usize]).normalize());
                    positions.len() as u32 - 1
                };
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    mesh(positions, triangles)
}

#[test]
fn a_cube_stays_as_it_is() {
    for mut mesh in [cube(), soup(&cube())] {
        let vertices = mesh.positions.len();
        assert_eq!(smoothed(&mut mesh, 30.0), 0);
        assert_eq!((mesh.normals.len(), mesh.positions.len()), (0, vertices));
    }
    assert_eq!(smoothed(&mut cube(), 91.0), 8);
}

#[test]
fn a_turned_cube_with_rounded_corners_coordinates_stays_as_it_is() {
    let turn = glam::DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    let mut cube = cube();
    cube.positions.iter_mut().for_each(|position| *position = (turn * *position + 10.0).as_vec3().as_dvec3());
    assert_eq!(smoothed(&mut cube, 30.0), 0);
}

#[test]
fn a_cylinder_is_round_and_its_caps_are_flat() {
    const SIDES: usize = 24;
    let (shared, apart) = (cylinder(SIDES as u32), soup(&cylinder(SIDES as u32)));
    // The rim is there twice in the end, or was from the beginning.
    let (of_shared, of_apart) = ((4 * SIDES, 2 * SIDES), (apart.positions.len(), 6 * SIDES));
    for (mut mesh, expected) in [(shared, of_shared), (apart, of_apart)] {
        let count = smoothed(&mut mesh, 30.0);
        assert_eq!((mesh.positions.len(), count), expected);
        for triangle in 0..2 * SIDES {
            for (vertex, normal) in mesh.triangles[triangle].iter().zip(normals_of(&mesh, triangle)) {
                let axis = mesh.positions[*vertex as usize].with_z(0.0).normalize();
                assert!(normal.as_dvec3().angle_between(axis) < 0.01_f64.to_radians(), "{normal} at {axis}");
            }
        }
        assert!((2 * SIDES..mesh.triangles.len()).all(|cap| normals_of(&mesh, cap) == [Vec3::ZERO; 3]));
    }
}

#[test]
fn edges_exactly_as_sharp_as_the_crease_angle_are_creases_all_of_them() {
    assert_eq!(smoothed(&mut cylinder(12), 30.0), 0);
    assert!(smoothed(&mut cylinder(12), 30.1) > 0);
}

#[test]
fn a_ball_gets_the_balls_normals() {
    let mut ball = icosphere(3);
    assert_eq!(smoothed(&mut ball, 30.0), ball.positions.len());
    for (normal, position) in ball.normals.iter().zip(&ball.positions) {
        let off = normal.as_dvec3().angle_between(*position).to_degrees();
        assert!(off < 0.7, "{off} degrees at {position}");
    }
    // Coarse, it has edges of 42 degrees.
    assert_eq!(smoothed(&mut icosphere(0), 30.0), 0);
    assert_eq!(smoothed(&mut icosphere(0), 45.0), 12);
}

#[test]
fn how_polygons_are_cut_does_not_turn_normals() {
    // A corner of a cube with one, two and eight triangles to a face.
    let mut corner = mesh(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 0.0)],
        vec![[0, 2, 4], [0, 4, 1], [0, 1, 3], [0, 3, 2]],
    );
    smoothed(&mut corner, 180.0);
    let normal = corner.normals[0];
    assert!(normal.dot(Vec3::ONE.normalize()) < -0.99, "{normal}");
}

#[test]
fn a_fold_is_smooth_or_a_crease() {
    let fold = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        mesh(vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(-cos, 0.0, sin)], vec![[0, 2, 1], [0, 1, 3]])
    };
    let mut sharp = fold(40.0);
    assert_eq!(smoothed(&mut sharp, 30.0), 0);
    let mut smooth = fold(20.0);
    // The outer corners are smooth with nothing, but their triangles are not flat: they have the normals of their planes.
    assert_eq!(smoothed(&mut smooth, 30.0), 4);
    assert_eq!(smooth.normals[2].z.abs(), 1.0);
    assert_eq!(smooth.normals[0], smooth.normals[1]);
    let between = smooth.normals[0].angle_between(smooth.normals[2]).to_degrees();
    assert!((between - 10.0).abs() < 1e-3, "{between}");
    assert_eq!(smoothed(&mut fold(179.0), 180.0), 4);
}

#[test]
fn triangles_that_run_along_an_edge_in_the_same_direction_are_not_smooth() {
    let positions = vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(-1.0, 0.0, 0.2)];
    assert_eq!(smoothed(&mut mesh(positions.clone(), vec![[0, 2, 1], [0, 1, 3]]), 30.0), 4);
    assert_eq!(smoothed(&mut mesh(positions, vec![[0, 2, 1], [0, 3, 1]]), 180.0), 0);
}

#[test]
fn an_edge_of_three_triangles_is_a_crease() {
    let positions =
        vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(-1.0, 0.0, 0.2), DVec3::new(-1.0, 0.0, 0.3), DVec3::Z];
    let mut mesh = mesh(positions, vec![[0, 2, 1], [0, 1, 3], [0, 1, 4]]);
    assert_eq!(smoothed(&mut mesh, 60.0), 0);
}

#[test]
fn copies_of_a_vertex_keep_its_texture_coordinates_and_colour() {
    let mut mesh = cylinder(24);
    mesh.uvs = (0..48).map(|index| Vec2::new(index as f32, 0.5)).collect();
    mesh.colors = (0..48).map(|index| Vec3::splat(index as f32)).collect();
    let before: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    smoothed(&mut mesh, 30.0);
    assert_eq!([mesh.positions.len(), mesh.uvs.len(), mesh.colors.len()], [96; 3]);
    for (&old, &new) in before.iter().zip(mesh.triangles.iter().flatten()) {
        assert_eq!((mesh.uvs[new as usize].x, mesh.colors[new as usize].y), (old as f32, old as f32));
    }
}

#[test]
fn a_seam_of_texture_coordinates_is_no_crease() {
    // The vertices of the seam are there twice, with other coordinates of the texture.
    let mut mesh = icosphere(2);
    let seam = mesh.positions.len() as u32;
    mesh.positions.push(mesh.positions[0]);
    let triangle = mesh.triangles.iter_mut().find(|triangle| triangle.contains(&0)).unwrap();
    triangle.iter_mut().filter(|vertex| **vertex == 0).for_each(|vertex| *vertex = seam);
    smoothed(&mut mesh, 30.0);
    assert_eq!(mesh.normals[0], mesh.normals[seam as usize]);
}

#[test]
fn smoothing_groups_part_what_the_angle_does_not() {
    const SIDES: usize = 24;
    let mut mesh = cylinder(SIDES as u32);
    // One half of the side, the other half, and the caps.
    let half = |triangle: usize| if triangle < SIDES { 1 } else { 2 };
    mesh.groups = (0..mesh.triangles.len()).map(|it| if it < 2 * SIDES { half(it) } else { 0 }).collect();
    smoothed(&mut mesh, 180.0);
    let angle = |a: Vec3, b: Vec3| a.angle_between(b).to_degrees();
    // Where the halves meet, each has the normals of its own last quad; elsewhere two quads share them.
    let [first, second] = [normals_of(&mesh, SIDES - 2), normals_of(&mesh, SIDES)];
    assert!((angle(first[1], second[0]) - 15.0).abs() < 0.01, "{}", angle(first[1], second[0]));
    assert_eq!(normals_of(&mesh, 0)[1], normals_of(&mesh, 2)[0]);
    assert!((2 * SIDES..mesh.triangles.len()).all(|cap| normals_of(&mesh, cap) == [Vec3::ZERO; 3]));
    mesh.groups.fill(0);
    mesh.normals.clear();
    assert_eq!(smoothed(&mut mesh, 180.0), 0);
}

#[test]
fn degenerate_and_unusable_triangles_change_nothing() {
    let mut clean = icosphere(2);
    smoothed(&mut clean, 30.0);
    let mut dirty = icosphere(2);
    let vertices = dirty.positions.len() as u32;
    dirty.positions.extend([DVec3::NAN, DVec3::INFINITY, dirty.positions[1], dirty.positions[1]]);
    let added =
        [[0, 0, 0], [0, 1, 1], [3, 4, vertices], [5, vertices + 1, 6], [1, vertices + 2, vertices + 3], [7, 8, 7]];
    dirty.triangles.extend(added);
    dirty.materials.extend([0; 6]);
    smoothed(&mut dirty, 30.0);
    assert_eq!(dirty.normals[..clean.normals.len()], clean.normals);
    assert_eq!(dirty.triangles[..clean.triangles.len()], clean.triangles);
    assert_eq!(dirty.triangles[clean.triangles.len()..], added);
}

#[test]
fn normals_that_cancel_out_are_none() {
    // Two sides of a sheet that are one surface, with an angle of 180 degrees.
    let sheet = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut mesh = mesh(sheet, vec![[0, 1, 2], [2, 1, 0]]);
    assert_eq!(smoothed(&mut mesh, 180.0), 0);
}

#[test]
fn memory_is_asked_for_first() {
    let refused = |mesh: &mut LoadedMesh<DVec3>| {
        let limit = Budget::new(Some(1 << 20));
        smooth(mesh, CreaseAngle::default(), |_| true, &limit)
    };
    let mut ball = icosphere(6);
    assert!(matches!(refused(&mut ball), Err(Unsmooth::Memory(short)) if short.limit == Some(1 << 20)));
    assert!(ball.normals.is_empty());
}

/// The steps that an input of this many triangles takes, and how many there are.
fn steps(mut mesh: LoadedMesh<DVec3>) -> (f64, f64) {
    STEPS.set(0);
    smoothed(&mut mesh, 30.0);
    (STEPS.get() as f64, mesh.triangles.len() as f64)
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "steps are counted with debug assertions")]
fn hostile_meshes_take_few_steps() {
    const MANY: u32 = 100_000;
    let around = |index: u32, z: f64| {
        let (sin, cos) = (TAU * f64::from(index) / f64::from(MANY)).sin_cos();
        DVec3::new(cos, sin, z)
    };
    let fan = |height: &dyn Fn(u32) -> f64| {
        let rim = (0..MANY).map(|index| around(index, height(index)));
        let positions = std::iter::once(DVec3::ZERO).chain(rim).collect();
        mesh(positions, (1..MANY).map(|index| [0, index, index + 1]).collect())
    };
    let sheets: Vec<[u32; 3]> = (0..MANY).map(|_| [0, 1, 2]).collect();
    let fins: Vec<[u32; 3]> = (0..MANY).map(|index| [0, 1, 2 + index]).collect();
    let zigzag = |index: u32| f64::from(index % 2);
    let shapes: [(&str, LoadedMesh<DVec3>); 7] = [
        ("a cone", fan(&|_| 1.0)),
        ("a fan of creases around one vertex", fan(&zigzag)),
        ("the same without shared vertices", soup(&fan(&zigzag))),
        ("one triangle, again and again", mesh(vec![DVec3::ZERO, DVec3::X, DVec3::Y], sheets.clone())),
        ("the same without shared vertices", soup(&mesh(vec![DVec3::ZERO, DVec3::X, DVec3::Y], sheets))),
        ("an edge of all triangles", {
            let tips = (0..MANY).map(|index| around(index, 0.5));
            mesh([DVec3::ZERO, DVec3::Z].into_iter().chain(tips).collect(), fins)
        }),
        ("a long strip", {
            let positions =
                (0..MANY + 2).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), (0.1 * f64::from(i)).sin()));
            mesh(
                positions.collect(),
                (0..MANY).map(|i| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i + 1, i, i + 2] }).collect(),
            )
        }),
    ];
    for (name, shape) in shapes {
        let (steps, triangles) = steps(shape);
        // Each sort of the three corners of n triangles takes about 3 n log₂ n steps.
        let most = 4.0 * 3.0 * triangles * (3.0 * triangles).log2();
        assert!(steps < most, "{name}: {steps} steps for {triangles} triangles");
    }
}
