//! Formula (1) with known answers: one pixel, on the camera's axis.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;
use lightmesh_render::{Frame, Mode, Settings};
use lightmesh_scene::{Falloff, LightKind, Material};
use lightmesh_testkit::{MODES, Picture, SceneDraft, render};

/// A dozen operations in `f32`, and positions accurate to 1e-6.
const ROUNDING: f32 = 2e-6;

fn matt(kd: f32) -> Material {
    Material::matt([kd; 3]).with_ka([0.5; 3])
}

/// A floor seen along (1, -1, 0) at the origin.
fn floor(material: Material) -> SceneDraft {
    SceneDraft::new().painted(material).floor(0.0, 20.0).camera([-2.0, 2.0, 0.0], [0.0; 3])
}

fn pixel(draft: SceneDraft, mode: Mode) -> Frame {
    render(&draft.finish("one pixel"), &Settings::default().with_aa(1).with_mode(mode).with_size([1, 1]))
}

/// The grey value of the pixel in all modes, which must agree, since nothing casts a shadow.
fn grey(draft: impl Fn() -> SceneDraft) -> f32 {
    let values = MODES.map(|mode| pixel(draft(), mode).image.color()[0]);
    for [r, g, b] in values {
        assert!(r == g && g == b && (r - values[0][0]).abs() <= ROUNDING, "{values:?}");
    }
    values[0][0]
}

fn assert_near(value: f32, expected: f32) {
    assert!((value - expected).abs() <= ROUNDING * expected.max(1.0), "{value} instead of {expected}");
}

fn point(position: [f32; 3]) -> LightKind {
    LightKind::Point { position: Vec3::from(position), spread: 0.0 }
}

#[test]
fn the_diffuse_term_is_the_cosine() {
    assert_near(grey(|| floor(matt(0.7)).point_light([0.0, 3.0, 0.0])), 0.7);
    assert_near(grey(|| floor(matt(0.7)).point_light([0.0, 3.0, -4.0])), 0.7 * 0.6);
    // Two lights add up.
    assert_near(grey(|| floor(matt(0.7)).point_light([0.0, 3.0, 0.0]).point_light([4.0, 3.0, 0.0])), 0.7 * 1.6);
}

#[test]
fn a_light_behind_the_surface_gives_nothing() {
    assert_eq!(grey(|| floor(matt(0.7)).point_light([0.0, -3.0, 0.0])), 0.0);
    // The same from below the floor: the normal turns to the viewer.
    let below = || floor(matt(0.7)).camera([-2.0, -2.0, 0.0], [0.0; 3]);
    assert_eq!(grey(|| below().point_light([0.0, 3.0, 0.0])), 0.0);
    assert_near(grey(|| below().point_light([0.0, -3.0, 0.0])), 0.7);
}

#[test]
fn the_specular_term_is_the_phong_lobe() {
    let shiny = matt(0.0).with_ks([0.25; 3]).with_shininess(10.0);
    // The reflection direction of the light at 45 degrees meets the viewer at 45 degrees.
    assert_near(grey(|| floor(shiny.clone()).point_light([3.0, 3.0, 0.0])), 0.25);
    // From straight above, the reflection direction is 45 degrees off the viewer.
    assert_near(grey(|| floor(shiny.clone()).point_light([0.0, 3.0, 0.0])), 0.25 * 0.5f32.sqrt().powi(10));
    // From the viewer's own side the lobe is turned away by a right angle.
    assert_near(grey(|| floor(shiny.clone()).point_light([-3.0, 3.0, 0.0])), 0.0);
}

