//! Glass: what is reflected and what goes through is all of the light; it is bent by Snell's law, reflected by Fresnel's equations, and absorbed
//! by bodies.

use glam::{DVec3, Vec3};
use lightmesh_render::{Frame, Settings};
use lightmesh_scene::{Dielectric, LightKind, Material, Scene};
use lightmesh_testkit::{ACCELERATIONS, SceneDraft, TECHNIQUES, render};

const SIZE: [u32; 2] = [24, 18];
const BACKGROUND: Vec3 = Vec3::new(0.5, 0.25, 1.0);

fn glass() -> Dielectric {
    Dielectric::new(1.5)
}

fn settings() -> Settings {
    Settings::default().with_size(SIZE).with_aa(1)
}

/// A square in the plane z = `-distance`, `half` to each side, whose front is on the camera's side, or on the other.
fn square(draft: SceneDraft, half: f64, distance: f64, front: bool) -> SceneDraft {
    let corner = |x: f64, y: f64| [half * x, half * y, -distance];
    let mut corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    if !front {
        corners.reverse();
    }
    draft.quad(corners)
}

/// A pane, or the two sides of a slab that is half as thick as its distance from the origin.
fn slab(draft: SceneDraft, of: Dielectric) -> SceneDraft {
    let draft = square(draft.painted(Material::of(of)), 5.0, 1.0, true);
    if of.thin { draft } else { square(draft, 5.0, 1.5, false) }
}

/// Before the background, seen from the origin.
fn seen(draft: SceneDraft) -> Scene {
    draft.background(BACKGROUND).camera([0.0; 3], [0.0, 0.0, -1.0]).finish("glass")
}

/// The mean difference of pixels from the background.
fn mean_difference(frame: &Frame) -> f32 {
    let difference = |color: &[f32; 3]| (Vec3::from(*color) - BACKGROUND).abs().max_element();
    frame.color().iter().map(difference).sum::<f32>() / frame.color().len() as f32
}

/// Fresnel's equations, once more: by the angles.
fn fresnel(cosine: f64, ior: f64) -> f64 {
    let first = cosine.acos();
    let second = (first.sin() / ior).asin();
    let (sum, difference) = (first + second, first - second);
    if sum == 0.0 {
        return ((ior - 1.0) / (ior + 1.0)).powi(2);
    }
    0.5 * ((difference.sin() / sum.sin()).powi(2) + (difference.tan() / sum.tan()).powi(2))
}

#[test]
fn glass_in_even_light_is_not_seen() {
    // What does not go through is reflected, and comes from the same background.
    let walls = seen(slab(SceneDraft::new(), glass().with_thin(true)));
    assert!(mean_difference(&render(&walls, &settings().with_bounces(1))) < 1e-6);
    // Of a body, some is still between its sides after the last bounce.
    let bodies = [
        seen(slab(SceneDraft::new(), glass())),
        seen(SceneDraft::new().painted(Material::of(glass())).smooth_ball(DVec3::new(0.2, 0.0, -3.0), 1.5, [40, 80])),
    ];
    for body in bodies {
        let lost = |bounces: u32| mean_difference(&render(&body, &settings().with_bounces(bounces)));
        assert!(lost(0) > 0.03 && lost(3) < 0.05 * lost(0), "{} and {}", lost(0), lost(3));
    }
}

#[test]
fn the_surface_reflects_by_fresnels_equations() {
    // All that enters is absorbed.
    let black = glass().with_absorption([1e6; 3]);
    let scene = seen(square(SceneDraft::new().painted(Material::of(black)), 5.0, 1.0, true));
    let frame = render(&scene, &settings().with_bounces(1).with_layers(true));
    let camera = scene.cameras[0].position.as_dvec3();
    let mut angles = Vec::new();
    for (pixel, color) in frame.color().iter().enumerate() {
        let position = Vec3::from(frame.layers().unwrap().position[pixel]).as_dvec3();
        let cosine = (camera - position).normalize().z;
        let expected = fresnel(cosine, 1.5) as f32 * BACKGROUND;
        // What goes through the one square meets the background, too.
        let through = (1.0 - fresnel(cosine, 1.5) as f32) * BACKGROUND;
        let reflected = Vec3::from(*color) - through;
        assert!((reflected - expected).abs().max_element() < 1e-5, "{cosine}: {reflected}, not {expected}");
        angles.push(cosine);
    }
    assert!(angles.iter().any(|cosine| *cosine < 0.85) && angles.iter().any(|cosine| *cosine > 0.99));
}

#[test]
fn a_body_absorbs_by_the_length_of_the_way_through_it() {
    let absorption = Vec3::new(0.5, 2.0, 1.0);
    let scene = seen(slab(SceneDraft::new(), glass().with_absorption(absorption)));
    let frame = render(&scene, &settings().with_layers(true));
    for (pixel, color) in frame.color().iter().enumerate() {
        let position = Vec3::from(frame.layers().unwrap().position[pixel]).as_dvec3();
        let cosine = -position.normalize().z;
        let within = (1.0 - (1.0 - cosine * cosine) / 2.25).sqrt();
        let left = (1.0 - fresnel(cosine, 1.5)).powi(2) as f32;
        let expected = left * (-(0.5 / within) as f32 * absorption).exp() * BACKGROUND;
        // Rays leave a surface where rounding cannot reach it.
        assert!((Vec3::from(*color) - expected).abs().max_element() < 1e-4, "{cosine}: {color:?}, not {expected}");
    }
}

