//! Surfaces that let rays through: what is behind them is seen as far as they are not opaque, through any number of them, also in mirrors.

use glam::{DVec3, Vec3};
use lightmesh_render::{AmbientSource, Frame, Lookup, Mode, Settings, Unobserved};
use lightmesh_scene::{LightKind, Lights, Material, Opacity, Scene, Sky, SkyKind, Up};
use lightmesh_testkit::{ACCELERATIONS, Picture, SceneDraft, TECHNIQUES, glazed, pile, render};

use crate::{LAMP, POINT, prepared, renderer};

const SIZE: [u32; 2] = [24, 18];
const BACKGROUND: Vec3 = Vec3::new(0.5, 0.25, 1.0);
const AMBIENT: f32 = 0.5;

/// A pane of this material that faces the camera and fills the image, at this distance from it.
fn pane(draft: SceneDraft, material: Material, distance: f64) -> SceneDraft {
    let corner = |x: f64, y: f64| [9.0 * x, 9.0 * y, -distance];
    draft.painted(material).quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
}

/// Panes one behind the other, each of the material of its number.
fn panes(materials: &[Material]) -> Scene {
    let draft = SceneDraft::new().ambient(AMBIENT).background(BACKGROUND).camera([0.0; 3], [0.0, 0.0, -1.0]);
    let draft = materials
        .iter()
        .enumerate()
        .fold(draft, |draft, (index, material)| pane(draft, material.clone(), 1.0 + index as f64 / 8.0));
    draft.finish("panes")
}

fn settings() -> Settings {
    Settings::default().with_size(SIZE).with_aa(1)
}

/// The colour of all pixels, which must be the same up to rounding.
fn color(scene: &Scene, settings: &Settings) -> Vec3 {
    let frame = render(scene, settings);
    let first = Vec3::from(frame.color()[0]);
    assert!(frame.color().iter().all(|&color| Vec3::from(color).distance(first) < 1e-5), "one colour");
    first
}

fn black() -> Material {
    Material::matt(Vec3::ZERO)
}

#[test]
fn the_transmittances_of_a_stack_multiply() {
    let filters = [[1.0, 0.5, 0.25], [0.5, 1.0, 0.75], [0.9, 0.8, 1.0]].map(Vec3::from);
    let opacities = [0.0, 0.25, 0.5];
    let stack: Vec<Material> = filters
        .iter()
        .zip(opacities)
        .map(|(&filter, opacity)| black().with_opacity(Opacity::blend(opacity).with_filter(filter)))
        .collect();
    let expected = BACKGROUND * filters[0] * filters[1] * filters[2] * 0.75 * 0.5;
    let mut turned = stack.clone();
    turned.reverse();
    for acceleration in ACCELERATIONS {
        for aa in [1, 5] {
            let settings = settings().with_acceleration(acceleration.clone()).with_aa(aa);
            for stack in [&stack, &turned] {
                let seen = color(&panes(stack), &settings);
                assert!(seen.distance(expected) < 1e-5, "{acceleration:?}, {aa}: {seen} instead of {expected}");
            }
        }
    }
}

#[test]
fn a_pane_shows_its_share_of_itself_and_the_rest_of_what_is_behind() {
    let paint = |color: [f32; 3], opacity| Material::matt(color).with_opacity(Opacity::blend(opacity));
    let (front, back) = (Vec3::new(0.8, 0.2, 0.4), Vec3::new(0.1, 0.9, 0.3));
    let scene = panes(&[paint(front.into(), 0.25), paint(back.into(), 0.5)]);
    let expected = 0.25 * AMBIENT * front + 0.75 * (0.5 * AMBIENT * back + 0.5 * BACKGROUND);
    let seen = color(&scene, &settings());
    assert!(seen.distance(expected) < 1e-5, "{seen} instead of {expected}");
}

#[test]
fn a_hundred_clear_panes_are_no_wall() {
    // More surfaces than a ray goes through do not darken what is there before them.
    let clear = || black().with_opacity(Opacity::blend(1.0 / 255.0));
    let scene = panes(&vec![clear(); 50]);
    let expected = BACKGROUND * (254.0 / 255.0_f32).powi(50);
    let seen = color(&scene, &settings());
    assert!(seen.distance(expected) < 1e-4, "{seen} instead of {expected}");
}

