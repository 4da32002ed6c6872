mod rooms;
mod sight;
mod strays;

use glam::Vec3;
use lightmesh_scene::internals::framing::{FILL, VFOV, corner};
use lightmesh_scene::{Added, Bounds, Camera, Light, Scene, SceneBuilder, Up};

fn corners(bounds: Bounds) -> [Vec3; 8] {
    std::array::from_fn(|i| corner(&bounds, i as u32))
}

/// The corners of a box.
fn scene(min: Vec3, max: Vec3) -> Scene {
    let mut scene = SceneBuilder::new().finish_scene("test");
    scene.geometry_mut().mesh.positions = corners(Bounds { min, max }).to_vec();
    scene.geometry_mut().mesh.triangles = vec![[0, 1, 2]];
    scene
}

/// How far points go to the right, left, up and down from the image's centre, in half heights.
fn extents_in_picture(points: &[Vec3], camera: &Camera) -> [f32; 4] {
    let (right, up, forward) = camera.basis();
    let tangent = (0.5 * VFOV).to_radians().tan();
    points.iter().map(|&point| point - camera.position).fold([f32::NEG_INFINITY; 4], |extents, p| {
        let scale = 1.0 / (tangent * p.dot(forward));
        let sides = [p.dot(right), -p.dot(right), p.dot(up), -p.dot(up)];
        std::array::from_fn(|side| extents[side].max(scale * sides[side]))
    })
}

fn assert_framed(points: &[Vec3], camera: &Camera) {
    assert_framed_for(points, camera, 1.0);
}

fn assert_framed_for(points: &[Vec3], camera: &Camera, aspect: f32) {
    let mut extents = extents_in_picture(points, camera);
    extents[..2].iter_mut().for_each(|aside| *aside /= aspect);
    let most = extents.into_iter().fold(0.0, f32::max);
    assert!((most - FILL).abs() < 1e-3, "{extents:?}");
    // It fills the image from one border to the other.
    let fills = |axis: usize| extents[axis].min(extents[axis + 1]) > FILL - 1e-3;
    assert!(fills(0) || fills(2), "{extents:?}");
    // In the middle along the other axis, too.
    let beside = (extents[0] - extents[1]).abs().max((extents[2] - extents[3]).abs());
    assert!(beside < 1e-3, "{extents:?}");
}

#[test]
fn all_corners_are_in_the_picture_and_fill_it() {
    let boxes = [
        (Vec3::splat(-1.0), Vec3::ONE),
        (Vec3::new(100.0, 0.0, -7.0), Vec3::new(160.0, 0.0, 20.0)),
        (Vec3::ZERO, Vec3::new(1e-3, 2.0, 1e-3)),
        (Vec3::splat(1e5), Vec3::splat(2e5)),
    ];
    for (min, max) in boxes {
        for up in [Up::Y, Up::Z] {
            assert_framed(&corners(Bounds { min, max }), &scene(min, max).default_camera(up));
        }
    }
}

#[test]
fn pictures_of_any_shape_are_filled() {
    let (min, max) = (Vec3::new(-3.0, 0.0, -1.0), Vec3::new(2.0, 2.0, 1.5));
    for aspect in [0.25, 0.5, 1.0, 1.6, 4.0, 10.0] {
        for up in [Up::Y, Up::Z] {
            let camera = scene(min, max).default_camera_for(up, aspect);
            assert_framed_for(&corners(Bounds { min, max }), &camera, aspect);
        }
    }
}

#[test]
fn what_does_not_fill_its_box_fills_the_picture() {
    let ball: Vec<Vec3> = (0..200)
        .map(|i| {
            let (z, turn) = (i as f32 / 99.5 - 1.0, 2.4 * i as f32);
            Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
        })
        .collect();
    let mut round = scene(Vec3::ZERO, Vec3::ONE);
    round.geometry_mut().mesh.positions = ball.clone();
    assert_framed(&ball, &round.default_camera(Up::Y));
}

#[test]
fn an_empty_scene_has_a_camera_and_a_light_too() {
    let empty = SceneBuilder::new().finish_scene("empty");
    let camera = empty.default_camera(Up::Y);
    assert!(camera.position.is_finite() && camera.position.length() > 1.0);
    assert!(empty.default_lights(&camera).iter().all(|light| light.position().unwrap().is_finite()));
}

#[test]
fn the_key_light_is_above_the_camera_and_a_weaker_one_on_its_other_side() {
    for up in [Up::Y, Up::Z] {
        let scene = scene(Vec3::splat(-3.0), Vec3::splat(5.0));
        let camera = scene.default_camera(up);
        let (right, ..) = camera.basis();
        let [key, fill] = scene.default_lights(&camera);
        let from_camera = |light: &Light| light.position().unwrap() - camera.position;
        assert!(from_camera(&key).dot(up.axis()) > from_camera(&fill).dot(up.axis()) + 1.0);
        assert!(from_camera(&key).dot(right) < -1.0 && from_camera(&fill).dot(right) > 1.0);
        assert!(fill.intensity.max_element() < 0.5 * key.intensity.min_element());
    }
}

/// Lights, and a camera or none, were added.
fn added(camera: bool) -> Added {
    let mut added = Added::default();
    (added.camera, added.lights) = (camera, true);
    added
}

#[test]
fn a_scene_is_completed_once() {
    let mut bare = scene(Vec3::ZERO, Vec3::ONE);
    let lit = bare.default_lights(&bare.default_camera(Up::Z));
    assert_eq!(bare.complete(Up::Z), added(true));
    assert_eq!((bare.cameras.as_slice(), bare.lights.as_slice()), (&[bare.default_camera(Up::Z)][..], &lit[..]));
    assert_eq!(bare.complete(Up::Y), Added::default());
    // Existing content stays, and lights are placed relative to the first camera.
    let camera = Camera::look_at(Vec3::new(0.0, 0.0, 9.0), Vec3::ZERO, Vec3::Y, 30.0).unwrap();
    bare.cameras = vec![camera.clone(), bare.default_camera(Up::Y)];
    bare.lights.clear();
    assert_eq!(bare.complete(Up::Y), added(false));
    assert_eq!((bare.cameras.len(), bare.lights.as_slice()), (2, &bare.default_lights(&camera)[..]));
}

#[test]
fn an_unknown_camera_is_answered_with_the_known() {
    let mut scene = scene(Vec3::ZERO, Vec3::ONE);
    let message = |scene: &Scene| scene.camera("top").unwrap_err().to_string();
    assert!(message(&scene).contains("no named cameras"));
    scene.cameras.push(scene.default_camera(Up::Y).named("front"));
    assert_eq!(message(&scene), "there is no camera named `top`, scene test; available: front");
    assert_eq!(scene.camera("front").unwrap().name, "front");
}