#[test]
fn a_ball_shows_the_world_upside_down() {
    // Red above, green below, far behind the ball.
    let shines = |color: [f32; 3]| Material::matt(Vec3::ZERO).with_emission(color);
    let half = |draft: SceneDraft, color: [f32; 3], [low, high]: [f64; 2]| {
        draft.painted(shines(color)).quad([
            [-60.0, low, -40.0],
            [60.0, low, -40.0],
            [60.0, high, -40.0],
            [-60.0, high, -40.0],
        ])
    };
    let draft = half(half(SceneDraft::new(), [1.0, 0.0, 0.0], [0.0, 60.0]), [0.0, 1.0, 0.0], [-60.0, 0.0]);
    let draft = draft.painted(Material::of(glass())).smooth_ball(DVec3::new(0.0, 0.0, -4.0), 1.0, [60, 120]);
    let scene = seen(draft);
    for acceleration in ACCELERATIONS {
        let frame = render(&scene, &settings().with_size([40, 40]).with_acceleration(acceleration));
        let at = |row: usize, column: usize| Vec3::from(frame.color()[40 * row + column]);
        assert!(at(2, 2).x > 0.9 && at(37, 37).y > 0.9, "beside the ball the world is upright");
        for (row, x) in [(17, 0.0), (18, 0.0), (21, 1.0), (22, 1.0)] {
            let color = at(row, 20);
            assert!((color.x - 0.92 * x).abs() < 0.02 && (color.y - 0.92 * (1.0 - x)).abs() < 0.02, "{row}: {color}");
        }
    }
}

#[test]
fn nothing_leaves_a_body_beyond_the_critical_angle() {
    // Inside of glass, the surface above is a mirror where it is seen under more than 41.8 degrees: it shows the floor, and else the background.
    let shines = Material::matt(Vec3::ZERO).with_emission([0.0, 0.0, 1.0]);
    let lid = square(SceneDraft::new().painted(Material::of(glass())), 90.0, 1.0, false);
    let scene = square(lid.painted(shines), 90.0, -1.0, false).background(Vec3::X).camera([0.0; 3], [0.8, 0.0, -1.0]);
    let scene = scene.finish("under water");
    let frame = render(&scene, &settings().with_size([64, 48]).with_layers(true));
    let mut counts = [0; 2];
    for (pixel, color) in frame.color().iter().enumerate() {
        let cosine = -Vec3::from(frame.layers().unwrap().position[pixel]).normalize().z;
        let total = cosine < (1.0_f32 - 1.0 / 2.25).sqrt();
        counts[usize::from(total)] += 1;
        let [red, _, blue] = *color;
        match total {
            true => assert!(red == 0.0 && blue == 1.0, "{cosine}: {color:?}"),
            false => assert!(red > 0.0 && blue == 0.0, "{cosine}: {color:?}"),
        }
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn shadows_of_glass_are_what_it_leaves() {
    let sun = LightKind::Directional { direction: Vec3::NEG_Y, angle: 0.0 };
    let absorption = Vec3::new(0.5, 1.0, 0.25);
    let floor = |glass: Option<Dielectric>| {
        let draft = SceneDraft::new().floor(0.0, 20.0).light(sun.clone()).orthographic([0.0, 0.5, 0.0], [0.0; 3], 0.4);
        let Some(glass) = glass else { return draft.finish("lit") };
        let plate = |height: f64| [[-3.0, height, -3.0], [-3.0, height, 3.0], [3.0, height, 3.0], [3.0, height, -3.0]];
        let mut lower = plate(1.0);
        lower.reverse();
        draft.painted(Material::of(glass)).quad(plate(1.5)).quad(lower).finish("shaded")
    };
    let once = 1.0 - fresnel(1.0, 1.5) as f32;
    let body = once * once * (-0.5 * absorption).exp();
    // Two panes.
    let walls = Vec3::splat(((1.0 - 0.04) / (1.0 + 0.04_f32)).powi(2));
    for (mode, lookup) in TECHNIQUES {
        let settings = settings().with_mode(mode).with_lookup(lookup).with_step(lightmesh_render::Step::Fixed(0.15));
        let lit = render(&floor(None), &settings);
        for (glass, left) in [(glass().with_absorption(absorption), body), (glass().with_thin(true), walls)] {
            let shaded = render(&floor(Some(glass)), &settings);
            for (shaded, lit) in shaded.color().iter().zip(lit.color()) {
                let (shaded, lit) = (Vec3::from(*shaded), Vec3::from(*lit));
                assert!(lit.min_element() > 0.01 && (shaded - left * lit).abs().max_element() < 1e-5, "{shaded}");
            }
        }
    }
}
