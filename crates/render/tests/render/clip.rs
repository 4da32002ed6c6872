//! Cameras see what is between their clip planes.

use glam::Vec3;
use lightmesh_render::{Acceleration, Crop, Frame, Lookup, Mode, Settings};
use lightmesh_scene::{Camera, Dielectric, Light, LightKind, Material, Opacity, Scene};
use lightmesh_testkit::{ACCELERATIONS, SceneDraft, TECHNIQUES, pile, render};

use crate::lists::kinds;

const SIZE: [u32; 2] = [41, 31];

/// A wall across the view, 8 to each side of its middle, in the plane z = −`depth`.
fn wall(draft: SceneDraft, depth: f64, color: f32) -> SceneDraft {
    let corners = [[-8.0, -8.0], [8.0, -8.0], [8.0, 8.0], [-8.0, 8.0]].map(|[x, y]| [x, y, -depth]);
    draft.painted(Material::matt(Vec3::splat(color)).with_emission(Vec3::splat(color))).quad(corners)
}

/// The same scene through a camera that sees some depths alone.
fn clipped(scene: &Scene, near: f32, far: f32) -> Scene {
    let mut scene = scene.clone();
    scene.cameras = scene.cameras.into_iter().map(|camera| camera.with_clip(near, far).unwrap()).collect();
    scene
}

fn settings() -> Settings {
    Settings::default().with_size(SIZE).with_aa(1).with_mode(Mode::RayTrace).with_layers(true)
}

fn same(a: &Frame, b: &Frame, what: &str) {
    assert!(a.image == b.image, "{what}");
}

/// The depths along the view direction of what pixels see, of those that see something.
fn depths(frame: &Frame, camera: &Camera, scene: &Scene) -> Vec<Option<f32>> {
    let layers = frame.layers().unwrap();
    let depth = |position: [f32; 3]| {
        let eye = scene.to_world(camera.position).as_vec3();
        (Vec3::from_array(position) - eye).dot(camera.direction)
    };
    let seen = layers.depth.iter().zip(&layers.position);
    seen.map(|(way, &position)| way.is_finite().then(|| depth(position))).collect()
}

#[test]
fn walls_before_and_behind_the_planes_are_not_there() {
    let parts = |which: &[(f64, f32)]| {
        let draft = SceneDraft::new().background(Vec3::new(0.1, 0.2, 0.3)).camera([0.0; 3], [0.1, 0.2, -1.0]);
        which.iter().fold(draft, |draft, &(depth, color)| wall(draft, depth, color)).finish("walls")
    };
    let all = parts(&[(2.0, 0.25), (5.0, 0.5), (9.0, 0.75)]);
    for (near, far, left) in [
        (0.0, f32::INFINITY, &[(2.0, 0.25), (5.0, 0.5), (9.0, 0.75)][..]),
        (3.5, f32::INFINITY, &[(5.0, 0.5), (9.0, 0.75)]),
        (3.5, 6.5, &[(5.0, 0.5)]),
        (6.5, 12.0, &[(9.0, 0.75)]),
        (0.0, 1.0, &[]),
        (15.0, f32::INFINITY, &[]),
    ] {
        for acceleration in ACCELERATIONS {
            for aa in [1, 4] {
                let settings = settings().with_aa(aa).with_acceleration(acceleration.clone());
                let [seen, alone] = [&clipped(&all, near, far), &parts(left)].map(|scene| render(scene, &settings));
                assert!(seen.color() == alone.color(), "{near} to {far} with {settings:?}");
            }
        }
    }
}

/// Of a floor in a wide view: not at the same distance from the eye.
#[test]
fn planes_are_perpendicular_to_the_view() {
    let perspective = SceneDraft::new().floor(0.0, 60.0).camera([0.3, 2.0, 0.1], [0.5, 1.0, -4.0]);
    let parallel = SceneDraft::new().floor(0.0, 60.0).orthographic([0.3, 9.0, 0.1], [0.5, 0.0, -4.0], 9.0);
    for draft in [perspective, parallel] {
        let mut scene = draft.finish("floor");
        for shift in [[0.0, 0.0], [0.7, -0.3]] {
            scene.cameras[0] = scene.cameras[0].clone().with_shift(shift);
            let camera = &scene.cameras[0];
            let whole = depths(&render(&scene, &settings()), camera, &scene);
            let mut sorted: Vec<f32> = whole.iter().copied().flatten().collect();
            sorted.sort_by(f32::total_cmp);
            let [near, far] = [0.3, 0.7].map(|share| sorted[(share * sorted.len() as f32) as usize]);
            let part = render(&clipped(&scene, near, far), &settings());
            let mut seen = 0;
            for (pixel, (whole, part)) in whole.iter().zip(depths(&part, camera, &scene)).enumerate() {
                let Some(depth) = *whole else { continue };
                // Rounded at the planes themselves.
                if (depth - near).abs().min((depth - far).abs()) < 1e-4 * depth {
                    continue;
                }
                assert_eq!(part.is_some(), near < depth && depth < far, "pixel {pixel} at {depth}: {near} to {far}");
                seen += usize::from(part.is_some());
                assert!(part.is_none_or(|part| (part - depth).abs() < 1e-4 * depth), "pixel {pixel}");
            }
            assert!(seen > sorted.len() / 4, "{seen} of {}", sorted.len());
        }
    }
}