#[test]
fn mirrors_are_seen_through_panes_and_panes_in_mirrors() {
    // Through the pane, reflected, through the pane again, and past the camera to the background.
    let half = black().with_opacity(Opacity::blend(0.5));
    let scene = panes(&[half, black().with_ks([0.5; 3])]);
    let seen = |bounces| color(&scene, &settings().with_bounces(bounces));
    assert!(seen(1).distance(0.125 * BACKGROUND) < 1e-5, "{}", seen(1));
    assert_eq!(seen(0), Vec3::ZERO, "panes are no mirrors");
    // A pane that mirrors: half of it shows what is in front of it, the other half the mirror behind.
    let scene = panes(&[black().with_ks([1.0; 3]).with_opacity(Opacity::blend(0.5)), black().with_ks([1.0; 3])]);
    let seen = |bounces| color(&scene, &settings().with_bounces(bounces));
    assert!(seen(1).distance((0.5 + 0.5 * 0.5) * BACKGROUND) < 1e-5, "{}", seen(1));
    // Between the two, one more reflection of half of that, and so on.
    assert!(seen(2).distance(0.75 * BACKGROUND) < 1e-5, "{}", seen(2));
    assert!(seen(3).distance((0.75 + 0.125) * BACKGROUND) < 1e-5, "{}", seen(3));
}

/// The share of the light from all sides that is seen through `count` panes, each of which mirrors `mirrored` of it and lets the rest through, by
/// ways on which it is mirrored up to `most` times.
fn seen_through_mirrors(count: usize, mirrored: f64, most: usize) -> f64 {
    // What is under way from the camera, before each pane, by how often it was mirrored; and the same on the way back.
    let (mut seen, mut there, mut back) =
        (0.0, vec![vec![0.0; most + 1]; count + 1], vec![vec![0.0; most + 1]; count + 1]);
    there[0][0] = 1.0;
    for _ in 0..200 {
        let (mut next_there, mut next_back) =
            (vec![vec![0.0; most + 1]; count + 1], vec![vec![0.0; most + 1]; count + 1]);
        for bounces in 0..=most {
            seen += there[count][bounces] + back[0][bounces];
            for pane in 0..count {
                let (on, off) = (there[pane][bounces], back[pane + 1][bounces]);
                next_there[pane + 1][bounces] += (1.0 - mirrored) * on;
                next_back[pane][bounces] += (1.0 - mirrored) * off;
                if bounces < most {
                    next_back[pane][bounces + 1] += mirrored * on;
                    next_there[pane + 1][bounces + 1] += mirrored * off;
                }
            }
        }
        (there, back) = (next_there, next_back);
    }
    seen
}

#[test]
fn faint_ways_between_panes_count_as_much_as_they_do() {
    let glass = || black().with_ks([1.0; 3]).with_opacity(Opacity::blend(0.1));
    for (count, bounces) in [(2, 1), (6, 2), (12, 4)] {
        let scene = panes(&vec![glass(); count]);
        let expected = seen_through_mirrors(count, 0.1, bounces as usize) as f32 * BACKGROUND;
        for aa in [1, 4] {
            let frame = render(&scene, &settings().with_bounces(bounces).with_aa(aa));
            let colors = frame.color().iter().map(|&color| Vec3::from(color));
            let mean = colors.clone().sum::<Vec3>() / colors.len() as f32;
            let most = colors.map(|color| (color - expected).abs().max_element()).fold(0.0, f32::max);
            // The mean of pixels that each err by about 0.01.
            assert!((mean - expected).abs().max_element() < 2e-3, "{count}, {aa}: {mean} instead of {expected}");
            // Up to 64 depths with a standard deviation of 0.4/256 each.
            assert!(most < 0.08, "{count}, {aa}: a pixel errs by {most}");
        }
    }
}

#[test]
fn a_transparent_image_is_covered_as_far_as_surfaces_are_opaque() {
    let tinted = Opacity::blend(0.5).with_filter([0.5, 1.0, 0.75]);
    let scene = panes(&[black().with_opacity(Opacity::blend(0.25)), black().with_opacity(tinted)]);
    for aa in [1, 4] {
        let settings = settings().with_aa(aa).with_transparent(true);
        let frame = render(&scene, &settings);
        let alpha = frame.image.alpha().expect("the background is transparent");
        assert!(alpha.iter().all(|alpha| (alpha - (1.0 - 0.75 * 0.5 * 0.75)).abs() < 1e-5), "{aa}: {}", alpha[0]);
        let black = |frame: &Frame| frame.color().iter().flatten().all(|channel| *channel < 1e-5);
        assert!(black(&frame), "{aa}: the background is taken out: {:?}", frame.color()[0]);
    }
}

#[test]
fn opaque_is_opaque_and_what_is_clear_is_not_there() {
    let solid = |opacity: Option<Opacity>| {
        panes(&[opacity.map_or(black(), |opacity| black().with_opacity(opacity)), Material::matt([0.3; 3])])
    };
    let same = |a: &Scene, b: &Scene| render(a, &settings()).color() == render(b, &settings()).color();
    assert!(same(&solid(Some(Opacity::blend(1.0))), &solid(None)));
    assert!(same(&solid(Some(Opacity::blend(0.0))), &panes(&[Material::matt([0.3; 3])])));
}

