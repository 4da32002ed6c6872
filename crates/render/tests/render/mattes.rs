//! Numbers and mattes of objects and materials.

use glam::Vec3;
use lightmesh_image::Matte;
use lightmesh_render::{Crop, Frame, Settings, Sharing};
use lightmesh_scene::{Material, Scene, Up};
use lightmesh_testkit::{BALL_LIGHT, SceneDraft, TECHNIQUES, render};

const SIZE: [u32; 2] = [40, 30];

/// A floor and two boxes, by three names; two of three materials have one name.
fn scene() -> Scene {
    let draft = SceneDraft::new().floor(0.0, 2.0).painted(Material::default().named("paint"));
    let draft = draft.cuboid([-0.5, 0.0, -0.5], [0.5, 0.7, 0.5]).painted(Material::default().named("paint"));
    let draft = draft.cuboid([0.8, 0.0, -0.4], [1.2, 0.5, 0.4]).light(BALL_LIGHT);
    let mut scene = draft.camera([3.0, 2.0, 3.0], [0.0, 0.3, 0.0]).finish("named");
    let objects = &mut scene.geometry_mut().mesh.objects;
    *objects = lightmesh_scene::Objects::default();
    for (first, name) in [(0, "floor"), (2, "box"), (14, "door"), (20, "box")] {
        objects.begin(first, name);
    }
    scene
}

fn mattes(frame: &Frame) -> [&Matte; 2] {
    let layers = frame.layers().unwrap();
    [&layers.object, &layers.material]
}

/// The sum of all shares by pixel.
fn covered(matte: &Matte) -> Vec<f32> {
    (1..=matte.names.len() as u32).map(|number| matte.of(number)).fold(vec![0.0; matte.nearest.len()], |sum, shares| {
        sum.iter().zip(shares).map(|(sum, share)| sum + share).collect()
    })
}

fn settings() -> Settings {
    Settings::default().with_size(SIZE).with_samples(4).with_layers(true).with_transparent(true)
}

#[test]
fn names_are_those_of_the_scene() {
    let frame = render(&scene(), &settings().with_aa(1));
    let [objects, materials] = mattes(&frame);
    assert_eq!(objects.names, ["floor", "box", "door"]);
    assert_eq!(materials.names, ["material 1", "paint"]);
    for matte in [objects, materials] {
        (1..=matte.names.len() as u32).for_each(|number| assert!(matte.nearest.contains(&number), "{number}"));
    }
}

#[test]
fn one_sample_sees_one_thing() {
    for (mode, lookup) in TECHNIQUES {
        let frame = render(&scene(), &settings().with_aa(1).with_mode(mode).with_lookup(lookup));
        for matte in mattes(&frame) {
            assert_eq!(matte.ranks.len(), 1);
            assert_eq!(matte.ranks[0].number, matte.nearest);
            assert_eq!(covered(matte), frame.image.alpha().unwrap());
        }
    }
}

#[test]
fn shares_are_those_of_samples_and_sum_up_to_alpha() {
    let scene = scene();
    for aa in [2, 6, 8, 32, 40] {
        for sharing in [Sharing::Unseen, Sharing::Never] {
            let frame = render(&scene, &settings().with_aa(aa).with_sharing(sharing));
            for matte in mattes(&frame) {
                assert_eq!(matte.ranks.len(), 6.min(aa as usize));
                for (pixel, (sum, alpha)) in covered(matte).iter().zip(frame.image.alpha().unwrap()).enumerate() {
                    assert!((sum - alpha).abs() < 1e-5, "{aa} {sharing:?}: pixel {pixel}: {sum} {alpha}");
                }
                for pair in matte.ranks.windows(2) {
                    assert!(pair[0].share.iter().zip(&pair[1].share).all(|(a, b)| a >= b));
                }
                for (rank, numbers) in matte.ranks.iter().map(|rank| (rank, &rank.number)) {
                    for (share, number) in rank.share.iter().zip(numbers) {
                        let count = share * aa as f32;
                        assert!((count - count.round()).abs() < 1e-4 && (*share > 0.0) == (*number > 0), "{share}");
                    }
                }
                // The nearest one is among them.
                for (pixel, &nearest) in matte.nearest.iter().enumerate() {
                    assert!(matte.of(nearest)[pixel] > 0.0 || nearest == 0);
                }
            }
        }
    }
}

/// More samples, nearer to the area that is seen.
#[test]
fn shares_are_areas() {
    let scene = scene();
    let with = |aa| render(&scene, &settings().with_aa(aa));
    let (reference, few) = (with(256), with(16));
    for (a, b) in mattes(&few).into_iter().zip(mattes(&reference)) {
        for number in 1..=a.names.len() as u32 {
            let pairs = a.of(number).into_iter().zip(b.of(number));
            let apart = pairs.clone().map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(apart < 0.3, "{number}: {apart}");
            let mean = pairs.map(|(a, b)| a - b).sum::<f32>() / (SIZE[0] * SIZE[1]) as f32;
            assert!(mean.abs() < 2e-3, "{number}: {mean}");
        }
    }
}

#[test]
fn a_part_has_the_mattes_of_the_whole() {
    let scene = scene();
    for aa in [1, 6, 40] {
        let whole = render(&scene, &settings().with_aa(aa));
        let part = render(&scene, &settings().with_aa(aa).with_crop(Crop::new([7, 5], [20, 11])));
        let expected = whole.image.cropped([7, 5], [20, 11]).unwrap();
        assert!(part.layers().unwrap().object == expected.layers().unwrap().object, "{aa}");
        assert!(part.layers().unwrap().material == expected.layers().unwrap().material, "{aa}");
    }
}

#[test]
fn a_ground_is_there_as_far_as_it_is_in_shadow() {
    let mut scene = scene();
    scene.lights.background = Some(Vec3::new(0.25, 0.5, 0.75));
    scene.add_ground(Up::Y);
    for aa in [1, 6, 40] {
        let frame = render(&scene, &settings().with_aa(aa));
        for matte in mattes(&frame) {
            assert_eq!(matte.names.last().unwrap(), "ground");
            for (sum, alpha) in covered(matte).iter().zip(frame.image.alpha().unwrap()) {
                assert!((sum - alpha).abs() < 1e-5, "{aa}: {sum} {alpha}");
            }
        }
        // Without transparency it is seen as what it is.
        let opaque = render(&scene, &settings().with_aa(aa).with_transparent(false));
        let [objects, _] = mattes(&opaque);
        let ground = objects.of(objects.names.len() as u32);
        assert!(ground.iter().filter(|share| **share == 1.0).count() > 100, "{aa}");
    }
}
