//! Degenerate input: no panic, no NaN, and whatever can be stated about the image holds.

use glam::{DVec3, Vec3};
use lightmesh_render::{Device, Frame, Mode, RenderError, Renderer, Settings, Step};
use lightmesh_scene::{Geometry, GeometryError, LightKind, Scene};
use lightmesh_testkit::{MODES, Picture, Random, SceneDraft, pile, render};

const SIZE: [u32; 2] = [24, 18];

/// Renders in all modes, with fixed and automatic steps, and passes each image to `judge`.
fn in_all_modes(scene: &Scene, size: [u32; 2], judge: impl Fn(&Frame)) {
    let extent = scene.geometry.mesh.bounds().diagonal();
    let fixed = if extent > 0.0 && extent.is_finite() { extent / 40.0 } else { 1.0 };
    for mode in MODES {
        for step in [Step::Auto, Step::Fixed(fixed)] {
            let settings =
                Settings::default().with_mode(mode).with_size(size).with_step(step).with_samples(5).with_bounces(1);
            let frame = render(scene, &settings);
            if let Some(fault) = Picture::new(&frame).fault() {
                panic!("{}, {mode:?}, {step:?}: {fault}", scene.name);
            }
            judge(&frame);
        }
    }
}

fn hits(frame: &Frame) -> usize {
    Picture::new(frame).hits().count()
}

#[test]
fn an_empty_scene_is_all_background() {
    let scene = SceneDraft::new().point_light([0.0, 1.0, 0.0]).background(Vec3::ONE).finish("empty");
    in_all_modes(&scene, SIZE, |frame| {
        assert_eq!(hits(frame), 0);
        assert!(frame.image.color().iter().all(|&color| color == [1.0; 3]));
    });
}

#[test]
fn one_triangle_is_a_scene() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for draft in [SceneDraft::new(), SceneDraft::new().point_light([0.3, 0.3, 2.0])] {
        let scene = draft.triangles(&corners, &[[0, 1, 2]]).camera([0.3, 0.3, 2.0], [0.3, 0.3, 0.0]).finish("one");
        in_all_modes(&scene, SIZE, |frame| assert!(hits(frame) > 20, "{}", hits(frame)));
        in_all_modes(&scene, [1, 1], |frame| assert_eq!(hits(frame), 1));
    }
}

#[test]
fn pictures_may_be_lines() {
    let scene = pile(DVec3::ZERO, &[LightKind::Sphere { position: Vec3::new(2.0, 4.0, 1.0), radius: 0.5 }]);
    for size in [[1, 1], [1, 40], [40, 1], [2, 1], [1, 2]] {
        in_all_modes(&scene, size, |frame| assert!(hits(frame) > 0, "{size:?}"));
    }
}

#[test]
fn a_scene_without_lights_is_ambient() {
    let mut scene = pile(DVec3::ZERO, &[]);
    scene.lights.ambient = Some(Vec3::splat(0.5));
    in_all_modes(&scene, SIZE, |frame| {
        for pixel in Picture::new(frame).hits() {
            assert_eq!(frame.image.color()[pixel], [0.4; 3]);
        }
    });
}

#[test]
fn triangles_without_area_do_no_harm() {
    let mut random = Random::new(3);
    let mut draft = SceneDraft::new().floor(-1.0, 3.0);
    for _ in 0..200 {
        let (a, b, c) = (random.in_cube(), random.in_cube(), random.in_cube());
        for needle in [[a, a, a], [a, b, a], [a, b, a.lerp(b, 0.3)], [a, b, b + (c - b) * 1e-7]] {
            draft = draft.triangles(&needle, &[[0, 1, 2]]);
        }
    }
    let scene = draft.point_light([1.0, 3.0, 1.0]).camera([2.0, 2.5, 3.0], [0.0; 3]).finish("needles");
    in_all_modes(&scene, [96, 96], |frame| assert!(hits(frame) > 1000, "{}", hits(frame)));
}

#[test]
fn a_needle_met_at_its_corner_has_a_normal() {
    // In exact arithmetic these triangles have an area; that of the third is below what a product of `f32` can represent.
    let needles = [
        [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [3.0, 0.3, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 0.7, 0.0], [3.0, 2.1, 0.0]],
        [[0.0, 0.0, 0.0], [1e-22, 0.0, 0.0], [0.0, 1e-22, 0.0]],
    ];
    for needle in needles {
        let [x, y, z] = needle[1];
        let draft = SceneDraft::new().triangles(&needle.map(DVec3::from), &[[0, 1, 2]]).point_light([0.0, 0.0, 5.0]);
        let scene = draft.orthographic([x, y, z + 1.0], [x, y, z], 1.0).finish("needle");
        in_all_modes(&scene, [1, 1], |_| ());
    }
}

#[test]
fn coordinates_that_are_no_numbers_are_never_hit() {
    let mut scene = pile(DVec3::ZERO, &[LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0), spread: 0.0 }]);
    let whole = render(&scene, &Settings::default().with_mode(Mode::RayTrace).with_size(SIZE));
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        let first = scene.geometry.mesh.positions.len() as u32;
        scene.geometry_mut().mesh.positions.extend([Vec3::splat(bad), Vec3::X, Vec3::Y]);
        scene.geometry_mut().mesh.triangles.push([first, first + 1, first + 2]);
        scene.geometry_mut().mesh.materials.push(0);
    }
    let settings = Settings::default().with_size(SIZE).with_step(Step::Fixed(0.2));
    let ray_traced = render(&scene, &settings.clone().with_mode(Mode::RayTrace));
    assert!(Picture::new(&ray_traced).bits() == Picture::new(&whole).bits());
    let frame = render(&scene, &settings);
    assert_eq!(Picture::new(&frame).fault(), None);
    assert_eq!(hits(&frame), hits(&whole));
}

