//! Where all or none of the light gets through, visibility is exactly 1 or 0.

use glam::Vec3;
use lightmesh_render::{Mode, Settings};
use lightmesh_scene::{LightKind, Scene};
use lightmesh_testkit::{BALL_LIGHT, MODES, Picture, RADII, SceneDraft, WEIGHTS, each_device, open_floor, thin_wall};

use crate::{light_mesh, mode};

const POINT: LightKind = LightKind::Point { position: Vec3::new(-2.0, 3.0, 0.7), spread: 0.0 };

/// Renders with these settings: every pixel shows geometry that faces the light, and V is `expected` to the last bit.
fn assert_all(scene: &Scene, settings: &Settings, expected: f32) {
    each_device(|renderer| {
        let frame = renderer.render(scene, &settings.clone().with_layers(true)).unwrap();
        let picture = Picture::new(&frame);
        let light = scene.lights[0].position().unwrap();
        let facing = picture.hits().filter(|&pixel| picture.normal(pixel).dot(light - picture.position(pixel)) > 0.5);
        let facing: Vec<usize> = facing.collect();
        assert!(10 * facing.len() >= picture.layers().depth.len(), "{} pixels face the light", facing.len());
        for pixel in facing {
            let share = picture.layers().visibility[0][pixel];
            assert_eq!(share, expected, "{}, {settings:?} at {}", scene.name, picture.position(pixel));
        }
    });
}

/// A box around the camera, with the light outside. Its six sheets intersect each other.
fn dark_room(light: LightKind) -> Scene {
    SceneDraft::new()
        .quad([[-1.2, -1.0, -1.2], [-1.2, -1.0, 1.2], [1.2, -1.0, 1.2], [1.2, -1.0, -1.2]])
        .quad([[-1.2, 1.0, -1.2], [1.2, 1.0, -1.2], [1.2, 1.0, 1.2], [-1.2, 1.0, 1.2]])
        .quad([[-1.2, -1.2, -1.0], [1.2, -1.2, -1.0], [1.2, 1.2, -1.0], [-1.2, 1.2, -1.0]])
        .quad([[-1.2, -1.2, 1.0], [-1.2, 1.2, 1.0], [1.2, 1.2, 1.0], [1.2, -1.2, 1.0]])
        .quad([[-1.0, -1.2, -1.2], [-1.0, 1.2, -1.2], [-1.0, 1.2, 1.2], [-1.0, -1.2, 1.2]])
        .quad([[1.0, -1.2, -1.2], [1.0, -1.2, 1.2], [1.0, 1.2, 1.2], [1.0, 1.2, -1.2]])
        .light(light)
        .camera([-0.8, 0.7, 0.6], [0.9, -0.9, -0.5])
        .finish("dark room")
}

/// The same with walls that share their corners, as in models.
fn dark_box(light: LightKind) -> Scene {
    SceneDraft::new()
        .cuboid([-1.0; 3], [1.0; 3])
        .light(light)
        .camera([-0.8, 0.7, 0.6], [0.9, -0.9, -0.5])
        .finish("dark box")
}

#[test]
fn an_open_floor_is_fully_lit() {
    for light in [POINT, BALL_LIGHT] {
        let scene = open_floor(light);
        for radius in RADII {
            for weight in WEIGHTS {
                assert_all(&scene, &light_mesh([32, 24], 0.17, radius).with_weight(weight), 1.0);
            }
        }
        for other in MODES {
            assert_all(&scene, &mode(other, [32, 24]), 1.0);
        }
    }
}

#[test]
fn a_closed_room_is_fully_dark() {
    for light in [POINT, BALL_LIGHT] {
        for scene in [dark_room(light.clone()), dark_box(light.clone())] {
            for radius in RADII {
                for weight in WEIGHTS {
                    assert_all(&scene, &light_mesh([32, 24], 0.13, radius).with_weight(weight), 0.0);
                }
            }
            for other in MODES {
                assert_all(&scene, &mode(other, [32, 24]), 0.0);
            }
        }
    }
}