#[test]
fn falloff_is_photometric_or_none() {
    let lit = |falloff| grey(|| floor(matt(1.0)).light_of(point([0.0, 5.0, 0.0]), 30.0, falloff));
    assert_near(lit(Falloff::None), 30.0);
    assert_near(lit(Falloff::InverseSquare), 30.0 / (PI * 25.0));
    let sun = LightKind::Directional { direction: Vec3::new(0.6, -0.8, 0.0), angle: 0.0 };
    let lit = |falloff| grey(|| floor(matt(1.0)).light_of(sun.clone(), 2.0, falloff));
    assert_near(lit(Falloff::None), 2.0 * 0.8);
    assert_near(lit(Falloff::InverseSquare), 2.0 * 0.8 * FRAC_1_PI);
}

#[test]
fn a_wide_sun_is_as_strong_as_a_narrow_one() {
    // On a floor that faces it, and at 45 degrees, where a part of a sun wider than 90 degrees is below the horizon.
    let half = 0.5f32.sqrt();
    for (degrees, aslant) in [
        (0.0, half),
        (0.53, half),
        (5.0, half),
        (30.0, half),
        (60.0, half),
        (90.0, half),
        (120.0, 0.719_315),
        (150.0, 0.764_557),
        (179.0, 0.849_663),
    ] {
        let lit = |direction: Vec3, falloff| {
            let sun = LightKind::Directional { direction, angle: f32::to_radians(degrees) };
            grey(|| floor(matt(1.0)).light_of(sun.clone(), 2.0, falloff))
        };
        for (direction, expected) in [(Vec3::NEG_Y, 1.0), (Vec3::new(half, -half, 0.0), aslant)] {
            if expected != 1.0 && degrees > 90.0 {
                continue;
            }
            let found = lit(direction, Falloff::None);
            assert!((found / (2.0 * expected) - 1.0).abs() < 0.005, "{degrees}, {direction}: {found}");
            assert!((lit(direction, Falloff::InverseSquare) - found * FRAC_1_PI).abs() < ROUNDING * found);
        }
    }
}

#[test]
fn a_spot_fades_between_its_two_angles() {
    // The spot is above the pixel and rotated by `angle`.
    let lit_by = |angle: f32, radius: f32| {
        let direction = Vec3::new(angle.sin(), -angle.cos(), 0.0);
        let position = Vec3::new(0.0, 4.0, 0.0);
        grey(|| floor(matt(1.0)).light(LightKind::Spot { position, direction, inner: 0.3, outer: 0.6, radius }))
    };
    let lit = |angle| lit_by(angle, 0.0);
    for angle in [0.0, 0.2, 0.29] {
        assert_near(lit(angle), 1.0);
    }
    for angle in [0.61, 1.0, 2.0, 3.0] {
        assert_eq!(lit(angle), 0.0);
    }
    // KHR_lights_punctual: the square of the share of the way between the cosines.
    let share = (0.45f32.cos() - 0.6f32.cos()) / (0.3f32.cos() - 0.6f32.cos());
    assert!((lit(0.45) - share * share).abs() < 1e-5, "{}", lit(0.45));

    // A ball of 0.4 seen from a distance of 4: each of its points has its own cone.
    assert!((lit_by(0.0, 0.4) - 1.0).abs() < 0.01, "{}", lit_by(0.0, 0.4));
    assert!((lit_by(0.45, 0.4) - lit(0.45)).abs() < 0.05, "{}", lit_by(0.45, 0.4));
    assert!(lit_by(0.62, 0.4) > 0.0);
    assert_eq!(lit_by(0.8, 0.4), 0.0);
}

#[test]
fn ambient_light_and_emission_need_no_light() {
    assert_eq!(grey(|| floor(matt(0.7))), 0.0);
    assert_near(grey(|| floor(matt(0.7)).ambient(0.4)), 0.2);
    let glowing = matt(0.7).with_emission([0.3; 3]);
    assert_near(grey(|| floor(glowing.clone()).ambient(0.4)), 0.5);
}

