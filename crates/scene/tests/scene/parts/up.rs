use std::path::Path;

use glam::Vec3;
use lightmesh_scene::{Scene, SceneBuilder, Up};

/// A square of edge 2 at height 0 and an apex above its centre.
fn tent(up: Up, ground: bool) -> Scene {
    let place = |x: f32, side: f32, height: f32| match up {
        Up::Y => Vec3::new(x, height, side),
        Up::Z => Vec3::new(x, side, height),
    };
    let mut scene = SceneBuilder::new().finish_scene("tent");
    scene.geometry_mut().mesh.positions = vec![
        place(-1.0, -1.0, 0.0),
        place(1.0, -1.0, 0.0),
        place(1.0, 1.0, 0.0),
        place(-1.0, 1.0, 0.0),
        place(0.0, 0.0, 3.0),
    ];
    scene.geometry_mut().mesh.triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    if ground {
        scene.geometry_mut().mesh.triangles.extend([[0, 1, 2], [0, 2, 3]]);
    }
    scene
}

#[test]
fn a_scene_stands_on_its_ground() {
    for up in [Up::Y, Up::Z] {
        let info = tent(up, true).suggested_up().unwrap();
        assert_eq!((info.axis, info.reason.contains(up.name())), (up.name(), true));
    }
    assert_eq!(SceneBuilder::new().finish_scene("empty").suggested_up(), None);
}

#[test]
fn a_model_without_a_ground_stands_at_height_0() {
    for up in [Up::Y, Up::Z] {
        let mut open = tent(up, false);
        let info = open.suggested_up().unwrap();
        assert_eq!((info.axis, info.reason.contains(&format!("begins at {} = 0", up.name()))), (up.name(), true));
        // Centred on nothing, or in the air.
        let positions = open.geometry.mesh.positions.clone();
        for shift in [Vec3::new(0.0, 0.5, 0.5), up.axis()] {
            open.geometry_mut().mesh.positions = positions.iter().map(|position| position + shift).collect();
            assert_eq!(open.suggested_up(), None);
        }
    }
}

#[test]
fn cameras_know_better_than_the_ground() {
    let mut scene = tent(Up::Y, true);
    scene.cameras.push(scene.default_camera(Up::Z));
    let info = scene.suggested_up().unwrap();
    assert_eq!((info.axis, info.reason.as_str()), ("z", "its cameras are oriented that way"));
}

#[test]
fn only_stl_is_usually_made_with_z_up() {
    let of = |path: &str| Up::of_file(Path::new(path));
    assert_eq!([of("a.stl"), of("a.STL")], [Up::Z; 2]);
    assert_eq!([of("a.obj"), of("a.ply"), of("a.glb"), of("a.toml"), of("builtin:garden")], [Up::Y; 5]);
}
