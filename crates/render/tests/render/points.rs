//! Visibility at given points equals that of an image at the points of its pixels.

use glam::{DVec3, Vec3};
use lightmesh_render::{Frame, Mode, PointVisibility, PreparedScene, RenderError, Settings, Step, Unobserved};
use lightmesh_scene::Scene;
use lightmesh_testkit::{half_plane, pile};

use crate::{LAMP, POINT, light_mesh, mode, prepared, renderer};

const SIZE: [u32; 2] = [96, 64];

/// The surface points and normals of an image with their pixels.
fn seen(scene: &PreparedScene, frame: &Frame) -> (Vec<usize>, Vec<Vec3>, Vec<Vec3>) {
    let layers = frame.layers().unwrap();
    let pixels: Vec<usize> = (0..layers.depth.len()).filter(|&pixel| layers.depth[pixel].is_finite()).collect();
    let world = |pixel: usize| Vec3::from(layers.position[pixel]).as_dvec3();
    let points = pixels.iter().map(|&pixel| scene.scene.geometry.to_local(world(pixel))).collect();
    let normals = pixels.iter().map(|&pixel| 3.0 * Vec3::from(layers.normal[pixel])).collect();
    (pixels, points, normals)
}

fn visibility(scene: &PreparedScene, points: &[Vec3], normals: &[Vec3], settings: &Settings) -> PointVisibility {
    renderer().visibility(scene, points, normals, settings, &Unobserved).unwrap()
}

/// Compares the visibility of each light at the points of an image with the image's own: the mean and the largest share of points that differ.
fn compare(scene: &PreparedScene, settings: &Settings, tolerance: f32) -> f64 {
    let frame = renderer().render_prepared(scene, &settings.clone().with_layers(true), &Unobserved).unwrap();
    let (pixels, points, normals) = seen(scene, &frame);
    assert!(pixels.len() > 1500, "{} pixels see something", pixels.len());
    let baked = visibility(scene, &points, &normals, settings);
    assert_eq!((baked.points(), baked.lights()), (pixels.len(), scene.scene.lights.len()));
    assert_eq!(baked.stats.counts.pixels, pixels.len() as u64);
    let mut differ = 0;
    for (light, plane) in frame.layers().unwrap().visibility.iter().enumerate() {
        for (point, &pixel) in pixels.iter().enumerate() {
            differ += usize::from((baked.of(light, point) - plane[pixel]).abs() > tolerance);
        }
    }
    differ as f64 / (pixels.len() * baked.lights()) as f64
}

#[test]
fn points_of_an_image_see_what_its_pixels_see() {
    let scene = prepared(&pile(DVec3::ZERO, &[POINT, LAMP]));
    // Segment origins differ by rounding, so a few rays at edges differ, too.
    assert!(compare(&scene, &mode(Mode::RayTrace, SIZE), 0.0) < 0.002);
    assert!(compare(&scene, &light_mesh(SIZE, 0.2, 2.1).with_samples(8), 0.01) < 0.02);
    let scene = prepared(&Scene::open("builtin:childpark").unwrap());
    assert!(compare(&scene, &mode(Mode::RayTrace, SIZE), 0.0) < 0.005);
    // Patterns differ from point to point, so only means of many rays agree.
    assert!(compare(&scene, &mode(Mode::Area, SIZE).with_samples(256), 0.1) < 0.02);
}

#[test]
fn what_lies_behind_a_surface_is_dark() {
    let scene = prepared(&half_plane());
    let above = Vec3::new(0.3, 1.0, 0.2);
    let lit = visibility(&scene, &[above; 2], &[Vec3::Y, Vec3::NEG_Y], &mode(Mode::RayTrace, SIZE));
    let light = scene.scene.lights[0].position().unwrap();
    let expected = if light.y > above.y { [1.0, 0.0] } else { [0.0, 1.0] };
    assert_eq!(lit.of_light(0), expected);
}

#[test]
fn points_outside_of_the_scene_have_light_points_too() {
    let scene = prepared(&pile(DVec3::ZERO, &[POINT]));
    let far = [Vec3::new(60.0, 3.0, 5.0), Vec3::new(-80.0, 9.0, 5.0)];
    let seen = visibility(&scene, &far, &[Vec3::NEG_X, Vec3::X], &light_mesh(SIZE, 0.2, 2.1));
    assert_eq!(seen.of_light(0), [1.0, 1.0]);
    let lattice = seen.stats.settings.lattice.unwrap();
    assert!(lattice.dims[0] > 700, "{:?}", lattice.dims);
}

#[test]
fn no_points_see_nothing() {
    let scene = prepared(&half_plane());
    for settings in [mode(Mode::Area, SIZE), light_mesh(SIZE, 0.2, 2.1)] {
        let none = visibility(&scene, &[], &[], &settings);
        assert_eq!((none.points(), none.into_shares().len()), (0, 0));
    }
}

#[test]
fn points_that_cannot_be_used_are_refused() {
    let scene = prepared(&half_plane());
    let refused = |points: &[Vec3], normals: &[Vec3], settings: Settings| {
        renderer().visibility(&scene, points, normals, &settings, &Unobserved).map(|_| ()).unwrap_err()
    };
    let settings = || mode(Mode::RayTrace, SIZE);
    let error = refused(&[Vec3::ZERO; 3], &[Vec3::Y; 2], settings());
    assert!(matches!(error, RenderError::Points { points: 3, normals: 2, .. }), "{error}");
    for (point, normal) in
        [(Vec3::NAN, Vec3::Y), (Vec3::INFINITY, Vec3::Y), (Vec3::X, Vec3::ZERO), (Vec3::X, Vec3::NAN)]
    {
        let error = refused(&[Vec3::ONE, point], &[Vec3::Y, normal], settings());
        assert!(matches!(error, RenderError::Point { index: 1, .. }), "{error}");
    }
    let far =
        refused(&[Vec3::splat(1e30)], &[Vec3::Y], settings().with_mode(Mode::LightMesh).with_step(Step::Fixed(0.1)));
    assert!(matches!(far, RenderError::Lattice(_)), "{far}");
}
