//! A ground that catches shadows.

use glam::Vec3;
use lightmesh_render::{Settings, Sharing};
use lightmesh_scene::{LightKind, Scene, Up};
use lightmesh_testkit::{SceneDraft, TECHNIQUES, render};

const BACKGROUND: Vec3 = Vec3::new(0.2, 0.5, 0.9);

/// A table under so many lights that they are shaded in groups.
fn scene() -> Scene {
    let draft = SceneDraft::new().cuboid([-0.05, 0.0, -0.05], [0.05, 0.7, 0.05]);
    let draft = draft.cuboid([-0.5, 0.7, -0.5], [0.5, 0.75, 0.5]).ambient(0.1);
    let lights = (0..6).map(|index| {
        let (z, x) = (0.4 * index as f32).sin_cos();
        LightKind::Sphere { position: Vec3::new(x, 3.0, z), radius: 0.2 }
    });
    let draft = lights.fold(draft, SceneDraft::light).camera([1.0, 3.0, 4.0], [0.0, 0.2, 0.0]);
    let mut scene = draft.background(BACKGROUND).finish("box");
    scene.add_ground(Up::Y);
    scene
}

fn ways() -> Vec<Settings> {
    let settings = Settings::default().with_size([40, 30]).with_samples(16);
    let of_mode = |(mode, lookup)| {
        let settings = settings.clone().with_mode(mode).with_lookup(lookup).with_step(0.2);
        [settings.clone().with_aa(1), settings.clone().with_aa(6), settings.with_aa(6).with_sharing(Sharing::Never)]
    };
    TECHNIQUES.into_iter().flat_map(of_mode).collect()
}

#[test]
fn the_ground_shows_the_background_and_shadows_on_it() {
    let scene = scene();
    for settings in ways() {
        let frame = render(&scene, &settings);
        let corner = Vec3::from(frame.color()[0]);
        assert!(corner.distance(BACKGROUND) < 1e-5, "{settings:?}: {corner}");
        // Of its colour, but darker.
        let caught = |color: &&[f32; 3]| {
            let share = color[2] / BACKGROUND.z;
            share < 0.9 && Vec3::from(**color).distance(share * BACKGROUND) < 1e-4
        };
        assert!(frame.color().iter().filter(caught).count() > 12, "{settings:?}");
    }
}

#[test]
fn a_ground_that_nothing_surrounds_is_even_if_light_is_gathered() {
    let mut scene = scene();
    scene.lights.list.truncate(1);
    scene.lights.list[0].falloff = lightmesh_scene::Falloff::InverseSquare;
    let settings = Settings::default().with_size([40, 30]).with_samples(16).with_aa(1);
    let frame = render(&scene, &settings.with_ambient_light(lightmesh_render::AmbientSource::Mesh));
    for index in [0, 39, 29 * 40, 30 * 40 - 1] {
        let corner = Vec3::from(frame.color()[index]);
        assert!(corner.distance(BACKGROUND) < 1e-4, "{corner}");
    }
}

#[test]
fn what_is_transparent_gives_the_same_over_the_background() {
    let scene = scene();
    for settings in ways() {
        let opaque = render(&scene, &settings);
        let clear = render(&scene, &settings.clone().with_transparent(true));
        let alpha = clear.image.alpha().unwrap();
        assert_eq!((alpha[0], clear.color()[0]), (0.0, [0.0; 3]), "{settings:?}");
        let soft =
            alpha.iter().zip(clear.color()).filter(|(alpha, color)| (0.05..0.95).contains(*alpha) && color[0] < 1e-5);
        assert!(soft.count() > 12, "{settings:?}: shadows alone");
        for ((color, alpha), expected) in clear.color().iter().zip(alpha).zip(opaque.color()) {
            let over = Vec3::from(*color) + (1.0 - alpha) * BACKGROUND;
            assert!(over.distance(Vec3::from(*expected)) < 1e-5, "{settings:?}: {over} {expected:?}");
        }
    }
}
