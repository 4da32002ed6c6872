//! Surfaces that are cut out by opacity: what is left of them is seen and casts shadows, in every mode and structure, and nothing else.

use glam::{DVec3, Vec2, Vec3};
use lightmesh_render::{Frame, Lookup, Mode, Settings, ShortTests};
use lightmesh_scene::{LightKind, Material, Opacity, OpacityChannel, Scene, Texture, TextureUse, Wrap};
use lightmesh_testkit::{ACCELERATIONS, Picture, SceneDraft, TECHNIQUES, perforated, pile, render, soup};

use crate::lists::{kinds, visibilities};
use crate::{LAMP, POINT, light_mesh};

const SIZE: [u32; 2] = [96, 72];
/// Squares along a side of the sheet, and the length of one.
const SQUARES: i32 = 8;
const SQUARE: f64 = 0.5;
/// The height of the sheet over the floor, and where the light is.
const HEIGHT: f64 = 2.0;
const LIGHT: Vec3 = Vec3::new(0.31, 6.0, 0.43);
/// Half the length of the sheet.
const HALF: f64 = 0.5 * SQUARE * SQUARES as f64;

/// Whether the sheet has a square there.
fn is_square(x: f64, z: f64) -> bool {
    let place = |at: f64| ((at + HALF) / SQUARE).floor() as i32;
    let inside = |place: i32| (0..SQUARES).contains(&place);
    inside(place(x)) && inside(place(z)) && (place(x) + place(z)) % 2 == 0
}

fn draft(light: LightKind) -> SceneDraft {
    SceneDraft::new().ambient(0.2).floor(0.0, 4.0).light(light).camera([1.3, 5.1, 6.2], [0.1, 0.6, 0.05])
}

fn quad(x: [f64; 2], z: [f64; 2]) -> [[f64; 3]; 4] {
    [[x[0], HEIGHT, z[0]], [x[1], HEIGHT, z[0]], [x[1], HEIGHT, z[1]], [x[0], HEIGHT, z[1]]]
}

/// A sheet over a floor, cut out by `alpha` of the texels of an image of so many squares.
fn sheet(light: LightKind, alpha: impl Fn(i32, i32) -> u8) -> Scene {
    let uses = TextureUse { wrap: [Wrap::Clamp; 2], ..TextureUse::new(0) };
    let leaf = Material::default().with_opacity(Opacity::by(uses, OpacityChannel::Alpha));
    let mut scene = draft(light).painted(leaf).quad(quad([-HALF, HALF], [-HALF, HALF])).finish("sheet");
    let geometry = scene.geometry_mut();
    let texel = |index: i32| [0, 0, 0, alpha(index % SQUARES, index / SQUARES)];
    let texels = (0..SQUARES * SQUARES).map(texel).collect();
    geometry.textures = vec![Texture { name: "checks".to_owned(), size: [SQUARES as u32; 2], texels }].into();
    let place = |at: f32| (at + HALF as f32) / (2.0 * HALF as f32);
    geometry.mesh.uvs = geometry.mesh.positions.iter().map(|p| Vec2::new(place(p.x), place(p.z))).collect();
    scene
}

fn checks(column: i32, row: i32) -> u8 {
    if (column + row) % 2 == 0 { 255 } else { 0 }
}

/// The same squares as geometry.
fn squares(light: LightKind) -> Scene {
    let start = |place: i32| f64::from(place) * SQUARE - HALF;
    let all = (0..SQUARES * SQUARES).map(|index| (index % SQUARES, index / SQUARES));
    let kept = all.filter(|&(column, row)| checks(column, row) != 0);
    let ends = |place: i32| [start(place), start(place + 1)];
    kept.fold(draft(light), |draft, (column, row)| draft.quad(quad(ends(column), ends(row)))).finish("squares")
}

/// Settings of every technique, without antialiasing.
fn techniques() -> impl Iterator<Item = (String, Settings)> {
    TECHNIQUES.into_iter().map(|(mode, lookup)| {
        let settings = Settings::default().with_mode(mode).with_lookup(lookup).with_size(SIZE).with_samples(16);
        let settings = settings.with_step(lightmesh_render::Step::Fixed(0.15)).with_radius(2.1).with_aa(1);
        (format!("{mode:?}, {lookup:?}"), settings)
    })
}

fn same(a: &Frame, b: &Frame) -> bool {
    let bits = |frame: &Frame| visibilities(frame).into_iter().map(f32::to_bits).collect::<Vec<_>>();
    a.color() == b.color() && bits(a) == bits(b)
}