#[test]
fn a_flat_scene_is_a_scene() {
    for position in [[0.0, 2.0, 0.0], [0.1, 0.0, 0.2]] {
        let scene = SceneDraft::new().floor(0.0, 2.0).point_light(position).camera([1.0, 2.0, 3.0], [0.0; 3]);
        in_all_modes(&scene.finish("flat"), SIZE, |frame| assert!(hits(frame) > 100));
    }
}

#[test]
fn lights_may_be_anywhere() {
    // Inside a box, in a surface, on a corner, and where the camera is.
    for position in [[-0.2, 0.5, -0.3], [1.2, 0.6, 0.2], [0.8, 0.6, 0.9], [2.5, 3.1, 4.2]].map(Vec3::from) {
        let point = LightKind::Point { position, spread: 0.4 };
        let sphere = LightKind::Sphere { position, radius: 0.4 };
        let disk = LightKind::Disk { position, normal: Vec3::Y, radius: 0.4 };
        in_all_modes(&pile(DVec3::ZERO, &[point, sphere, disk]), SIZE, |frame| assert!(hits(frame) > 100));
    }
}

#[test]
fn a_light_may_be_the_surface_point() {
    let scene = SceneDraft::new().floor(0.0, 2.0).point_light([0.0; 3]).camera([-1.0, 1.0, 0.0], [0.0; 3]);
    in_all_modes(&scene.finish("P = L"), [1, 1], |frame| assert_eq!(hits(frame), 1));
}

#[test]
fn a_light_may_be_a_light_point() {
    let mut scene =
        SceneDraft::new().floor(0.0, 2.0).point_light([0.0; 3]).camera([0.0, 1.0, 3.0], [0.0; 3]).finish("on");
    let settings = Settings::default().with_size(SIZE).with_step(Step::Fixed(0.25));
    let lattice = render(&scene, &settings).stats.settings.lattice.unwrap();
    // The first layer of light points above the floor, near its middle.
    let index = [0, 1, 2].map(|axis| (-lattice.origin[axis] / 0.25).ceil());
    let position = Vec3::from([0, 1, 2].map(|axis| lattice.origin[axis] as f32 + 0.25 * index[axis] as f32));
    assert!(position.y > 0.0 && position.length() < 0.5, "{position}");
    scene.lights[0].kind = LightKind::Point { position, spread: 0.0 };
    in_all_modes(&scene, SIZE, |_| ());
    let frame = render(&scene, &settings);
    let picture = Picture::new(&frame);
    // Nothing shadows the floor, least of all the light point that coincides with the light.
    assert!(picture.visibilities(0).iter().all(|&share| share == 1.0));
}

#[test]
fn scenes_may_be_tiny_or_huge() {
    let plain = |scale: f64| {
        let scaled = |numbers: [f64; 3]| numbers.map(|number| number * scale);
        let light = LightKind::Point { position: Vec3::new(2.0, 4.0, 1.0) * scale as f32, spread: 0.0 };
        let scene = SceneDraft::new()
            .floor(0.0, 5.0 * scale)
            .cuboid(scaled([-1.0, -0.1, -1.0]), scaled([0.5, 1.1, 0.3]))
            .light(light)
            .camera(scaled([2.5, 3.1, 4.2]), scaled([0.0, 0.4, 0.0]))
            .finish("scaled");
        in_all_modes(&scene, SIZE, |frame| assert!(hits(frame) > 250, "scale {scale}: {}", hits(frame)));
        let step = Step::Fixed(0.2 * scale as f32);
        let frame = render(&scene, &Settings::default().with_size(SIZE).with_step(step));
        Picture::new(&frame).visibilities(0)
    };
    let usual = plain(1.0);
    for scale in [1e-6, 1e6] {
        // Only light points within rounding of a boundary may differ.
        let difference = lightmesh_testkit::mean_difference(&plain(scale), &usual);
        assert!(difference < 1e-3, "scale {scale}: {difference}");
    }
}

#[test]
fn geometry_that_does_not_hold_together_is_refused() {
    let render = |change: fn(&mut Geometry)| {
        let mut scene = pile(DVec3::ZERO, &[]);
        change(scene.geometry_mut());
        let settings = Settings::default().with_mode(Mode::RayTrace).with_size(SIZE);
        Renderer::new(Device::Cpu).unwrap().render(&scene, &settings).map(|_| ())
    };
    assert!(render(|_| {}).is_ok());
    let vertex = render(|geometry| geometry.mesh.triangles[5][1] = 9999);
    assert!(matches!(vertex, Err(RenderError::Geometry(GeometryError::Vertex { triangle: 5, index: 9999, .. }))));
    let normals = render(|geometry| geometry.mesh.normals = vec![Vec3::Y; 2]);
    assert!(matches!(normals, Err(RenderError::Geometry(GeometryError::Attribute { attribute: "normals", .. }))));
    let material = render(|geometry| geometry.materials.clear());
    assert!(matches!(material, Err(RenderError::Geometry(GeometryError::Material { triangle: 0, .. }))));
}
