//! The last term of formula (1).

use glam::Vec3;
use lightmesh_render::Settings;
use lightmesh_scene::{Material, Scene};
use lightmesh_testkit::{MODES, SceneDraft, render};

fn mirror(ks: f32, emission: f32) -> Material {
    Material::matt(Vec3::ZERO).with_ks([ks; 3]).with_emission([emission; 3])
}

/// What the camera sees along its axis, the same in all modes.
fn seen(scene: &Scene, bounces: u32) -> Vec3 {
    let colors = MODES.map(|mode| {
        let frame =
            render(scene, &Settings::default().with_aa(1).with_mode(mode).with_size([1, 1]).with_bounces(bounces));
        Vec3::from_array(frame.image.color()[0])
    });
    assert!(colors.iter().all(|color| *color == colors[0]), "{colors:?}");
    colors[0]
}

/// A mirror floor; the reflected axis of the camera meets a wall that glows red.
fn mirror_floor() -> Scene {
    SceneDraft::new()
        .painted(mirror(0.75, 0.0))
        .floor(0.0, 4.0)
        .painted(Material::matt(Vec3::ZERO).with_emission([0.5, 0.0, 0.0]))
        .quad([[3.0, 1.5, -1.0], [3.0, 3.5, -1.0], [3.0, 3.5, 1.0], [3.0, 1.5, 1.0]])
        .background(Vec3::new(0.0, 0.25, 0.0))
        .camera([-2.0, 2.0, 0.2], [0.0, 0.0, 0.1])
        .finish("mirror floor")
}

#[test]
fn a_mirror_shows_what_it_faces() {
    let scene = mirror_floor();
    assert_eq!(seen(&scene, 0), Vec3::ZERO);
    assert_eq!(seen(&scene, 1), Vec3::new(0.375, 0.0, 0.0));
    // The visible surface does not reflect: a further bounce changes nothing.
    assert_eq!(seen(&scene, 2), seen(&scene, 1));
}

#[test]
fn a_mirror_shows_the_background_too() {
    let mut scene = mirror_floor();
    let keep = scene.geometry.mesh.triangles.len() - 2;
    scene.geometry_mut().mesh.triangles.truncate(keep);
    scene.geometry_mut().mesh.materials.truncate(keep);
    assert_eq!(seen(&scene, 1), Vec3::new(0.0, 0.1875, 0.0));
}

#[test]
fn facing_mirrors_add_up_to_the_geometric_series() {
    let scene = SceneDraft::new()
        .painted(mirror(0.5, 1.0))
        .floor(0.0, 5.0)
        .floor(2.0, 5.0)
        .camera([0.1, 1.0, 0.2], [0.1, 0.0, 0.2])
        .finish("facing mirrors");
    for bounces in [0, 1, 2, 5, 12] {
        // Σ ksⁿ for n from 0 to `bounces`: sums of powers of two are exact.
        assert_eq!(seen(&scene, bounces), Vec3::splat(2.0 - 0.5f32.powi(bounces as i32)), "{bounces} bounces");
    }
}

#[test]
fn slanting_light_between_mirrors_walks_along_them() {
    // From (-2, 1) downwards at 45 degrees: the floor at x = -1, the ceiling at 1, the floor at 3, then the end at x = 4.
    let scene = SceneDraft::new()
        .painted(mirror(0.5, 0.0))
        .floor(0.0, 5.0)
        .floor(2.0, 5.0)
        .painted(mirror(0.0, 1.0))
        .quad([[4.0, 0.0, -5.0], [4.0, 2.0, -5.0], [4.0, 2.0, 5.0], [4.0, 0.0, 5.0]])
        .camera([-2.0, 1.0, 0.2], [-1.0, 0.0, 0.2])
        .finish("corridor");
    let colors = [0, 1, 2, 3, 4].map(|bounces| seen(&scene, bounces).x);
    assert_eq!(colors, [0.0, 0.0, 0.0, 0.125, 0.125]);
}
