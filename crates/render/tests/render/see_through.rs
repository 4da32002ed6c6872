//! Surfaces that let rays through: what is behind them is seen as far as they are not opaque, through any number of them, also in mirrors.

use glam::{DVec3, Vec3};
use lightmesh_render::{Frame, Settings};
use lightmesh_scene::{Material, Opacity, Scene};
use lightmesh_testkit::{ACCELERATIONS, SceneDraft, glazed, pile, render};

use crate::{LAMP, POINT};

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
