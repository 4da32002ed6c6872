//! What surrounds a scene: seen by the camera, by mirrors and through shadow catchers, and as ambient light.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use lightmesh_render::{AmbientSource, Mode, Settings};
use lightmesh_scene::{Environment, Material, Scene, Sky, SunPosition, Up};
use lightmesh_testkit::{SceneDraft, render};

/// Another colour for each of four by two parts of all directions.
fn panorama() -> Environment {
    let texel = |index: u32| [0.1 + (index % 4) as f32, 0.5 + (index / 4) as f32, 0.25];
    let large = |index: u32| texel(index % 64 / 16 + 4 * (index / (64 * 16)));
    Environment::new("parts", [64, 32], (0..64 * 32).map(large).collect(), Up::Y)
}

fn surrounded(mut scene: Scene) -> Scene {
    scene.lights.surround(panorama().into());
    scene
}

fn settings() -> Settings {
    Settings::default().with_ambient_light(AmbientSource::Constant).with_size([16, 12])
}

#[test]
fn the_camera_sees_what_is_where_it_looks() {
    for aa in [1, 6] {
        for (target, expected) in [
            ([0.3, 0.4, -1.0], [2.1, 0.5, 0.25]),
            ([0.3, -0.4, -1.0], [2.1, 1.5, 0.25]),
            ([-0.3, 0.4, -1.0], [1.1, 0.5, 0.25]),
            ([0.3, 0.4, 1.0], [3.1, 0.5, 0.25]),
            ([-0.3, 0.4, 1.0], [0.1, 0.5, 0.25]),
        ] {
            let scene = surrounded(SceneDraft::new().camera([0.0; 3], target).finish("nothing"));
            let frame = render(&scene, &settings().with_aa(aa));
            let middle = frame.color()[6 * 16 + 8];
            assert!(Vec3::from(middle).distance(Vec3::from(expected)) < 1e-4, "{target:?}: {middle:?}");
        }
    }
}

#[test]
fn a_background_hides_it_from_the_camera_but_not_from_mirrors() {
    let mirror = Material::default().with_ka([0.0; 3]).with_kd([0.0; 3]).with_ks([0.5; 3]);
    let draft = SceneDraft::new().painted(mirror).quad([
        [-0.1, -0.1, -2.0],
        [0.7, -0.1, -2.0],
        [0.7, 0.5, -2.0],
        [-0.1, 0.5, -2.0],
    ]);
    let mut scene = surrounded(draft.camera([0.3, 0.2, 0.0], [0.3, 0.2, -1.0]).finish("mirror"));
    for aa in [1, 6] {
        let settings = settings().with_aa(aa).with_bounces(1);
        let at = |scene: &Scene, settings: &Settings| {
            let frame = render(scene, settings);
            [frame.color()[0], frame.color()[6 * 16 + 8]].map(Vec3::from)
        };
        // The middle looks back to the horizon in the south: half of what is just above and just below, or between.
        let behind = |seen: Vec3| (0.24..0.76).contains(&seen.y) && seen.z == 0.125;
        let [corner, middle] = at(&scene, &settings);
        assert!(corner.x > 1.0 && behind(middle), "{corner} {middle}");
        scene.lights.background = Some(Vec3::X);
        let [hidden, same] = at(&scene, &settings);
        assert_eq!((hidden, same), (Vec3::X, middle), "{aa}");
        scene.lights.background = None;
        let [clear, same] = at(&scene, &settings.with_transparent(true));
        assert_eq!((clear, same), (Vec3::ZERO, middle), "{aa}");
    }
}

#[test]
fn surfaces_get_what_comes_from_where_they_face() {
    // White above, black below: a floor gets all, a ceiling nothing, a wall a half.
    let texels = (0..64 * 32).map(|index| [if index < 64 * 16 { 1.0 } else { 0.0 }; 3]).collect();
    let map = Environment::new("above", [64, 32], texels, Up::Y);
    for (normal, expected) in [(Vec3::Y, 1.0), (Vec3::X, 0.5), (Vec3::NEG_Y, 0.0)] {
        let eye = 3.0 * normal + Vec3::new(0.01, 0.02, 0.03);
        let (aside, along) = normal.any_orthonormal_pair();
        let corner = |x: f32, y: f32| (9.0 * (x * aside + y * along)).to_array().map(f64::from);
        let draft = SceneDraft::new().painted(Material::default().with_ka([1.0; 3])).quad([
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ]);
        let mut scene = draft.camera(eye.as_dvec3().to_array(), [0.0; 3]).finish("plane");
        scene.lights.surround(map.clone().into());
        let shown = render(&scene, &settings()).color()[6 * 16 + 8];
        assert!((shown[0] - expected).abs() < 0.04, "{normal}: {shown:?}, not {expected}");
        // What is set counts instead.
        scene.lights.ambient = Some(Vec3::splat(0.3));
        let shown = render(&scene, &settings()).color()[6 * 16 + 8];
        assert!((shown[0] - 0.3).abs() < 1e-5, "{normal}: {shown:?}");
    }
}

#[test]
fn a_ground_shows_what_is_behind_it_less_the_shadow_of_the_sun() {
    let draft = SceneDraft::new().cuboid([-0.4, 0.0, -0.4], [0.4, 1.5, 0.4]).camera([0.5, 3.0, 4.0], [0.0, 0.4, 0.0]);
    let mut scene = draft.finish("box");
    let sky = Sky::clear(SunPosition { elevation: 35.0, azimuth: 250.0 });
    scene.lights.surround(sky.surroundings(Up::Y).unwrap());
    let open = render(&scene, &settings().with_mode(Mode::RayTrace));
    scene.add_ground(Up::Y);
    let caught = render(&scene, &settings().with_mode(Mode::RayTrace));
    // Where the ground gets all of its light it is not seen; in the shadow there is a part of what is behind.
    let same = |(a, b): &(&[f32; 3], &[f32; 3])| Vec3::from(**a).distance(Vec3::from(**b)) < 1e-5;
    let pairs = || open.color().iter().zip(caught.color());
    let unchanged = pairs().filter(same).count();
    let darker = pairs().filter(|(a, b)| b[1] < 0.7 * a[1] && b[1] > 0.02 * a[1]).count();
    assert!(unchanged > 100 && darker > 3 && unchanged + darker >= 16 * 12 - 12, "{unchanged} {darker}");
}

#[test]
fn the_sun_is_seen_and_lights() {
    let sky = Sky::clear(SunPosition { elevation: 20.0, azimuth: 0.0 });
    let surroundings = sky.surroundings(Up::Y).unwrap();
    let toward = surroundings.environment.sun().unwrap().direction;
    let mut scene = SceneDraft::new().camera([0.0; 3], toward.as_dvec3().to_array()).floor(-1.0, 1.0).finish("sun");
    scene.lights.surround(surroundings);
    assert_eq!(scene.lights.len(), 1);
    let frame = render(&scene, &settings().with_size([401, 301]).with_aa(4));
    let (width, color) = (401, frame.color());
    let [middle, beside] = [color[150 * width + 200][1], color[150 * width + 220][1]];
    assert!(middle > 1000.0 * beside && beside > 0.1, "{middle} {beside}");
    let environment = Arc::clone(scene.lights.environment.as_ref().unwrap());
    assert_eq!(environment.name, "clear sky");
    assert_eq!(scene.to_local(DVec3::ZERO), Vec3::ZERO);
}