#[test]
fn channels_are_independent() {
    let material = Material::default().with_kd([0.1, 0.2, 0.4]);
    let frame = pixel(floor(material).point_light([0.0, 2.0, 0.0]), Mode::RayTrace);
    for (value, expected) in frame.image.color()[0].into_iter().zip([0.1, 0.2, 0.4]) {
        assert_near(value, expected);
    }
}

#[test]
fn layers_say_what_a_pixel_saw() {
    for mode in MODES {
        let frame = pixel(floor(matt(0.7)).point_light([0.0, 3.0, 0.0]).point_light([0.0, -3.0, 0.0]), mode);
        let layers = Picture::new(&frame).layers();
        assert_near(layers.depth[0], 8f32.sqrt());
        assert_eq!(layers.normal, [[0.0, 1.0, 0.0]]);
        assert!(Vec3::from_array(layers.position[0]).length() < 4.0 * ROUNDING, "{:?}", layers.position[0]);
        assert_eq!((layers.visibility[0][0], layers.visibility[1][0]), (1.0, 0.0));
        assert_eq!(layers.used, [0], "only a half-ball has light points");
    }
}

#[test]
fn a_transparent_background_is_left_out_and_only_that() {
    let sky = Vec3::new(0.1, 0.2, 0.3);
    let level = floor(matt(0.7)).camera([-2.0, 2.0, 0.0], [0.0, 2.0, 0.0]);
    let scene = level.point_light([0.0, 3.0, 0.0]).background(sky).finish("sky");
    let settings = Settings::default().with_size([24, 24]).with_aa(1);
    let opaque = render(&scene, &settings);
    let transparent = render(&scene, &settings.clone().with_transparent(true));
    let alpha = transparent.image.alpha().unwrap();
    assert!(alpha.contains(&0.0) && alpha.contains(&1.0) && opaque.image.alpha().is_none());
    let without_layers = crate::renderer().render(&scene, &settings.clone().with_transparent(true)).unwrap();
    assert!(without_layers.layers().is_none() && without_layers.image.alpha() == Some(alpha));
    for ((before, after), &alpha) in opaque.color().iter().zip(transparent.color()).zip(alpha) {
        if alpha == 1.0 {
            assert_eq!(before, after);
        } else {
            assert_eq!((*before, *after), (sky.to_array(), [0.0; 3]));
        }
    }
}

/// The image over its own background is the image with the background.
#[test]
fn several_samples_of_a_pixel_give_a_share_of_alpha() {
    let sky = Vec3::new(0.1, 0.2, 0.3);
    let level = floor(matt(0.7)).camera([-2.0, 2.0, 0.0], [0.0, 2.0, 0.3]);
    let scene = level.point_light([0.0, 3.0, 0.0]).background(sky).finish("sky");
    let settings = Settings::default().with_size([24, 24]).with_aa(8);
    let opaque = render(&scene, &settings);
    let transparent = render(&scene, &settings.clone().with_transparent(true));
    let alpha = transparent.image.alpha().unwrap();
    assert!(alpha.iter().any(|&alpha| alpha > 0.1 && alpha < 0.9));
    for ((before, after), &alpha) in opaque.color().iter().zip(transparent.color()).zip(alpha) {
        let over = Vec3::from_array(*after) + (1.0 - alpha) * sky;
        assert!((over - Vec3::from_array(*before)).abs().max_element() < 1e-5, "{alpha}: {over} {before:?}");
    }
}

#[test]
fn missed_pixels_show_the_background() {
    for mode in MODES {
        let sky = floor(matt(0.7)).point_light([0.0, 3.0, 0.0]).background(Vec3::new(0.1, 0.2, 0.3));
        let frame = pixel(sky.camera([-2.0, 2.0, 0.0], [0.0, 4.0, 0.0]), mode);
        assert_eq!(frame.image.color(), [[0.1, 0.2, 0.3]]);
        let layers = Picture::new(&frame).layers();
        assert_eq!(layers.depth, [f32::INFINITY]);
        assert_eq!((layers.normal[0], layers.position[0]), ([0.0; 3], [0.0; 3]));
        assert_eq!((layers.visibility[0][0], layers.used[0]), (0.0, 0));
    }
}

