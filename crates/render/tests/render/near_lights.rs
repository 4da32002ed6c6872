//! Lights near surfaces, and wide suns, against sums over their points in double precision.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use lightmesh_render::{Frame, Lookup, Mode, Settings};
use lightmesh_scene::{Falloff, Light, LightKind, Material, Scene};
use lightmesh_testkit::{Picture, SceneDraft, render};

/// Places of a sum along each side.
const PLACES: u32 = 96;

/// A lamp over a white floor at height 0, of radiance 1 with `front`; else it shines evenly.
struct Panel {
    center: DVec3,
    half_u: DVec3,
    half_v: DVec3,
    front: Option<DVec3>,
}

impl Panel {
    fn light(&self) -> Light {
        let light = Light::rectangle(self.center.as_vec3(), self.half_u.as_vec3(), self.half_v.as_vec3()).unwrap();
        let area = 4.0 * self.half_u.cross(self.half_v).length();
        let light = light.with_falloff(Falloff::InverseSquare).with_intensity(Vec3::splat(area as f32));
        let even = light.clone().with_one_sided(false);
        self.front.map_or(even, |front| light.with_surface(front.as_vec3()))
    }

    /// What a white surface shows, if a part of the light is `seen`.
    fn shown(&self, point: DVec3, normal: DVec3, seen: impl Fn(DVec3) -> bool) -> f64 {
        let middle = |place: u32| 2.0 * (f64::from(place) + 0.5) / f64::from(PLACES) - 1.0;
        let mut sum = 0.0;
        for (row, column) in (0..PLACES).flat_map(|row| (0..PLACES).map(move |column| (row, column))) {
            let place = self.center + middle(row) * self.half_u + middle(column) * self.half_v;
            let way = place - point;
            let direction = way.normalize();
            let emitted = self.front.map_or(1.0, |front| (-front.dot(direction)).max(0.0));
            if seen(place) {
                sum += normal.dot(direction).max(0.0) * emitted / way.length_squared();
            }
        }
        let area = 4.0 * self.half_u.cross(self.half_v).length();
        area * sum / (PI * f64::from(PLACES * PLACES))
    }
}

fn white() -> Material {
    Material::matt([1.0; 3])
}

fn lit(draft: SceneDraft, light: Light) -> Scene {
    let mut scene = draft.ambient(0.0).finish("near light");
    scene.lights.list = vec![light];
    scene
}

fn settings(mode: Mode) -> Settings {
    Settings::default().with_aa(1).with_mode(mode).with_lookup(Lookup::Auto).with_size([24, 24]).with_samples(256)
}

/// The largest difference between what is seen of the floor and what is expected, as a share of the largest value.
fn worst(frame: &Frame, expected: impl Fn(DVec3) -> f64) -> f64 {
    let picture = Picture::new(frame);
    let (mut worst, mut peak) = (0.0f64, 0.0f64);
    for pixel in picture.hits() {
        let point = Vec3::from_array(picture.layers().position[pixel]).as_dvec3();
        let expected = expected(point);
        worst = worst.max((f64::from(frame.image.color()[pixel][0]) - expected).abs());
        peak = peak.max(expected);
    }
    assert!(peak > 0.0);
    worst / peak
}

/// A floor of 2 by 2 seen from above, from below the lamp.
fn floor(height: f64) -> SceneDraft {
    SceneDraft::new().painted(white()).floor(0.0, 1.0).orthographic([0.0, 0.8 * height, 0.001], [0.0; 3], 1.6)
}

#[test]
fn a_lamp_near_a_floor_lights_it_as_its_integral_says() {
    for height in [0.1, 0.25, 0.5] {
        for front in [None, Some(DVec3::NEG_Y)] {
            let (half_u, half_v) = (DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.2));
            let panel = Panel { center: DVec3::new(0.0, height, 0.0), half_u, half_v, front };
            let scene = lit(floor(height), panel.light());
            for mode in [Mode::RayTrace, Mode::Area, Mode::LightMesh] {
                let frame = render(&scene, &settings(mode));
                let worst = worst(&frame, |point| panel.shown(point, DVec3::Y, |_| true));
                assert!(worst < 0.02, "{height}, {front:?}, {mode:?}: {worst}");
            }
        }
    }
}