/// What cuts nothing changes no bit, with all that finds hits.
#[test]
fn planes_around_everything_change_nothing() {
    let scene = pile(glam::DVec3::ZERO, &kinds());
    for (mode, lookup) in TECHNIQUES {
        for aa in [1, 4] {
            let settings = settings().with_mode(mode).with_lookup(lookup).with_step(0.3).with_samples(4).with_aa(aa);
            let [all, far] = [&scene, &clipped(&scene, 0.0, 1000.0)].map(|scene| render(scene, &settings));
            same(&all, &far, &format!("{settings:?}"));
        }
    }
}

#[test]
fn a_crop_of_what_is_cut_is_a_part_of_the_whole() {
    let scene = clipped(&pile(glam::DVec3::ZERO, &kinds()), 5.0, 6.5);
    for aa in [1, 4] {
        let settings = settings().with_aa(aa).with_mode(Mode::LightMesh).with_samples(4);
        let whole = render(&scene, &settings);
        let crop = Crop::new([13, 7], [17, 12]);
        let part = render(&scene, &settings.with_crop(crop));
        assert!(part.image == whole.image.cropped(crop.first, crop.size).unwrap());
    }
}

/// A box that is cut away stays in the way of light.
#[test]
fn what_is_cut_away_casts_shadows() {
    let light = LightKind::Sphere { position: Vec3::new(0.0, 6.0, 0.0), radius: 0.4 };
    let draft = SceneDraft::new().floor(0.0, 4.0).cuboid([-0.8, 1.0, -0.8], [0.8, 1.6, 0.8]).light(light);
    let scene = draft.camera([0.0, 9.0, 0.1], [0.0, 0.0, 0.0]).finish("box");
    for (mode, lookup) in TECHNIQUES {
        let settings = settings().with_mode(mode).with_lookup(lookup).with_step(0.3).with_samples(64);
        let [all, floor] = [&scene, &clipped(&scene, 8.2, 9.5)].map(|scene| render(scene, &settings));
        let (all, floor) = (all.layers().unwrap(), floor.layers().unwrap());
        assert!(floor.position.iter().zip(&floor.depth).all(|(at, way)| way.is_infinite() || at[1].abs() < 1e-3));
        // The middle of the shadow, where the box was seen, and where the floor was.
        let middle = (SIZE[0] * SIZE[1] / 2) as usize;
        assert!(all.position[middle][1] > 1.0 && floor.position[middle][1].abs() < 1e-3, "{mode:?} {lookup:?}");
        assert_eq!(floor.visibility[0][middle], 0.0, "{mode:?} {lookup:?}");
        let both = |pixel: &usize| all.depth[*pixel].is_finite() && all.position[*pixel][1].abs() < 1e-3;
        let pixels: Vec<usize> = (0..all.depth.len()).filter(both).collect();
        let differs = |&&pixel: &&usize| {
            let [a, b] = [all, floor].map(|layers| layers.visibility[0][pixel]);
            (a - b).abs() > 0.05
        };
        let differing: Vec<&usize> = pixels.iter().filter(differs).collect();
        // Adaptive rays ask neighbours, some of which see the floor in place of the box.
        let allowed = if lookup == Lookup::Adaptive { pixels.len() / 10 } else { 0 };
        assert!(differing.len() <= allowed, "{differing:?} of {} with {mode:?} {lookup:?}", pixels.len());
    }
}

