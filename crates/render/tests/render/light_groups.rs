//! The radiance of each light by itself.

use glam::Vec3;
use lightmesh_render::{Crop, Settings, Sharing};
use lightmesh_scene::{LightKind, Material, Scene, Up};
use lightmesh_testkit::{Picture, SceneDraft, TECHNIQUES, render};

use crate::renderer;

const SIZE: [u32; 2] = [40, 30];

/// A box that mirrors on a floor, before a blue background, under lights of several colours: more than a group has.
fn scene(lights: usize) -> Scene {
    let mirror = Material::default().with_ks([0.4, 0.3, 0.2]).with_emission([0.0, 0.125, 0.0]);
    let draft = SceneDraft::new().floor(0.0, 2.0).painted(mirror).cuboid([-0.5, 0.0, -0.5], [0.5, 0.7, 0.5]);
    let lamps = (0..lights).map(|index| {
        let (z, x) = (0.9 * index as f32).sin_cos();
        LightKind::Sphere { position: Vec3::new(2.0 * x, 3.0, 2.0 * z), radius: 0.2 }
    });
    let draft = lamps.fold(draft.ambient(0.1), SceneDraft::light).camera([1.0, 2.0, 4.0], [0.0, 0.3, 0.0]);
    let mut scene = draft.background(Vec3::new(0.25, 0.5, 0.75)).finish("lights");
    for (index, light) in scene.lights.list.iter_mut().enumerate() {
        light.intensity = Vec3::from([0, 1, 2].map(|channel| 0.2 + 0.2 * ((index + channel) % 3) as f32));
    }
    scene
}

fn ways() -> Vec<Settings> {
    let settings = Settings::default().with_size(SIZE).with_samples(9).with_layers(true).with_bounces(2);
    let of_mode = |(mode, lookup)| {
        let settings = settings.clone().with_mode(mode).with_lookup(lookup).with_step(0.3);
        [settings.clone().with_aa(1), settings.clone().with_aa(5), settings.with_aa(10).with_sharing(Sharing::Never)]
    };
    TECHNIQUES.into_iter().flat_map(of_mode).collect()
}

#[test]
fn groups_add_up_to_the_image() {
    let (open, mut caught) = (scene(6), scene(6));
    caught.add_ground(Up::Y);
    for settings in ways() {
        for (scene, transparent) in [(&open, false), (&open, true), (&caught, false), (&caught, true)] {
            let frame = render(scene, &settings.clone().with_transparent(transparent));
            assert_eq!(Picture::new(&frame).ungrouped(), None, "{settings:?} {transparent}");
            let layers = frame.layers().unwrap();
            assert_eq!(layers.lights.len(), 6);
            for (light, plane) in layers.lights.iter().enumerate() {
                assert!(plane.iter().any(|color| color[0] > 0.01), "{settings:?}: light {light} is seen");
            }
        }
    }
}

/// Each light alone, without anything that belongs to none, gives its group.
#[test]
fn a_group_is_an_image_with_one_light() {
    let scene = scene(5);
    for settings in ways().into_iter().filter(|settings| settings.aa == Some(1)) {
        let frame = render(&scene, &settings);
        let layers = frame.layers().unwrap();
        for light in [0, 3, 4] {
            let mut alone = scene.clone();
            alone.lights.ambient = Some(Vec3::ZERO);
            alone.lights.background = None;
            for (_, other) in alone.lights.list.iter_mut().enumerate().filter(|(index, _)| *index != light) {
                other.intensity = Vec3::ZERO;
            }
            alone.geometry_mut().materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
            let expected = render(&alone, &settings);
            for (pixel, (found, expected)) in layers.lights[light].iter().zip(expected.color()).enumerate() {
                let apart = Vec3::from(*found).distance(Vec3::from(*expected));
                assert!(apart < 1e-6, "{settings:?}: light {light}, pixel {pixel}: {found:?} {expected:?}");
            }
        }
    }
}

#[test]
fn a_part_has_the_groups_of_the_whole() {
    let scene = scene(5);
    for settings in ways() {
        let whole = render(&scene, &settings);
        let part = render(&scene, &settings.clone().with_crop(Crop::new([7, 5], [20, 11])));
        let expected = whole.image.cropped([7, 5], [20, 11]).unwrap();
        assert!(part.layers() == expected.layers(), "{settings:?}");
    }
}

#[test]
fn only_layers_have_groups() {
    let settings = Settings::default().with_size([8, 8]).with_aa(1).with_transparent(true);
    assert!(renderer().render(&scene(1), &settings).unwrap().layers().is_none());
    let none = render(&scene(0), &settings);
    let layers = none.layers().unwrap();
    assert!(layers.lights.is_empty() && layers.rest == none.color());
}