#[test]
fn every_structure_shows_the_same_bits() {
    let scene = glazed(pile(DVec3::ZERO, &[LAMP, POINT]));
    for aa in [1, 4] {
        let settings = settings().with_size([48, 36]).with_aa(aa).with_bounces(2).with_layers(true);
        let frames = ACCELERATIONS.map(|it| render(&scene, &settings.clone().with_acceleration(it)));
        assert!(frames.iter().all(|frame| frame.color() == frames[0].color()), "{aa}");
    }
}

/// A floor under a lamp, and panes one over the other between the two, of which the camera sees nothing but their shadow.
fn shaded(light: LightKind, materials: &[Material]) -> Scene {
    let draft = SceneDraft::new().floor(0.0, 20.0).light(light).orthographic([0.0, 0.5, 0.0], [0.0; 3], 2.0);
    let draft = materials.iter().enumerate().fold(draft, |draft, (index, material)| {
        let height = 1.0 + index as f64 / 4.0;
        let corner = |x: f64, z: f64| [4.0 * x, height, 4.0 * z];
        draft.painted(material.clone()).quad([
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ])
    });
    draft.finish("shaded")
}

/// Settings of every technique, without antialiasing.
fn techniques() -> impl Iterator<Item = (String, Settings)> {
    TECHNIQUES.into_iter().map(|(mode, lookup)| {
        let settings = Settings::default().with_mode(mode).with_lookup(lookup).with_size(SIZE).with_samples(16);
        let settings = settings.with_step(lightmesh_render::Step::Fixed(0.15)).with_radius(2.1).with_aa(1);
        (format!("{mode:?}, {lookup:?}"), settings)
    })
}

#[test]
fn what_is_behind_panes_gets_what_they_leave_of_the_light() {
    let pane = |opacity, filter: [f32; 3]| black().with_opacity(Opacity::blend(opacity).with_filter(filter));
    let stack = [pane(0.25, [1.0, 0.5, 0.25]), pane(0.5, [0.5, 1.0, 1.0])];
    let left = 0.75 * 0.5 * Vec3::new(0.5, 0.5, 0.25);
    for (name, settings) in techniques() {
        for light in [POINT, LAMP] {
            let lit = render(&shaded(light.clone(), &[]), &settings);
            for acceleration in ACCELERATIONS {
                let seen = render(&shaded(light.clone(), &stack), &settings.clone().with_acceleration(acceleration));
                for (seen, lit) in seen.color().iter().zip(lit.color()) {
                    let (seen, lit) = (Vec3::from(*seen), Vec3::from(*lit));
                    assert!(lit.min_element() > 0.01, "{name}: the floor is lit");
                    assert!((seen - left * lit).abs().max_element() < 1e-4, "{name}: {seen}, not {left} of {lit}");
                }
            }
        }
    }
}

#[test]
fn filtered_light_is_a_mean_over_the_samples_that_nothing_hides() {
    // Half of the lamp is behind a wall, whatever part of it is behind a pane.
    let scene = glazed(pile(DVec3::ZERO, &[LAMP, POINT]));
    for samples in [5, 64, 330] {
        let settings = settings().with_size([40, 30]).with_samples(samples).with_layers(true);
        let lists = render(&scene, &settings.clone().with_lookup(Lookup::Lists));
        let area = render(&scene, &settings.clone().with_mode(Mode::Area));
        assert!(lists.color() == area.color(), "{samples}");
        let seen = |light: usize| Picture::new(&area).visibilities(light);
        let solid = render(&pile(DVec3::ZERO, &[LAMP, POINT]), &settings.with_mode(Mode::Area));
        let more = seen(0).iter().sum::<f32>() > Picture::new(&solid).visibilities(0).iter().sum::<f32>();
        assert!(more && seen(0).iter().all(|share| (0.0..=1.0).contains(share)), "{samples}: light goes through");
    }
}

/// The floor and its panes seen from above all panes, through them.
fn seen_from_above(light: LightKind, materials: &[Material]) -> Scene {
    let mut scene = shaded(light, materials);
    scene.cameras[0].position = Vec3::new(0.0, 3.5, 0.0);
    scene
}

#[test]
fn a_surface_behind_many_panes_gets_what_they_leave_by_few_samples() {
    // A quarter of the samples behind two panes, a sixteenth behind five; all of them lose as much.
    for count in [1, 2, 5] {
        let stack = vec![black().with_opacity(Opacity::blend(0.5).with_filter([1.0, 0.9, 0.8])); count];
        let left = Vec3::new(0.5, 0.45, 0.4).powf(2.0 * count as f32);
        for (name, settings) in techniques() {
            for light in [POINT, LAMP] {
                let lit = render(&seen_from_above(light.clone(), &[]), &settings);
                let seen = render(&seen_from_above(light.clone(), &stack), &settings);
                for (seen, lit) in seen.color().iter().zip(lit.color()) {
                    let (seen, lit) = (Vec3::from(*seen), Vec3::from(*lit));
                    assert!(lit.min_element() > 0.01, "{name}: the floor is lit");
                    assert!(
                        (seen - left * lit).abs().max_element() < 1e-4,
                        "{name}, {count}: {seen}, not {left} of {lit}"
                    );
                }
            }
        }
    }
}

