//! The last term of formula (1).

use glam::{DVec3, IVec3, Vec3};
use lightmesh_render::Settings;
use lightmesh_scene::{Material, Scene};
use lightmesh_testkit::{
    ACCELERATIONS, BOX_IN_MIRRORS, EYE_IN_MIRRORS, MIRROR_ROOM, MODES, SceneDraft, mirror_room, render,
};

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

#[test]
fn in_a_closed_box_of_mirrors_every_bounce_adds_its_power() {
    for ks in [0.9_f32, 1.0] {
        let draft = SceneDraft::new().painted(mirror(ks, 0.3).with_ka([0.2; 3])).ambient(1.0);
        let draft = draft.cuboid([-2.0, -1.0, -1.5], [2.0, 1.0, 1.5]).camera([0.3, 0.2, 0.1], [2.0, -0.9, 1.4]);
        let scene = draft.finish("box of mirrors");
        for bounces in [0, 1, 2, 7, 40] {
            let frame = render(&scene, &Settings::default().with_aa(1).with_size([24, 16]).with_bounces(bounces));
            let expected: f32 = (0..=bounces as i32).map(|n| 0.5 * ks.powi(n)).sum();
            for color in frame.color() {
                let error = (Vec3::from_array(*color) / expected - 1.0).abs().max_element();
                assert!(error < 2e-5, "{ks}, {bounces} bounces: {color:?}, not {expected}");
            }
        }
    }
}

/// The number of mirrors on the way to the nearest image of the box in [`mirror_room`], grown by `by`: walls that are crossed become mirrors, and
/// what is behind them is the room mirrored in them. `None` beyond `most`.
fn mirrors_to_the_box(direction: DVec3, most: i32, by: f64) -> Option<i32> {
    let size = MIRROR_ROOM[1] - MIRROR_ROOM[0];
    // The way on which the ray is in the image of the box in room (i, j, k).
    let meets = |room: IVec3| {
        let (mut from, mut to) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let at = MIRROR_ROOM[0][axis] + f64::from(room[axis]) * size[axis];
            let [low, high] = BOX_IN_MIRRORS.map(|corner| corner[axis] - MIRROR_ROOM[0][axis]);
            let [low, high] = if room[axis] % 2 == 0 { [low, high] } else { [size[axis] - high, size[axis] - low] };
            let [a, b] = [low - by, high + by].map(|side| (at + side - EYE_IN_MIRRORS[axis]) / direction[axis]);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        (from < to).then_some(from)
    };
    let rooms = (-most..=most).flat_map(|i| (-most..=most).flat_map(move |j| (-most..=most).map(move |k| [i, j, k])));
    let seen = rooms.map(IVec3::from_array).filter_map(|room| Some((meets(room)?, room.abs().element_sum())));
    let (_, mirrors) = seen.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (mirrors <= most).then_some(mirrors)
}

#[test]
fn images_of_a_box_in_a_room_of_mirrors_are_where_the_mirrors_put_them() {
    const BOUNCES: i32 = 4;
    let scene = mirror_room(0.5);
    let frames = ACCELERATIONS.map(|acceleration| {
        let settings = Settings::default().with_aa(1).with_size([48, 36]).with_layers(true);
        render(&scene, &settings.with_bounces(BOUNCES as u32).with_acceleration(acceleration))
    });
    let mut counts = [0; BOUNCES as usize + 2];
    for (pixel, position) in frames[0].layers().unwrap().position.iter().enumerate() {
        let direction = (Vec3::from_array(*position) - scene.cameras[0].position).as_dvec3();
        let [mirrors, larger] = [-1e-3, 1e-3].map(|by| mirrors_to_the_box(direction, BOUNCES, by));
        if mirrors != larger {
            continue;
        }
        let expected = mirrors.map_or(0.0, |mirrors| 0.5_f32.powi(mirrors));
        for frame in &frames {
            assert_eq!(frame.color()[pixel], [expected; 3], "{direction}: behind {mirrors:?} mirrors");
        }
        counts[mirrors.unwrap_or(BOUNCES + 1) as usize] += 1;
    }
    assert!(counts.iter().all(|count| *count > 15), "{counts:?}");
}
