use std::collections::HashSet;

use glam::Vec3;
use lightmesh_render::{View, Window};
use lightmesh_scene::{Camera, Fov, Projection};

fn camera(projection: Projection) -> Camera {
    Camera::look_to(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 50.0).unwrap().with_projection(projection)
}

#[test]
fn one_pixel_looks_along_the_axis() {
    for projection in [Projection::Perspective(Fov::Vertical(50.0)), Projection::Orthographic { height: 3.0 }] {
        let ray = View::new(&camera(projection), [1, 1]).ray(0);
        assert_eq!((ray.origin, ray.direction), (Vec3::ZERO, Vec3::NEG_Z));
    }
}

#[test]
fn row_zero_is_the_top_and_column_zero_the_left() {
    let view = View::new(&camera(Projection::Perspective(Fov::Vertical(90.0))), [4, 2]);
    let first = view.ray(0).direction;
    assert!(first.x < 0.0 && first.y > 0.0);
    // 90 degrees: the top border is at y = 1, the first row's centre at 1/2, and pixels are square.
    let first = first / -first.z;
    assert!((first - Vec3::new(-1.5, 0.5, -1.0)).length() < 1e-6, "{first}");
    let last = view.ray(7).direction;
    assert!(last.x > 0.0 && last.y < 0.0);
}

#[test]
fn a_window_has_the_rays_and_numbers_of_the_image() {
    let whole = View::new(&camera(Projection::Perspective(Fov::Vertical(90.0))), [40, 30]);
    for (first, size) in [([0, 0], [40, 30]), ([7, 11], [5, 4]), ([0, 9], [40, 2]), ([39, 29], [1, 1])] {
        let view = whole.with_window(Window { size, first, whole: [40, 30] });
        for index in 0..size[0] * size[1] {
            let number = view.window().number(index);
            let place = [index % size[0] + first[0] as u32, index / size[0] + first[1] as u32];
            assert_eq!([number % 40, number / 40], place);
            assert_eq!(view.ray(index).direction, whole.ray(number).direction);
        }
    }
    let window = Window { size: [5, 4], first: [1, 25], whole: [40, 30] };
    assert_eq!(window.grown(3), Window { size: [9, 8], first: [0, 22], whole: [40, 30] });
}

#[test]
fn a_window_around_an_image_has_rays_and_numbers_of_its_own() {
    for projection in [Projection::Perspective(Fov::Vertical(90.0)), Projection::Orthographic { height: 3.0 }] {
        let whole = View::new(&camera(projection), [40, 30]);
        let [around, part] = [([-9, -4], [60, 40]), ([-2, 27], [7, 8])]
            .map(|(first, size)| whole.with_window(Window { size, first, whole: [40, 30] }));
        let mut numbers = HashSet::new();
        for index in 0..60 * 40 {
            let (x, y) = (index as i32 % 60 - 9, index as i32 / 60 - 4);
            if (0..40).contains(&x) && (0..30).contains(&y) {
                let number = around.window().number(index);
                assert_eq!(number as i32, y * 40 + x);
                assert_eq!(around.ray(index), whole.ray(number));
            }
            assert!(numbers.insert(around.window().number(index)), "{x}, {y}: none twice");
            // Another window has the same.
            if (-2..5).contains(&x) && (27..35).contains(&y) {
                let other = ((y - 27) * 7 + x + 2) as u32;
                assert_eq!(part.window().number(other), around.window().number(index));
                assert_eq!(part.ray(other), around.ray(index));
            }
        }
    }
    let window = Window { size: [5, 40], first: [1, -2], whole: [40, 30] };
    assert_eq!(window.grown(3), Window { size: [11, 46], first: [-2, -5], whole: [40, 30] });
}

#[test]
fn a_shifted_image_is_a_window_of_a_larger_one() {
    // 24 pixels to the right and 12 up.
    let shift = [0.5, 0.25];
    let vfov = |rows: f32| 2.0 * (rows / 48.0 * 25f32.to_radians().tan()).atan().to_degrees();
    let perspective = |rows: f32| Projection::Perspective(Fov::Vertical(vfov(rows)));
    let orthographic = |rows: f32| Projection::Orthographic { height: 3.0 * rows / 48.0 };
    let horizontal = |columns: f32| Projection::Perspective(Fov::Horizontal(vfov(columns)));
    let pairs = [
        [perspective(48.0), perspective(72.0)],
        [orthographic(48.0), orthographic(72.0)],
        [horizontal(64.0), horizontal(112.0)],
    ];
    for [own, larger] in pairs {
        let direction = Vec3::new(0.3, -0.5, -0.8);
        let camera = |projection: Projection| {
            let camera = Camera::look_to(Vec3::new(1.0, 2.0, 3.0), direction, Vec3::Y, 50.0).unwrap();
            camera.with_projection(projection)
        };
        let view = View::new(&camera(own).with_shift(shift), [64, 48]);
        let window = Window { size: [64, 48], first: [48, 0], whole: [112, 72] };
        let whole = View::new(&camera(larger), [112, 72]).with_window(window);
        for index in 0..64 * 48 {
            let (found, expected) = (view.ray(index), whole.ray(index));
            assert!(found.direction.distance(expected.direction) < 1e-6, "{own:?}: {found:?}, {expected:?}");
            assert!(found.origin.distance(expected.origin) < 1e-6, "{own:?}: {found:?}, {expected:?}");
        }
        for (found, expected) in view.spacing().into_iter().zip(whole.spacing()) {
            assert!((found - expected).abs() < 1e-6);
        }
    }
}

#[test]
fn a_horizontal_angle_fixes_the_width() {
    let view = View::new(&camera(Projection::Perspective(Fov::Horizontal(90.0))), [4, 2]);
    let first = view.ray(0).direction;
    assert!((first.x / first.z - 0.75).abs() < 1e-6);
}

#[test]
fn orthographic_rays_are_parallel_and_span_the_height() {
    let view = View::new(&camera(Projection::Orthographic { height: 4.0 }), [2, 2]);
    assert_eq!(view.ray(0).direction, view.ray(3).direction);
    assert_eq!(view.ray(0).origin - view.ray(2).origin, Vec3::new(0.0, 2.0, 0.0));
}
