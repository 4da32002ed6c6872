//! The position of a scene in the world does not matter.

use glam::{DVec3, Vec3};
use lightmesh_render::Mode;
use lightmesh_scene::LightKind;
use lightmesh_testkit::{Picture, mean_difference, pile, render};

use crate::{light_mesh, mode};

const LIGHTS: [LightKind; 2] = [
    LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 },
    LightKind::Sphere { position: Vec3::new(-2.0, 4.0, 2.0), radius: 0.4 },
];

const STEP: f32 = 0.15;

/// Tolerance between images. Light points at other positions in the world sample area lights differently.
fn most(mode: Mode, light: usize) -> f64 {
    if mode == Mode::LightMesh && light == 1 { 3e-3 } else { 1e-3 }
}

#[test]
fn a_moved_scene_has_the_same_visibility() {
    let size = [96, 96];
    let settings =
        [light_mesh(size, STEP, 2.1), light_mesh(size, STEP, 3.1), mode(Mode::RayTrace, size), mode(Mode::Area, size)];
    for settings in settings {
        let settings = settings.with_samples(16);
        let at_home = render(&pile(DVec3::ZERO, &LIGHTS), &settings);
        let at_home = Picture::new(&at_home);
        // 30 is too near for a separate frame, the others get one; the scene is 10 wide.
        for distance in [30.0, 1e3, 1e5, 1e6] {
            // Whole steps, so that light points move along.
            let steps = (distance * DVec3::new(1.0, -0.7, 0.31) / f64::from(STEP)).round();
            let offset = steps * f64::from(STEP);
            let moved = render(&pile(offset, &LIGHTS), &settings);
            let moved = Picture::new(&moved);
            assert_eq!(moved.hits().collect::<Vec<_>>(), at_home.hits().collect::<Vec<_>>(), "{distance}");
            for light in 0..2 {
                let difference = mean_difference(&moved.visibilities(light), &at_home.visibilities(light));
                assert!(
                    difference < most(settings.mode, light),
                    "light {light} moved by {distance}, {:?}: {difference}",
                    settings.mode
                );
            }
        }
    }
}
