use glam::Vec3;
use lightmesh_scene::{Camera, Mesh, Scene, SceneBuilder, Up};

/// A box around `center`, whose triangles share no vertices.
fn cuboid(mesh: &mut Mesh, center: Vec3, half: Vec3) {
    for side in 0..6 {
        let normal = Vec3::AXES[side / 2] * if side % 2 == 0 { -1.0 } else { 1.0 };
        let (a, b) = (Vec3::AXES[(side / 2 + 1) % 3], Vec3::AXES[(side / 2 + 2) % 3]);
        for corners in [[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]], [[-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]] {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners.map(|[u, v]: [f32; 2]| center + half * (normal + u * a + v * b)));
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.materials.push(0);
        }
    }
}

fn scene(boxes: &[(Vec3, Vec3)]) -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("boxes");
    boxes.iter().for_each(|&(center, half)| cuboid(&mut scene.geometry_mut().mesh, center, half));
    scene
}

fn camera(boxes: &[(Vec3, Vec3)]) -> Camera {
    scene(boxes).default_camera(Up::Y)
}

/// The camera that frames the box around all of these by its vertices alone, of which every one counts.
fn framing_all(boxes: &[(Vec3, Vec3)]) -> Camera {
    let mut all = scene(boxes);
    let mesh = &mut all.geometry_mut().mesh;
    // One triangle over all is never small.
    let bounds = mesh.bounds();
    mesh.positions.extend([bounds.min, bounds.max, bounds.max]);
    let last = mesh.positions.len() as u32 - 1;
    mesh.triangles.push([last - 2, last - 1, last]);
    mesh.materials.push(0);
    all.default_camera(Up::Y)
}

const HOUSE: (Vec3, Vec3) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(2.0, 1.0, 1.5));

fn stray(x: f32) -> (Vec3, Vec3) {
    (Vec3::new(x, 0.1, 0.3), Vec3::splat(0.1))
}

#[test]
fn small_pieces_far_away_are_not_framed() {
    for strays in [&[stray(5.0)][..], &[stray(-400.0)], &[stray(6.0), stray(-9.0)], &[stray(4.0), stray(1e5)]] {
        let boxes: Vec<_> = [HOUSE].into_iter().chain(strays.iter().copied()).collect();
        assert_eq!(camera(&boxes), camera(&[HOUSE]), "{strays:?}");
        assert_ne!(camera(&boxes), framing_all(&boxes), "{strays:?}");
        // Lights are placed for what is framed.
        let (lone, all) = (scene(&[HOUSE]), scene(&boxes));
        assert_eq!(all.default_lights(&camera(&boxes)), lone.default_lights(&camera(&[HOUSE])));
    }
}

#[test]
fn small_pieces_nearby_are_framed() {
    for boxes in
        [[HOUSE, stray(2.2)], [HOUSE, stray(1.0)], [HOUSE, (Vec3::new(0.0, 3.0, 0.0), Vec3::new(0.02, 1.0, 0.02))]]
    {
        assert_eq!(camera(&boxes), framing_all(&boxes), "{boxes:?}");
    }
}

#[test]
fn a_table_keeps_its_chairs_and_a_street_its_houses() {
    let chair = |x: f32, z: f32| (Vec3::new(x, 0.45, z), Vec3::new(0.22, 0.45, 0.22));
    let table = (Vec3::new(0.0, 0.37, 0.0), Vec3::new(0.8, 0.37, 0.5));
    let set = [table, chair(2.0, 0.0), chair(-2.0, 0.0), chair(0.0, 1.8), chair(0.0, -1.8)];
    assert_eq!(camera(&set), framing_all(&set));
    let street: Vec<_> = (0..40).map(|number| (HOUSE.0 + 9.0 * number as f32 * Vec3::X, HOUSE.1)).collect();
    assert_eq!(camera(&street), framing_all(&street));
}

#[test]
fn many_small_pieces_are_what_a_scene_consists_of() {
    let around = (0..5).map(|number| stray(5.0 + 3.0 * number as f32));
    let boxes: Vec<_> = [HOUSE].into_iter().chain(around).collect();
    assert_eq!(camera(&boxes), framing_all(&boxes));
}

#[test]
fn odd_scenes_have_cameras() {
    let point = (Vec3::ONE, Vec3::ZERO);
    for boxes in
        [&[][..], &[point], &[point, (Vec3::splat(-3.0), Vec3::ZERO)], &[(Vec3::ZERO, Vec3::splat(1e38)), HOUSE]]
    {
        let found = camera(boxes);
        assert!(found.direction.is_finite(), "{boxes:?}");
    }
}