/// Every pixel that shows the dark room behind the thin wall.
fn assert_no_leak(scene: &Scene, settings: &Settings, least_pixels: usize) {
    each_device(|renderer| {
        let frame = renderer.render(scene, &settings.clone().with_layers(true)).unwrap();
        let picture = Picture::new(&frame);
        let inside: Vec<usize> = picture.hits().filter(|&pixel| picture.position(pixel).x > 0.015).collect();
        assert!(inside.len() >= least_pixels, "{} pixels inside", inside.len());
        for pixel in inside {
            let (share, place) = (picture.layers().visibility[0][pixel], picture.position(pixel));
            assert_eq!(share, 0.0, "{settings:?} leaks at {place:?}");
        }
    });
}

#[test]
fn a_thin_wall_leaks_nothing() {
    for light in [POINT, BALL_LIGHT] {
        let scene = thin_wall(0.02, light).finish("thin wall");
        for step in [0.05, 0.1, 0.2, 0.4] {
            for radius in [2.1, 3.1] {
                assert_no_leak(&scene, &light_mesh([48, 48], step, radius), 48 * 48);
            }
        }
        for other in [Mode::RayTrace, Mode::Area] {
            assert_no_leak(&scene, &mode(other, [48, 48]), 48 * 48);
        }
    }
}

#[test]
fn the_foot_of_a_thin_wall_leaks_nothing() {
    for light in [POINT, BALL_LIGHT] {
        // Down from just inside: a strip of floor 0.04 wide along the base of the wall, with pixels 0.0005 wide; then 1e-6 wide
        // ones.
        for (middle, height) in [(0.04, 0.04), (0.020_03, 0.000_1)] {
            let scene = thin_wall(0.02, light.clone());
            let scene = scene.orthographic([middle, 1.0, 0.3], [middle, 0.0, 0.3], height).finish("foot");
            for step in [0.05, 0.13, 0.4] {
                for radius in [2.1, 3.1] {
                    assert_no_leak(&scene, &light_mesh([80, 80], step, radius), 80 * 30);
                }
            }
        }
    }
}

#[test]
fn the_yard_of_a_thin_wall_is_lit() {
    let mut scene = thin_wall(0.02, POINT).finish("yard");
    scene.cameras[0].position = Vec3::new(-2.5, 2.5, 1.0);
    scene.cameras[0].direction = Vec3::new(0.2, -1.0, -0.1).normalize();
    assert_all(&scene, &light_mesh([32, 32], 0.1, 2.1), 1.0);
}

#[test]
fn the_foot_of_a_single_sheet_leaks_nothing_beyond_a_hundred_thousandth_of_a_step() {
    // A sheet closer than that counts as edge-on and hides nothing (`LightMesh::edge_on`).
    let light = LightKind::Point { position: Vec3::new(3.0, 2.0, 0.3), spread: 0.0 };
    for step in [0.1, 0.4] {
        let near = 1.0 - 3e-5 * f64::from(step);
        let draft = SceneDraft::new().cuboid([-1.0; 3], [1.0; 3]).light(light.clone());
        let draft = draft.orthographic([near, 0.0, 0.3], [near, -1.0, 0.3], 2e-5 * step);
        let scene = draft.finish("sheet");
        for radius in [2.1, 3.1] {
            assert_all(&scene, &light_mesh([40, 40], step, radius), 0.0);
        }
    }
}

#[test]
fn a_shade_close_under_the_lamp_hides_it_and_the_ceiling_it_hangs_in_does_not() {
    let lamp = || SceneDraft::new().floor(0.0, 2.0).point_light([0.1, 4.0, 0.2]).camera([0.0, 2.0, 1.5], [0.0; 3]);
    for (height, expected) in [(3.999, 0.0), (4.0, 1.0), (4.001, 1.0)] {
        let scene = lamp().floor(height, 6.0).finish("lamp");
        for settings in [light_mesh([24, 24], 0.2, 2.1), mode(Mode::RayTrace, [24, 24]), mode(Mode::Area, [24, 24])] {
            assert_all(&scene, &settings, expected);
        }
    }
}
