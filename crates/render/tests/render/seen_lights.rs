//! Lights that rays see as surfaces.

use std::f32::consts::PI;

use glam::Vec3;
use lightmesh_render::Settings;
use lightmesh_scene::{Dielectric, Facets, Falloff, Light, LightKind, Material, Scene};
use lightmesh_testkit::{MODES, SceneDraft, render};

const KR: f32 = 0.75;
/// Where the mirrored axis of the camera meets the plane y = 2, and the way there from the mirror.
const PLACE: Vec3 = Vec3::new(2.0, 2.0, 0.0);
const FROM: Vec3 = Vec3::new(0.0, 0.0, 0.1);

/// Red, green and blue.
const INTENSITY: Vec3 = Vec3::new(3.0, 1.0, 0.5);

fn mirror() -> Material {
    Material::matt(Vec3::ZERO).with_ks([KR; 3])
}

fn floor() -> SceneDraft {
    SceneDraft::new().painted(mirror()).floor(0.0, 4.0).camera([-2.0, 2.0, 0.2], FROM.as_dvec3().to_array())
}

fn lit(draft: SceneDraft, lights: impl IntoIterator<Item = Light>) -> Scene {
    let mut scene = draft.ambient(0.0).background(Vec3::ZERO).finish("seen lights");
    let local = |light: Light| match light.position() {
        Some(position) => light.at(scene.to_local(position.as_dvec3())),
        None => light,
    };
    scene.lights.list = lights.into_iter().map(local).collect();
    scene
}

/// What the camera sees along its axis, in all modes.
fn seen_with(scene: &Scene, bounces: u32) -> Vec3 {
    let colors = MODES.map(|mode| {
        let settings = Settings::default().with_aa(1).with_mode(mode).with_size([1, 1]).with_bounces(bounces);
        Vec3::from_array(render(scene, &settings).image.color()[0])
    });
    assert!(colors.iter().all(|color| *color == colors[0]), "{colors:?}");
    colors[0]
}

fn seen(scene: &Scene) -> Vec3 {
    seen_with(scene, 1)
}

/// A square of area 1 that shines down from above the mirror.
fn panel(position: Vec3) -> Light {
    let light = Light::rectangle(position, 0.5 * Vec3::X, 0.5 * Vec3::Z).unwrap();
    light.with_intensity(INTENSITY).with_falloff(Falloff::InverseSquare)
}

fn assert_near(seen: Vec3, expected: Vec3, what: &str) {
    assert!((seen - expected).abs().max_element() <= 1e-4 * expected.max_element(), "{what}: {seen}, not {expected}");
}

#[test]
fn a_mirror_shows_the_radiance_of_a_panel() {
    assert_eq!(seen(&lit(floor(), [panel(PLACE)])), KR * INTENSITY);
    // To its edge.
    assert_eq!(seen(&lit(floor(), [panel(PLACE + 0.49 * Vec3::X)])), KR * INTENSITY);
    // Whatever its falloff, it lights surfaces as it does.
    let even = panel(PLACE).with_falloff(Falloff::None);
    assert_near(seen(&lit(floor(), [even])), KR * PI * PLACE.distance_squared(FROM) * INTENSITY, "no falloff");
}

#[test]
fn beside_the_image_of_a_panel_there_is_nothing() {
    // Nor is there a highlight, which the image replaces.
    assert_eq!(seen(&lit(floor(), [panel(PLACE + 0.51 * Vec3::X)])), Vec3::ZERO);
    let scene = lit(floor(), [panel(PLACE)]);
    assert!(seen_with(&scene, 0).min_element() > 0.0, "there is a highlight where mirrors are not followed");
}