#[test]
fn a_check_of_alpha_is_seen_and_casts_its_shadow_exactly() {
    let light = LightKind::Point { position: LIGHT, spread: 0.0 };
    for acceleration in ACCELERATIONS {
        for mode in [Mode::RayTrace, Mode::Area, Mode::LightMesh] {
            let settings = Settings::default().with_mode(mode).with_aa(1).with_size(SIZE);
            let frame = render(&sheet(light.clone(), checks), &settings.with_acceleration(acceleration.clone()));
            let picture = Picture::new(&frame);
            let seen = picture.visibilities(0);
            let mut counts = [0; 4];
            for (pixel, &seen) in picture.hits().zip(&seen) {
                let at = picture.position(pixel).as_dvec3();
                let kind = if at.y > 0.5 * HEIGHT {
                    assert!(is_square(at.x, at.z), "a hole is seen at {at}");
                    0
                } else {
                    // Where the way to the light, and that to the eye, passes the sheet.
                    let (eye, light) = (DVec3::new(1.3, 5.1, 6.2), LIGHT.as_dvec3());
                    let [to_eye, to_light] = [eye, light].map(|end| at + HEIGHT / end.y * (end - at));
                    let near = |at: f64| ((at + HALF) / SQUARE - ((at + HALF) / SQUARE).round()).abs() < 1e-4;
                    if [to_eye, to_light].iter().any(|at| near(at.x) || near(at.z)) {
                        continue;
                    }
                    assert!(!is_square(to_eye.x, to_eye.z), "the floor is seen through a square at {at}");
                    let lit = !is_square(to_light.x, to_light.z);
                    assert_eq!(seen, f32::from(lit), "{mode:?}, {acceleration:?}, {at}");
                    let through = to_light.x.abs() < HALF && to_light.z.abs() < HALF;
                    if !lit {
                        1
                    } else if through {
                        2
                    } else {
                        3
                    }
                };
                counts[kind] += 1;
            }
            assert!(
                counts.iter().all(|&count| count > 150),
                "squares, shadows, light through holes, aside: {counts:?}"
            );
        }
    }
}

#[test]
fn cut_out_squares_are_like_squares_of_geometry_in_every_mode() {
    let lamp = LightKind::Sphere { position: LIGHT, radius: 0.4 };
    for (name, settings) in techniques() {
        let (cut, whole) = (render(&sheet(lamp.clone(), checks), &settings), render(&squares(lamp.clone()), &settings));
        let [a, b] = [&cut, &whole].map(visibilities);
        // Points on other triangles are rounded differently, which may move a sample across an edge.
        let apart: Vec<f32> = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).filter(|apart| *apart > 1e-6).collect();
        assert!(apart.len() * 200 < a.len(), "{name}: {} of {} differ", apart.len(), a.len());
        let colors = cut.color().iter().flatten().zip(whole.color().iter().flatten());
        let differ = colors.filter(|(a, b)| (**a - **b).abs() > 1e-4).count();
        assert!(differ * 200 < 3 * a.len(), "{name}: {differ} colours");
        assert!(a.contains(&0.0) && a.contains(&1.0), "{name}");
    }
}

#[test]
fn what_is_cut_out_everywhere_is_not_there_and_what_is_nowhere_is_opaque() {
    for (name, settings) in techniques() {
        let none = draft(POINT).quad(quad([-90.0, -89.0], [-90.0, -89.0])).finish("without");
        let clear = render(&sheet(POINT, |_, _| 0), &settings);
        assert!(clear.color() == render(&none, &settings).color(), "{name}: clear");
        let plain = draft(POINT).quad(quad([-HALF, HALF], [-HALF, HALF])).finish("plain");
        assert!(same(&render(&sheet(POINT, |_, _| 255), &settings), &render(&plain, &settings)), "{name}: opaque");
    }
}

#[test]
fn every_structure_shows_the_same_bits_of_what_is_cut_out() {
    let scene = perforated(pile(DVec3::ZERO, &[LAMP, POINT]));
    let solid = pile(DVec3::ZERO, &[LAMP, POINT]);
    for (name, settings) in techniques() {
        let frames = ACCELERATIONS.map(|it| render(&scene, &settings.clone().with_acceleration(it)));
        assert!(frames.iter().all(|frame| same(frame, &frames[0])), "{name}");
        let hits = |frame: &Frame| Picture::new(frame).hits().count();
        let lit = |frame: &Frame| visibilities(frame).iter().filter(|&&seen| seen > 0.5).count();
        let whole = render(&solid, &settings);
        assert!(hits(&frames[0]) < hits(&whole) || lit(&frames[0]) != lit(&whole), "{name}: holes are to be seen");
    }
}

#[test]
fn samples_of_pixels_see_what_single_rays_see() {
    let scene = perforated(pile(DVec3::ZERO, &[POINT]));
    let settings = Settings::default().with_mode(Mode::RayTrace).with_size([48, 36]).with_aa(8);
    let [beams, rays] = [ACCELERATIONS[0].clone(), ACCELERATIONS[2].clone()]
        .map(|it| render(&scene, &settings.clone().with_acceleration(it)));
    assert!(beams.color() == rays.color());
}

#[test]
fn lists_are_the_reference_where_triangles_are_cut_out() {
    let mut scene = perforated(pile(DVec3::new(1e5, -2e4, 3e5), &kinds()));
    let wide = LightKind::Sphere { position: Vec3::new(0.5, 7.0, 1.0), radius: 2.0 };
    let mut leaves = perforated(soup(3, 300));
    leaves.lights.list = vec![lightmesh_scene::Light::new(wide)];
    scene.name = "pile".to_owned();
    for scene in [scene, leaves] {
        for samples in [1, 5, 16, 64, 300] {
            let settings = Settings::default().with_aa(1).with_size([70, 45]).with_samples(samples);
            let lists = render(&scene, &settings.clone().with_lookup(Lookup::Lists));
            let area = render(&scene, &settings.with_mode(Mode::Area));
            assert!(same(&lists, &area), "{}, {samples} samples", scene.name);
        }
    }
}

#[test]
fn short_tests_by_cell_see_through_holes_like_plain_ones() {
    let scene = perforated(pile(DVec3::ZERO, &[LAMP]));
    let settings = light_mesh([70, 45], 0.2, 2.1).with_lookup(Lookup::HalfBall).with_aa(1);
    let [cells, plain] =
        [ShortTests::Cells, ShortTests::Plain].map(|tests| render(&scene, &settings.clone().with_short_tests(tests)));
    assert!(same(&cells, &plain));
}