/// Surfaces of little opacity one over the other, partly in the shadow of a wall and in that of a darker pane.
fn veils(count: usize) -> Scene {
    let veil = Material::matt(Vec3::ONE).with_opacity(Opacity::blend(0.05));
    let corners =
        |height: f64, from: f64| [[from, height, -4.0], [from, height, 4.0], [4.0, height, 4.0], [4.0, height, -4.0]];
    let draft = SceneDraft::new().floor(0.0, 20.0).light(LAMP).orthographic([0.0, 2.2, 0.0], [0.0; 3], 2.0);
    let draft = draft.painted(veil);
    let draft = (0..count).fold(draft, |draft, index| draft.quad(corners(0.5 + index as f64 / 32.0, -4.0)));
    let draft = draft.painted(black().with_opacity(Opacity::blend(0.6))).quad(corners(2.5, -1.2));
    draft.painted(black()).quad(corners(3.0, -1.0)).finish("veils")
}

#[test]
fn few_samples_find_the_mean_light_of_veils() {
    let seen = |samples| render(&veils(20), &settings().with_samples(samples));
    let (few, many) = (seen(16), seen(1024));
    let mean = |frame: &Frame| frame.color().iter().map(|color| color[1]).sum::<f32>() / frame.color().len() as f32;
    assert!((mean(&few) / mean(&many) - 1.0).abs() < 0.01, "{} instead of {}", mean(&few), mean(&many));
    // No more noise than a surface has with 16 samples: half of one of them in penumbrae, of a light of about 1.
    let worst = few.color().iter().zip(many.color()).map(|(few, many)| (few[1] - many[1]).abs()).fold(0.0, f32::max);
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn rays_to_lights_are_as_few_as_what_veils_show() {
    let rays =
        |count| render(&veils(count), &settings().with_mode(Mode::Area).with_samples(64)).stats.counts.shadow_rays;
    let (few, many) = (rays(1), rays(21));
    // Those of the technique, 64 from each veil, and less than a tenth of them through panes.
    let pixels = u64::from(SIZE[0] * SIZE[1]);
    assert!(many - few <= 20 * pixels * 64 * 11 / 10, "{few} and {many}");
}

#[test]
fn given_points_get_what_panes_leave() {
    let pane = black().with_opacity(Opacity::blend(0.25).with_filter([1.0, 0.5, 0.75]));
    let scene = prepared(&shaded(POINT, &[pane]));
    let points = [Vec3::new(0.1, 0.0, 0.2), Vec3::new(0.1, 1.5, 0.2)];
    for (name, settings) in techniques() {
        let baked = renderer().visibility(&scene, &points, &[Vec3::Y; 2], &settings, &Unobserved).unwrap();
        // The mean of its channels; nothing is above the second one.
        let expected = [0.75 * 0.75, 1.0];
        for (point, expected) in expected.into_iter().enumerate() {
            assert!((baked.of(0, point) - expected).abs() < 1e-5, "{name}: {}", baked.of(0, point));
        }
    }
}

#[test]
fn a_sky_reaches_what_is_below_a_pane_unless_it_is_rather_opaque() {
    let under = |opacity: Option<Opacity>| {
        let roof = opacity.map_or(black(), |opacity| black().with_opacity(opacity));
        let mut scene = shaded(POINT, &[roof]);
        scene.lights = Lights::default();
        scene.lights.surround(Sky::new(SkyKind::Uniform { color: Vec3::ONE }).surroundings(Up::Y).unwrap());
        scene.lights.list.clear();
        render(&scene, &settings().with_ambient_light(AmbientSource::Mesh))
    };
    let seen = |opacity| under(Some(Opacity::blend(opacity))).color().to_vec();
    let solid = under(None);
    assert!(seen(0.5) == solid.color() && seen(0.75) == solid.color());
    assert!(seen(0.25) == seen(0.0));
    let brightness = |colors: &[[f32; 3]]| colors.iter().map(|color| color[1]).sum::<f32>() / colors.len() as f32;
    let (open, covered) = (brightness(&seen(0.25)), brightness(solid.color()));
    // The floor reflects 0.8 of what it receives.
    assert!((open - 0.8).abs() < 1e-4 && covered < 0.1, "{open} and {covered}");
}