/// A glowing ball whose surface is 2 cm over a floor, and its light.
fn glowing_ball(draft: SceneDraft) -> Scene {
    let glowing = Material::matt([0.0; 3]).with_emission([4.0; 3]);
    let mut scene =
        draft.painted(glowing).smooth_ball(DVec3::new(0.0, 0.12, 0.0), 0.1, [16, 32]).ambient(0.0).finish("ball");
    scene.add_lamps();
    assert_eq!(scene.lights.len(), 1);
    scene
}

#[test]
fn a_glowing_ball_near_a_floor_lights_it_as_a_ball_does() {
    let scene = glowing_ball(floor(0.02));
    // All of it is above the horizon: its projection is that of a disc.
    let intensity = f64::from(scene.lights[0].intensity.x);
    let shown = |point: DVec3| intensity * 0.12 / (PI * DVec3::new(0.0, 0.12, 0.0).distance(point).powi(3));
    for mode in [Mode::RayTrace, Mode::Area, Mode::LightMesh] {
        let frame = render(&scene, &settings(mode));
        let worst = worst(&frame, shown);
        assert!(worst < 0.02, "{mode:?}: {worst}");
    }
}

#[test]
fn a_board_just_below_a_glowing_ball_hides_it_and_the_ball_does_not() {
    let board = [[0.0, 0.01, -2.0], [0.0, 0.01, 2.0], [2.0, 0.01, 2.0], [2.0, 0.01, -2.0]];
    let scene = glowing_ball(floor(0.01).quad(board));
    let intensity = f64::from(scene.lights[0].intensity.x);
    let [area, lists] = [Mode::Area, Mode::LightMesh].map(|mode| render(&scene, &settings(mode)));
    assert_eq!(area.image.color(), lists.image.color());
    // About its edge, it hides a part.
    let shown = |point: DVec3| intensity * 0.12 / (PI * DVec3::new(0.0, 0.12, 0.0).distance(point).powi(3));
    let picture = Picture::new(&lists);
    let (mut open, mut hidden) = (0, 0);
    for pixel in picture.hits() {
        let point = Vec3::from_array(picture.layers().position[pixel]).as_dvec3();
        // The view is a little aslant: some of it begins above the board.
        if point.y > 0.005 {
            continue;
        }
        let share = f64::from(lists.image.color()[pixel][0]) / shown(point);
        if point.x < -0.1 {
            assert!((share - 1.0).abs() < 0.03, "{point}: {share}");
            open += 1;
        } else if point.x > 0.06 {
            assert!(share < 0.01, "{point}: {share}");
            hidden += 1;
        }
    }
    assert!(open > 100 && hidden > 5, "{open}, {hidden}");
}

#[test]
fn a_strip_lights_a_wall_beside_it_evenly() {
    // 1 m long, 1 cm wide, 2 and 6 cm from a wall; 10 cm below it, over its middle half.
    for away in [0.02, 0.06] {
        for front in [None, Some(DVec3::NEG_Y)] {
            let panel = Panel {
                center: DVec3::new(0.0, 2.2, away),
                half_u: DVec3::new(0.5, 0.0, 0.0),
                half_v: DVec3::new(0.0, 0.0, 0.005),
                front,
            };
            let wall = [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.5, 0.0], [-2.0, 2.5, 0.0]];
            let draft = SceneDraft::new().painted(white()).quad(wall);
            let scene = lit(draft.orthographic([0.0, 2.1, 0.5], [0.0, 2.1, 0.0], 0.02), panel.light());
            let settings = settings(Mode::LightMesh).with_size([200, 8]);
            let frame = render(&scene, &settings);
            let shown = |point| panel.shown(point, DVec3::Z, |_| true);
            let off = worst(&frame, shown);
            let picture = Picture::new(&frame);
            let (mut least, mut most) = (f32::INFINITY, 0.0f32);
            for pixel in picture.hits() {
                let [x, y, _] = picture.layers().position[pixel];
                if x.abs() <= 0.25 && (y - 2.10125).abs() < 0.001 {
                    (least, most) = (least.min(frame.image.color()[pixel][0]), most.max(frame.image.color()[pixel][0]));
                }
            }
            assert!(most / least <= 1.03 && most > 0.0, "{away}, {front:?}: {least} to {most}");
            assert!(off < 0.03, "{away}, {front:?}: {off}");
        }
    }
}

