use glam::Vec3;
use lightmesh_scene::{Added, Falloff, LightKind, Lighting, Mesh, Scene, SceneBuilder, Up, Viewpoint};

/// A cube from -1 to 1 whose faces are seen from inside, or from outside. The sides given are left out: 0 is -x, 1 is +x, 2 is -y, and so on.
fn cube(inwards: bool, open: &[usize]) -> Mesh {
    let mut mesh = Mesh::default();
    for side in (0..6).filter(|side| !open.contains(side)) {
        let normal = Vec3::AXES[side / 2] * if side % 2 == 0 { -1.0 } else { 1.0 };
        let (a, b) = (Vec3::AXES[(side / 2 + 1) % 3], Vec3::AXES[(side / 2 + 2) % 3]);
        let first = mesh.positions.len() as u32;
        mesh.positions
            .extend([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[u, v]| normal + u * a + v * b));
        let corners = [[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|corner: u32| first + corner));
        let turned = |[a, b, c]: [u32; 3]| if (side % 2 == 1) == inwards { [a, c, b] } else { [a, b, c] };
        mesh.triangles.extend(corners.map(turned));
        mesh.materials.extend([0; 2]);
    }
    mesh
}

fn completed(mesh: Mesh, up: Up) -> (Scene, Added) {
    let mut scene = SceneBuilder::new().finish_scene("cube");
    scene.geometry_mut().mesh = mesh;
    let added = scene.complete(up);
    (scene, added)
}

#[test]
fn a_closed_room_is_seen_and_lit_from_inside() {
    for up in [Up::Y, Up::Z] {
        let (scene, added) = completed(cube(true, &[]), up);
        assert_eq!((added.viewpoint, added.lights_inside), (Viewpoint::Inside, true));
        let camera = &scene.cameras[0];
        assert!(camera.direction.dot(up.axis()).abs() < 1e-6 && camera.position.abs().max_element() < 1.0);
        for light in &scene.lights.list {
            let position = light.position().unwrap();
            assert!(position.abs().max_element() < 1.0 && position.dot(up.axis()) > camera.position.dot(up.axis()));
        }
        assert!(scene.lights.ambient.is_some());
    }
}

#[test]
fn a_box_is_seen_from_outside() {
    for open in [&[][..], &[4], &[3]] {
        let (scene, added) = completed(cube(false, open), Up::Y);
        assert_eq!((added.viewpoint, added.lights_inside), (Viewpoint::Front, false), "{open:?}");
        assert_eq!(scene.lights.ambient, None);
    }
}

#[test]
fn a_room_without_one_wall_is_seen_through_it() {
    for (open, direction) in [(0, Vec3::X), (1, Vec3::NEG_X), (4, Vec3::Z)] {
        let (scene, added) = completed(cube(true, &[open]), Up::Y);
        assert_eq!(added.viewpoint, Viewpoint::OpenSide, "{open}");
        assert_eq!(scene.cameras[0].direction, direction);
    }
    // A court is open to the sky.
    assert_eq!(completed(cube(true, &[3]), Up::Y).1.viewpoint, Viewpoint::Inside);
}

#[test]
fn a_room_without_one_wall_has_a_lamp_below_its_ceiling() {
    let lit = |mesh: Mesh, lighting: Lighting| {
        let mut scene = SceneBuilder::new().finish_scene("room");
        scene.geometry_mut().mesh = mesh;
        let added = scene.complete_with(lighting, Up::Y, 1.0);
        (scene, added)
    };
    let (scene, added) = lit(cube(true, &[4]), Lighting::Studio);
    assert!(added.lamp && added.lights && !added.studio && scene.lights.room);
    let [lamp] = &scene.lights.list[..] else { panic!("{:?}", scene.lights.list) };
    let LightKind::Disk { position, radius, .. } = lamp.kind else { panic!("{lamp:?}") };
    // In the middle, 6 cm below a ceiling 2 m high, and between the walls.
    assert!((position - Vec3::new(0.0, 0.97, 0.0)).abs().max_element() < 0.04, "{position}");
    assert!(radius > 0.1 && radius < 0.5, "{radius}");
    assert_eq!((lamp.surface, lamp.falloff), (Some(Vec3::NEG_Y), Falloff::InverseSquare));
    // A white floor below it is white: I / (π d²).
    assert!((lamp.intensity.x / (std::f32::consts::PI * (position.y + 1.0).powi(2)) - 1.0).abs() < 1e-3);
    for (mesh, lighting) in [
        (cube(true, &[4]), Lighting::KeyAndFill),
        (cube(true, &[4]), Lighting::StudioAnywhere),
        (cube(true, &[]), Lighting::Studio),
        (cube(false, &[]), Lighting::Studio),
    ] {
        let (scene, added) = lit(mesh, lighting);
        assert!(!added.lamp && !scene.lights.room, "{lighting:?}");
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (scene, added) = pool.install(|| completed(cube(true, &[]), Up::Y));
        (scene.cameras, scene.lights, added)
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn an_ambient_term_that_is_set_stays() {
    let mut scene = SceneBuilder::new().finish_scene("room");
    scene.geometry_mut().mesh = cube(true, &[]);
    scene.lights.ambient = Some(Vec3::ZERO);
    assert!(scene.complete(Up::Y).lights_inside);
    assert_eq!(scene.lights.ambient, Some(Vec3::ZERO));
}