#[test]
fn every_light_with_an_area_is_seen() {
    let way = PLACE - FROM;
    let (square, toward) = (way.length_squared(), way.normalize());
    let per_area = KR / (PI * 0.25) * INTENSITY;
    let spot = |outer: f32| Light::spot(PLACE, -toward, 0.1, outer).unwrap().with_radius(0.5);
    let sun = Light::directional(-toward).unwrap().with_angle(0.2);
    let sine = 0.1_f32.sin();
    let both = panel(PLACE).with_one_sided(false);
    let cases = [
        ("both sides", both, KR / toward.y * INTENSITY, 1.0),
        ("disk", Light::disk(PLACE, Vec3::NEG_Y, 0.5).unwrap(), per_area, square),
        ("sphere", Light::sphere(PLACE, 0.5).unwrap(), per_area, square),
        ("spot", spot(0.2), per_area, square),
        ("sun", sun, KR / (PI * sine * sine) * INTENSITY, 1.0),
    ];
    for (name, light, expected, square) in cases {
        let square = if name == "both sides" { way.length_squared() } else { square };
        let light = light.with_intensity(INTENSITY).with_falloff(Falloff::InverseSquare);
        assert_near(seen(&lit(floor(), [light.clone()])), expected, name);
        let even = light.with_falloff(Falloff::None);
        assert_near(seen(&lit(floor(), [even])), PI * square * expected, name);
    }
    // A spot whose cone points elsewhere.
    let aside = Light::spot(PLACE, Vec3::X, 0.1, 0.2).unwrap().with_radius(0.5).with_intensity(INTENSITY);
    assert_eq!(seen(&lit(floor(), [aside])), Vec3::ZERO);
    // Points have no area, but a highlight.
    let point = Light::point(PLACE).with_spread(0.5).with_intensity(INTENSITY);
    assert_near(seen(&lit(floor(), [point])), KR * INTENSITY, "point");
}

#[test]
fn what_is_in_front_of_a_light_hides_it() {
    let between = [0.9, 0.9, -0.2];
    let hidden = floor().painted(Material::matt(Vec3::ZERO)).cuboid(between, [1.1, 1.1, 0.3]);
    assert_eq!(seen(&lit(hidden, [panel(PLACE)])), Vec3::ZERO);
    // In a ceiling it is in front.
    let ceiling = floor().painted(Material::matt(Vec3::ZERO)).floor(2.0, 4.0);
    assert_eq!(seen(&lit(ceiling, [panel(PLACE)])), KR * INTENSITY);
}

/// A wall that glows green behind the panel.
fn before_a_wall() -> SceneDraft {
    let wall = Material::matt(Vec3::ZERO).with_emission([0.0, 0.5, 0.0]).with_ks([1.0; 3]);
    floor().painted(wall).quad([[3.0, -5.0, -5.0], [3.0, 5.0, -5.0], [3.0, 5.0, 5.0], [3.0, -5.0, 5.0]])
}

#[test]
fn a_light_hides_what_is_behind_it_but_from_behind_nothing() {
    let behind = panel(PLACE).with_visible(true);
    assert_eq!(seen_with(&lit(before_a_wall(), [behind]), 4), KR * INTENSITY);
    // From behind.
    let Light { kind: LightKind::Rectangle { position, half_u, half_v }, .. } = panel(PLACE) else { unreachable!() };
    let turned = Light::rectangle(position, half_u, -half_v).unwrap().with_intensity(INTENSITY);
    assert_near(seen(&lit(before_a_wall(), [turned])), KR * Vec3::new(0.0, 0.5, 0.0), "from behind");
}

#[test]
fn the_nearest_light_is_seen() {
    let near = panel(FROM + 0.5 * (PLACE - FROM)).with_intensity([0.0, 0.0, 7.0]);
    let sun = Light::directional(-(PLACE - FROM)).unwrap().with_angle(0.1);
    for lights in [[near.clone(), panel(PLACE), sun.clone()], [sun, panel(PLACE), near]] {
        assert_eq!(seen(&lit(floor(), lights)), KR * Vec3::new(0.0, 0.0, 7.0));
    }
}