#[test]
fn a_shadow_near_a_lamp_is_the_share_of_its_light() {
    // A panel 10 cm over a floor, and half of it hidden by a board below it: its nearest parts give most of the light.
    for front in [None, Some(DVec3::NEG_Y)] {
        let (half_u, half_v) = (DVec3::new(0.4, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.3));
        let panel = Panel { center: DVec3::new(0.0, 0.2, 0.0), half_u, half_v, front };
        let board = [[0.05, 0.1, -2.0], [0.05, 0.1, 2.0], [2.0, 0.1, 2.0], [2.0, 0.1, -2.0]];
        let draft = floor(0.1).quad(board);
        let scene = lit(draft, panel.light());
        let seen = |point: DVec3, place: DVec3| {
            let way = place - point;
            point.x + way.x * (0.1 / way.y) < 0.05
        };
        let [area, lists] = [Mode::Area, Mode::LightMesh].map(|mode| render(&scene, &settings(mode)));
        assert_eq!(area.image.color(), lists.image.color());
        let worst = worst(&lists, |point| panel.shown(point, DVec3::Y, |place| seen(point, place)));
        assert!(worst < 0.03, "{front:?}: {worst}");
        // Several sets of samples.
        let [area, lists] =
            [Mode::Area, Mode::LightMesh].map(|mode| render(&scene, &settings(mode).with_samples(1024)));
        assert_eq!(area.image.color(), lists.image.color());
        let finer = self::worst(&lists, |point| panel.shown(point, DVec3::Y, |place| seen(point, place)));
        assert!(finer < 0.02, "{front:?}: {finer}");
    }
}

#[test]
fn an_open_floor_under_a_wide_sun_has_no_noise() {
    // Aslant, a part of the sun is below the horizon: what is seen of the rest is all of it.
    let half = 0.5f32.sqrt();
    for (degrees, expected) in [(90.0, half), (120.0, 0.719_315), (150.0, 0.764_557), (179.0, 0.849_663)] {
        let direction = Vec3::new(half, -half, 0.0);
        let sun = Light::new(LightKind::Directional { direction, angle: f32::to_radians(degrees) });
        let scene = lit(floor(1.0), sun);
        for mode in [Mode::Area, Mode::LightMesh] {
            for color in render(&scene, &settings(mode)).image.color() {
                assert!((color[0] / expected - 1.0).abs() < 0.005, "{degrees}, {mode:?}: {color:?}");
            }
        }
    }
}

#[test]
fn a_wall_hides_its_share_of_a_wide_sun() {
    // Half of the sky is behind a high wall: at its foot, half of a sun overhead is hidden.
    for degrees in [30.0, 90.0, 120.0, 150.0] {
        let sun = Light::new(LightKind::Directional { direction: Vec3::NEG_Y, angle: f32::to_radians(degrees) });
        let wall = [[0.0, 0.0, -900.0], [0.0, 0.0, 900.0], [0.0, 900.0, 900.0], [0.0, 900.0, -900.0]];
        let draft = SceneDraft::new().painted(white()).floor(0.0, 2.0).quad(wall);
        let scene = lit(draft.orthographic([-0.05, 1.0, 0.001], [-0.05, 0.0, 0.0], 0.05), sun);
        let frame = render(&scene, &settings(Mode::LightMesh));
        let mean = frame.image.color().iter().map(|color| color[0]).sum::<f32>() / frame.image.color().len() as f32;
        assert!((mean - 0.5).abs() < 0.02, "{degrees}: {mean}");
    }
}