#[test]
fn smooth_normals_shade_and_flat_ones_decide_sides() {
    // Vertex normals leaning by 0.6: the cosine follows them, the layer does not.
    let mut scene = floor(matt(1.0)).point_light([0.0, 3.0, 0.0]).finish("smooth");
    scene.geometry_mut().mesh.normals = vec![Vec3::new(0.6, 0.8, 0.0); scene.geometry.mesh.positions.len()];
    let frame = render(&scene, &Settings::default().with_mode(Mode::RayTrace).with_size([1, 1]));
    assert_near(frame.image.color()[0][0], 0.8);
    assert_eq!(Picture::new(&frame).layers().normal, [[0.0, 1.0, 0.0]]);
}

#[test]
fn an_unshadowed_area_light_is_as_bright_in_every_mode() {
    // Modes differ only in visibility: the same points of the light represent all of it.
    let ball = LightKind::Sphere { position: Vec3::new(0.0, 3.0, 0.0), radius: 1.0 };
    let sun = LightKind::Directional { direction: Vec3::new(0.6, -0.8, 0.0), angle: 0.5 };
    let kinds = [&ball, &sun].into_iter();
    for (kind, falloff) in kinds.flat_map(|kind| [(kind, Falloff::None), (kind, Falloff::InverseSquare)]) {
        let draft = SceneDraft::new().floor(0.0, 3.0).light_of(kind.clone(), 1.0, falloff);
        let scene = draft.camera([0.0, 2.0, 4.0], [0.0, 0.0, 0.0]).finish("lamp");
        let colors = [Mode::RayTrace, Mode::Area].map(|mode| {
            let frame = render(&scene, &Settings::default().with_aa(1).with_mode(mode).with_size([32, 32]));
            let hits: Vec<usize> = Picture::new(&frame).hits().collect();
            hits.iter().map(|&pixel| frame.image.color()[pixel][0]).collect::<Vec<f32>>()
        });
        assert!(colors[0].len() > 500);
        for (traced, area) in colors[0].iter().zip(&colors[1]) {
            assert!(*area > 0.0 && traced == area, "{kind:?}, {falloff:?}: {traced} and {area}");
        }
    }
}

#[test]
fn what_is_below_the_horizon_is_taken_away_once() {
    // A wall, and a square light whose middle is in the plane of the wall: half of it shines on the wall.
    let lit = |position: Vec3, half_depth: f32, intensity: f32, settings: &Settings| {
        let light = LightKind::Rectangle {
            position,
            half_u: Vec3::new(0.5, 0.0, 0.0),
            half_v: Vec3::new(0.0, 0.0, half_depth),
        };
        let wall = [[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 1.0, 0.0], [-2.0, 1.0, 0.0]];
        let draft = SceneDraft::new().painted(matt(0.7)).quad(wall).camera([0.0, -0.5, 3.0], [0.0, -0.5, 0.0]);
        let scene = draft.ambient(0.0).light_of(light, intensity, Falloff::InverseSquare).finish("wall");
        let frame = render(&scene, settings);
        frame.image.color().iter().map(|color| color[0]).sum::<f32>() / frame.image.color().len() as f32
    };
    for mode in [Mode::Area, Mode::LightMesh] {
        let settings = Settings::default().with_aa(1).with_mode(mode).with_size([16, 16]).with_samples(256);
        let whole = lit(Vec3::new(0.0, 1.5, 0.0), 0.5, 2.0, &settings);
        let front = lit(Vec3::new(0.0, 1.5, 0.25), 0.25, 1.0, &settings);
        // The means of a few points of both lights differ.
        assert!((whole / front - 1.0).abs() < 0.1, "{mode:?}: {whole}, not {front}");
    }
}