#[test]
fn mirrors_show_what_is_cut_away() {
    let mirror = Material::matt(Vec3::ZERO).with_ks([1.0; 3]);
    let draft = SceneDraft::new().camera([0.0; 3], [0.0, 0.0, -1.0]);
    let draft =
        draft.painted(mirror).quad([[-8.0, -8.0, -5.0], [8.0, -8.0, -5.0], [8.0, 8.0, -5.0], [-8.0, 8.0, -5.0]]);
    // Beside the view, and behind the eye.
    let shining = Material::matt(Vec3::ZERO).with_emission(Vec3::new(1.0, 0.5, 0.25));
    let scene = draft.painted(shining).cuboid([-1.0, -1.0, 3.0], [1.0, 1.0, 4.0]).finish("mirror");
    for aa in [1, 4] {
        let settings = settings().with_bounces(1).with_aa(aa);
        let [all, part] = [&scene, &clipped(&scene, 4.0, 6.0)].map(|scene| render(scene, &settings));
        assert!(all.color().iter().any(|color| color[0] > 0.5));
        for (a, b) in all.color().as_flattened().iter().zip(part.color().as_flattened()) {
            assert!((a - b).abs() < 1e-5, "{a} and {b}");
        }
    }
}

/// Rays that go on behind a pane end at the far plane, too.
#[test]
fn what_is_behind_glass_is_cut_away() {
    let glass = Material::of(Dielectric::new(1.5).with_thin(true));
    let veil = Material::matt(Vec3::splat(0.3)).with_opacity(Opacity::blend(0.5));
    for pane in [glass, veil] {
        let parts = |walls: &[f64]| {
            let draft =
                SceneDraft::new().background(Vec3::splat(0.2)).camera([0.0; 3], [0.1, 0.2, -1.0]).painted(pane.clone());
            let draft = draft.quad([[-8.0, -8.0, -2.0], [8.0, -8.0, -2.0], [8.0, 8.0, -2.0], [-8.0, 8.0, -2.0]]);
            walls.iter().fold(draft, |draft, &depth| wall(draft, depth, 0.7)).finish("pane")
        };
        for aa in [1, 4] {
            let settings = settings().with_aa(aa).with_bounces(0);
            let [cut, alone, all] =
                [&clipped(&parts(&[5.0]), 1.0, 4.0), &parts(&[]), &parts(&[5.0])].map(|scene| render(scene, &settings));
            for (a, b) in cut.color().as_flattened().iter().zip(alone.color().as_flattened()) {
                assert!((a - b).abs() < 1e-5, "{a} and {b}");
            }
            assert!(all.color() != alone.color());
        }
    }
}

#[test]
fn lights_that_the_camera_sees_are_cut_away_too() {
    let scene = |lights: Vec<Light>| {
        let draft = SceneDraft::new().camera([0.0; 3], [0.0, 0.0, -1.0]);
        let mut scene = wall(draft, 9.0, 0.0).finish("light");
        scene.lights = lights.into_iter().map(|light| light.with_visible(true)).collect();
        scene
    };
    let [x, y, at] = [Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, -4.0)];
    for light in
        [Light::sphere(at, 0.5).unwrap(), Light::disk(at, Vec3::Z, 1.0).unwrap(), Light::rectangle(at, x, y).unwrap()]
    {
        let middle = |near: f32, far: f32| {
            let frame = render(&clipped(&scene(vec![light.clone()]), near, far), &settings().with_size([1, 1]));
            frame.color()[0][0]
        };
        let bright = middle(0.0, f32::INFINITY);
        assert_eq!(middle(3.0, 5.0), bright, "{light:?}");
        for (near, far) in [(4.5, f32::INFINITY), (0.0, 3.0)] {
            assert!(middle(near, far) < 0.5 * bright, "{light:?} from {near} to {far}");
        }
    }
}

/// The light mesh is as fine as what is seen needs.
#[test]
fn the_step_is_chosen_for_what_is_seen() {
    let light = LightKind::Sphere { position: Vec3::new(0.0, 6.0, -20.0), radius: 0.4 };
    let draft = wall(SceneDraft::new().camera([0.0; 3], [0.0, 0.0, -1.0]).light(light), 0.5, 0.5);
    let scene = wall(draft, 40.0, 0.5).finish("walls");
    let step = |scene: &Scene| {
        let settings = settings().with_mode(Mode::LightMesh).with_lookup(Lookup::HalfBall);
        let settings = settings.with_acceleration(Acceleration::Bvh).with_samples(4);
        render(scene, &settings).stats.settings.step.unwrap()
    };
    let [near, far] = [step(&scene), step(&clipped(&scene, 1.0, f32::INFINITY))];
    assert!(far > 5.0 * near, "{near} and {far}");
}