/// The camera looks down at a panel that shines up, through a pane if there is one.
fn above(pane: bool) -> SceneDraft {
    let draft = SceneDraft::new().camera([0.0, 3.0, 0.0], [0.0, 0.0, 0.0]);
    let glass = Material::of(Dielectric::new(1.5).with_thin(true));
    let draft = if pane { draft.painted(glass).floor(1.5, 4.0) } else { draft };
    // So that there is a surface in any case.
    draft.painted(Material::matt(Vec3::ZERO)).floor(-1.0, 4.0)
}

#[test]
fn a_light_is_seen_through_a_pane() {
    let panel = Light::rectangle(Vec3::ZERO, 0.5 * Vec3::Z, 0.5 * Vec3::X).unwrap().with_intensity(INTENSITY);
    let panel = panel.with_falloff(Falloff::InverseSquare);
    // Fresnel, and again and again inside the pane.
    let once = 0.04_f32;
    let left = 1.0 - 2.0 * once / (1.0 + once);
    assert_near(seen_with(&lit(above(true), [panel.clone()]), 0), left * INTENSITY, "through a pane");
    // The camera itself sees it if it is told to.
    assert_eq!(seen(&lit(above(false), [panel.clone()])), Vec3::ZERO);
    let visible = lit(above(false), [panel.with_visible(true)]);
    assert_eq!(seen(&visible), INTENSITY);
}

#[test]
fn smooth_metal_shows_a_light_without_a_highlight() {
    let chrome = Material::matt(Vec3::ONE).with_facets(Facets::new(0.0).with_metallic(1.0));
    let floor = || {
        SceneDraft::new().painted(chrome.clone()).floor(0.0, 4.0).camera([-2.0, 2.0, 0.2], FROM.as_dvec3().to_array())
    };
    assert_near(seen(&lit(floor(), [panel(PLACE)])), INTENSITY, "chrome");
    assert_eq!(seen(&lit(floor(), [panel(PLACE + 0.51 * Vec3::X)])), Vec3::ZERO);
}

/// However small lights are in an image, what it shows of them is the same.
#[test]
fn small_lights_are_as_bright_as_large_ones() {
    let lights = [
        Light::rectangle(Vec3::new(0.3, 0.1, 0.2), Vec3::new(0.01, 0.05, 0.02), Vec3::new(0.04, 0.0, -0.02)).unwrap(),
        Light::disk(Vec3::new(-0.4, 0.0, 0.3), Vec3::new(0.5, 1.0, 0.2), 0.05).unwrap(),
        Light::sphere(Vec3::new(0.1, 0.2, -0.4), 0.04).unwrap(),
        Light::directional(Vec3::new(-0.1, 1.0, -0.05)).unwrap().with_angle(0.02),
    ];
    for light in lights {
        let light = light.with_intensity(INTENSITY).with_falloff(Falloff::InverseSquare).with_visible(true);
        let draft = SceneDraft::new().camera([0.0, 3.0, 0.0], [0.01, 0.0, 0.02]);
        // A surface that is not in sight.
        let scene = lit(draft.painted(Material::matt(Vec3::ZERO)).floor(5.0, 0.1), [light.clone()]);
        let mean = |side: u32| {
            let frame = render(&scene, &Settings::default().with_size([side; 2]));
            frame.color().iter().map(|color| Vec3::from_array(*color)).sum::<Vec3>() / (side * side) as f32
        };
        let [few, many] = [mean(15), mean(256)];
        assert!(many.x > 0.0 && (few / many - 1.0).abs().max_element() < 0.1, "{light:?}: {few}, {many}");
    }
}

#[test]
fn what_does_not_shine_is_not_seen() {
    assert_eq!(seen(&lit(before_a_wall(), [panel(PLACE).with_intensity(Vec3::ZERO)])), KR * Vec3::new(0.0, 0.5, 0.0));
}
