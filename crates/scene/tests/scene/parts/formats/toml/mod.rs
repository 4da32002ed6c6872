//! Known answers for every table of the scene file, and the message for every kind of mistake.

mod motion;
mod opacity;
mod schema;
mod shared;

use std::fs;
use std::path::PathBuf;

use glam::{DVec3, Vec2, Vec3};
use lightmesh_scene::{Facets, Falloff, Fov, LightKind, Projection, Scene, Weight, Wrap};
use tempfile::TempDir;

/// A folder with a scene file and a mesh of one triangle in it.
fn folder(text: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let path = folder.path().join("room.toml");
    fs::write(&path, text).unwrap();
    (folder, path)
}

fn open(text: &str) -> Scene {
    let (_folder, path) = folder(text);
    Scene::open(path).unwrap_or_else(|error| panic!("{error}"))
}

/// The message, without the folder.
fn error(text: &str) -> String {
    let (folder, path) = folder(text);
    let message = Scene::open(path).expect_err("an error").to_string();
    message.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn a_whole_file_is_read() {
    let scene = open(
        r#"
        [camera]
        position = [13, 6, 14]
        target = [13, 6, 10]
        vfov = 40
        [ambient]
        intensity = 0.1
        background = [0.6, 0.75, 0.9]
        [[light]]
        kind = "point"
        position = [8, 14, 4]
        spread = 0.5
        [[material]]
        name = "stone"
        kd = [0.7, 0.7, 0.65]
        ks = 0.25
        shininess = 30
        [[mesh]]
        file = "one.obj"
        material = "stone"
        [lightmesh]
        step = 0.1
        radius = 3.1
        weight = "quadratic"
        "#,
    );
    assert_eq!(scene.name, "room");
    let camera = &scene.cameras[0];
    assert_eq!((camera.position, camera.direction), (Vec3::new(13.0, 6.0, 14.0), Vec3::NEG_Z));
    assert_eq!((camera.up, camera.projection), (Vec3::Y, Projection::Perspective(Fov::Vertical(40.0))));
    assert_eq!(scene.lights.ambient, Some(Vec3::splat(0.1)));
    assert_eq!(scene.lights.background, Some(Vec3::new(0.6, 0.75, 0.9)));
    let light = &scene.lights[0];
    assert_eq!(light.kind, LightKind::Point { position: Vec3::new(8.0, 14.0, 4.0), spread: 0.5 });
    assert_eq!((light.intensity, light.falloff), (Vec3::ONE, Falloff::None));
    let stone = &scene.geometry.materials[0];
    assert_eq!((stone.ka, stone.kd), (Vec3::new(0.7, 0.7, 0.65), Vec3::new(0.7, 0.7, 0.65)));
    assert_eq!((stone.ks, stone.shininess, stone.emission), (Vec3::splat(0.25), 30.0, Vec3::ZERO));
    assert_eq!(
        (scene.geometry.mesh.triangles.len(), scene.geometry.mesh.materials[0], scene.geometry.materials.len()),
        (1, 0, 1)
    );
    let defaults = scene.light_mesh;
    assert_eq!((defaults.step, defaults.radius, defaults.weight), (Some(0.1), Some(3.1), Some(Weight::Quadratic)));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn cameras_of_all_sorts() {
    let scene = open(
        r#"
        [[camera]]
        name = "plan"
        position = [0, 9, 0]
        direction = [0, -2, 0]
        up = [0, 0, -1]
        projection = "orthographic"
        height = 12
        [[camera]]
        position = [0, 1, 5]
        target = [0, 1, 0]
        hfov = 90
        [[camera]]
        position = [0, 1, 5]
        target = [0, 0, 4]
        vfov = 40
        hfov = 90
        shift = [0.25, -1]
        near = 0.5
        far = 20
        [[sphere]]
        center = [0, 1, 0]
        radius = 1
        "#,
    );
    let [plan, wide, both] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!((plan.name.as_str(), plan.direction, plan.up), ("plan", Vec3::NEG_Y, Vec3::NEG_Z));
    assert_eq!(plan.projection, Projection::Orthographic { height: 12.0 });
    assert_eq!(wide.projection, Projection::Perspective(Fov::Horizontal(90.0)));
    assert_eq!(both.projection, Projection::Perspective(Fov::Vertical(40.0)));
    assert!(both.up.dot(both.direction).abs() < 1e-6);
    assert_eq!([plan.shift, both.shift], [Vec2::ZERO, Vec2::new(0.25, -1.0)]);
    assert_eq!([[plan.near, plan.far], [both.near, both.far]], [[0.0, f32::INFINITY], [0.5, 20.0]]);
    assert!(scene.warnings[0].contains("room.toml:13") && scene.warnings[0].contains("vfov"), "{:?}", scene.warnings);
}

/// However many there are, one warning names the first.
#[test]
fn cameras_with_two_angles_are_one_warning() {
    let camera = "[[camera]]\nposition = [0, 1, 5]\ntarget = [0, 1, 0]\nvfov = 40\n";
    let other = format!("{camera}hfov = 60\n");
    let same = format!("{camera}hfov = 40\n");
    let ball = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\n";
    assert!(open(&format!("{camera}{same}{ball}")).warnings.is_empty());
    let scene = open(&format!("{camera}{other}{same}{other}{other}{ball}"));
    let [warning] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
    let sentence = "room.toml:5: the camera has vfov and hfov; vfov = 40 is used, as of 2 more cameras";
    assert!(warning.ends_with(sentence), "{warning}");
}

#[test]
fn a_rectangle_that_faces_down_has_an_up() {
    let light = "[[light]]\nkind = \"rectangle\"\nposition = [0, 5, 0]\ndirection = [0, -1, 0]\nsize = [2, 4]\n";
    let scene = open(&format!("{light}[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n"));
    let LightKind::Rectangle { half_u, half_v, .. } = scene.lights[0].kind else { panic!("a rectangle") };
    assert_eq!((half_u, half_v), (Vec3::X, 2.0 * Vec3::Z));
    assert_eq!(scene.lights[0].surface, Some(Vec3::NEG_Y));
}

#[test]
fn disks_and_rectangles_may_shine_to_both_sides() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let disk = "[[light]]\nkind = \"disk\"\nposition = [0, 5, 0]\nnormal = [0, -1, 0]\nradius = 1\n";
    let rectangle = "[[light]]\nkind = \"rectangle\"\nposition = [0, 5, 0]\nu = [1, 0, 0]\nv = [0, 0, 1]\n";
    for light in [disk, rectangle] {
        for (line, surface) in
            [("", Some(Vec3::NEG_Y)), ("one_sided = true\n", Some(Vec3::NEG_Y)), ("one_sided = false\n", None)]
        {
            assert_eq!(open(&format!("{light}{line}{ball}")).lights[0].surface, surface);
        }
    }
    let point = "[[light]]\nkind = \"point\"\nposition = [0, 5, 0]\none_sided = false\n";
    let error = error(&format!("{point}{ball}"));
    assert!(error.contains("does not take `one_sided`"), "{error}");
}

#[test]
fn lights_of_all_kinds() {
    let scene = open(
        r#"
        [[light]]
        kind = "directional"
        direction = [0, -2, 0]
        [[light]]
        kind = "directional"
        direction = [0, -2, 0]
        angle = 0.53
        [[light]]
        kind = "spot"
        position = [0, 5, 0]
        target = [0, 0, 0]
        inner = 20
        outer = 30
        intensity = [1, 2, 3]
        falloff = "inverse-square"
        [[light]]
        kind = "sphere"
        position = [1, 2, 3]
        radius = 0.5
        [[light]]
        kind = "disk"
        position = [1, 2, 3]
        normal = [0, 0, 2]
        radius = 0.5
        [[light]]
        kind = "rectangle"
        position = [1, 2, 3]
        u = [2, 0, 0]
        v = [0, 0, 4]
        [[light]]
        kind = "rectangle"
        position = [0, 5, 0]
        direction = [0, 0, -1]
        size = [2, 4]
        [[light]]
        kind = "spot"
        position = [0, 5, 0]
        direction = [0, -1, 0]
        radius = 0.25
        [[sphere]]
        center = [0, 0, 0]
        radius = 1
        "#,
    );
    let position = Vec3::new(1.0, 2.0, 3.0);
    let kinds: Vec<&LightKind> = scene.lights.iter().map(|light| &light.kind).collect();
    assert_eq!(*kinds[0], LightKind::Directional { direction: Vec3::NEG_Y, angle: 0.0 });
    let angle = 0.53f64.to_radians() as f32;
    assert_eq!(*kinds[1], LightKind::Directional { direction: Vec3::NEG_Y, angle });
    let (inner, outer) = (20f64.to_radians() as f32, 30f64.to_radians() as f32);
    let up = Vec3::new(0.0, 5.0, 0.0);
    assert_eq!(*kinds[2], LightKind::Spot { position: up, direction: Vec3::NEG_Y, inner, outer, radius: 0.0 });
    assert_eq!(scene.lights[2].intensity, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(scene.lights[2].falloff, Falloff::InverseSquare);
    assert_eq!(*kinds[3], LightKind::Sphere { position, radius: 0.5 });
    assert_eq!(*kinds[4], LightKind::Disk { position, normal: Vec3::Z, radius: 0.5 });
    assert_eq!(*kinds[5], LightKind::Rectangle { position, half_u: Vec3::X, half_v: 2.0 * Vec3::Z });
    assert_eq!(*kinds[6], LightKind::Rectangle { position: up, half_u: Vec3::NEG_X, half_v: 2.0 * Vec3::Y });
    let surfaces: Vec<Option<Vec3>> = scene.lights.iter().map(|light| light.surface).collect();
    assert_eq!(surfaces[4..7], [Some(Vec3::Z), Some(Vec3::NEG_Y), Some(Vec3::NEG_Z)]);
    assert!(surfaces[..4].iter().all(Option::is_none));
    let outer = std::f32::consts::FRAC_PI_4;
    assert_eq!(*kinds[7], LightKind::Spot { position: up, direction: Vec3::NEG_Y, inner: 0.0, outer, radius: 0.25 });
}

#[test]
fn solids_have_their_triangles_and_boxes() {
    const CASES: [(&str, usize, [f32; 3], [f32; 3]); 7] = [
        ("[[box]]\nmin = [0, 0, 0]\nmax = [1, 2, 3]", 12, [0.0, 0.0, 0.0], [1.0, 2.0, 3.0]),
        ("[[box]]\ncenter = [1, 1, 1]\nsize = [2, 4, 6]\nrotate = [0, 0, 90]", 12, [-1.0, 0.0, -2.0], [3.0, 2.0, 4.0]),
        ("[[plane]]\npoint = [1, 2, 3]\nnormal = [0, 1, 0]\nsize = [2, 6]", 2, [0.0, 2.0, 0.0], [2.0, 2.0, 6.0]),
        ("[[triangle]]\na = [0, 0, 0]\nb = [1, 0, 0]\nc = [0, 1, 0]", 1, [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]),
        ("[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]", 1, [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]),
        ("[[cylinder]]\nbase = [0, 0, 0]\ntop = [0, 2, 0]\nradius = 1", 384, [-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]),
        (
            "[[cylinder]]\ncenter = [0, 0, 0]\naxis = [2, 0, 0]\nheight = 2\nradius = 1\nsegments = 8\ncaps = false",
            16,
            [-1.0, -1.0, -1.0],
            [1.0, 1.0, 1.0],
        ),
    ];
    for (text, triangles, min, max) in CASES {
        let scene = open(text);
        let bounds = scene.geometry.mesh.bounds();
        assert_eq!(scene.geometry.mesh.triangles.len(), triangles, "{text}");
        assert!((bounds.min - Vec3::from(min)).length() < 1e-6, "{text}: {bounds:?}");
        assert!((bounds.max - Vec3::from(max)).length() < 1e-6, "{text}: {bounds:?}");
        assert_eq!(scene.geometry.materials.len(), 1, "{text}");
    }
}

#[test]
fn a_sphere_far_away_keeps_its_shape() {
    for offset in [0.0, 1e5, 1e6] {
        let scene = open(&format!("[[sphere]]\ncenter = [{offset:?}, {:?}, 0.25]\nradius = 2", -offset));
        let center = scene.to_local(DVec3::new(offset, -offset, 0.25));
        for (position, normal) in scene.geometry.mesh.positions.iter().zip(&scene.geometry.mesh.normals) {
            assert!((position.distance(center) - 2.0).abs() < 2e-6, "{offset}");
            assert!(((*position - center) / 2.0).distance(*normal) < 2e-6, "{offset}");
        }
    }
}

#[test]
fn a_plane_without_size_reaches_far_around_the_rest() {
    let scene = open("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\n[[box]]\nmin = [9, 1, 9]\nmax = [10, 2, 10]");
    let bounds = scene.geometry.mesh.bounds();
    let (world_min, world_max) = (scene.to_world(bounds.min), scene.to_world(bounds.max));
    let edge = 20.0 * 3f64.sqrt();
    assert!((world_max.x - world_min.x - edge).abs() < 1e-4 && world_min.y.abs() < 1e-6, "{bounds:?}");
    assert!((0.5 * (world_min.x + world_max.x) - 9.5).abs() < 1e-5, "{bounds:?}");
}

#[test]
fn a_mesh_is_scaled_then_turned_about_x_y_z_then_moved() {
    let mesh = "[[mesh]]\nfile = \"one.obj\"\nscale = 2\nrotate = [90, 90, 0]\ntranslate = [1e6, 0, 0]";
    let scene = open(mesh);
    // (1,0,0) → scaled (2,0,0) → about X same → about Y (0,0,-2); (0,1,0) → (0,2,0) → (0,0,2) → (2,0,0).
    let corners = scene.geometry.mesh.corners(0).map(|corner| scene.to_world(corner) - DVec3::new(1e6, 0.0, 0.0));
    let expected = [DVec3::ZERO, DVec3::new(0.0, 0.0, -2.0), DVec3::new(2.0, 0.0, 0.0)];
    for (corner, expected) in corners.iter().zip(expected) {
        assert!(corner.distance(expected) < 1e-6, "{corners:?}");
    }
}

#[test]
fn a_mirrored_mesh_keeps_its_front() {
    let scene = open("[[mesh]]\nfile = \"one.obj\"\nscale = [1, 1, -1]");
    let [a, b, c] = scene.geometry.mesh.corners(0);
    assert!((b - a).cross(c - a).z < 0.0);
}

/// Text with one mistake, and the expected message. Each names the line and a remedy after the semicolon.
#[rustfmt::skip]
const MISTAKES: [(&str, &str); 44] = [
    ("[[sphere]]\ncenter = [0, 1, 0]\nradius = -1", "radius = -1 is not positive, room.toml:3; give a radius above 0"),
    ("[[sphere]]\ncenter = [0, 1, 0]\nradius = nan", "radius = nan is not finite, room.toml:3; "),
    ("[[sphere]]\ncenter = [0, inf, 0]\nradius = 1", "center = [0, inf, 0] is not finite, room.toml:2; "),
    ("[[sphere]]\ncenter = [0, 1e30, 0]\nradius = 1", "is too large, room.toml:2; stay below 1e18"),
    ("[[sphere]]\ncenter = [0, 1, 0]\nraduis = 1", "unknown key `raduis`, room.toml:3; did you mean `radius`?"),
    ("[[sphere]]\n\ncenter = [0, 1, 0]", "key `radius` is missing, room.toml:1; add `radius = …`"),
    ("[[sphere]]\ncenter = [0, 1]\nradius = 1", "room.toml:2; use a value that is valid for `center`"),
    ("[[sphere]]\ncenter = \"up\"\nradius = 1", "room.toml:2; use a value that is valid for `center`"),
    ("[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nsegments = 2", "segments = 2 cannot be used, room.toml:4; give a whole number from 3"),
    ("[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"ston\"\n[[material]]\nname = \"stone\"", "there is no material named `ston`, room.toml:4; did you mean `stone`?"),
    ("[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"ston\"", "there is no material named `ston`, room.toml:4; there are none"),
    ("[sphere", "room.toml:1; "),
    ("[[spere]]\nradius = 1", "unknown key `spere`, room.toml:1; did you mean `sphere`?"),
    ("[camera]\nposition = [0, 0, 0]", "key `target` is missing, room.toml:1; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 0]", "target = [0, 0, 0] is the camera's own position, room.toml:3; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 1, 0]", "key `up` is missing, room.toml:1; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 1, 0]\nup = [0, 3, 0]", "up = [0, 3, 0] is parallel to the view direction, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nvfov = 180", "vfov = 180 is not under 180 degrees, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nprojection = \"orthographic\"", "key `height` is missing, room.toml:1; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nheight = 3", "height = 3 has no meaning in a perspective camera, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nshift = [0, 1001]", "shift = [0, 1001] is more than 1000 heights of the image, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nshift = [nan, 0]", "shift"),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nnear = -1", "near = -1 is negative, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nnear = 2\nfar = 2", "far = 2 is not beyond `near`, room.toml:5; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nfar = 0", "far = 0 is not positive, room.toml:4; "),
    ("[camera]\nposition = [0, 0, 0]\ntarget = [0, 0, 1]\nfar = inf", "far = inf is not finite, room.toml:4; "),
    ("[[light]]\nkind = \"spot\"\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\nradius = -1", "radius = -1 is not between 0 and"),
    ("[[light]]\nkind = \"lamp\"\nposition = [0, 0, 0]", "room.toml:2; use a value that is valid for `kind`"),
    ("[[light]]\nkind = \"point\"", "key `position` is missing, room.toml:1; "),
    ("[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nradius = 1", "kind = \"point\" does not take `radius`, room.toml:2; it takes position, spread"),
    ("[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\nangle = 180", "angle = 180 is not between 0 and 179, room.toml:4; give a number from 0 to 179"),
    ("[[light]]\nkind = \"directional\"\nangle = -0.5\ndirection = [0, -1, 0]", "angle = -0.5 is not between 0 and 179, room.toml:3; "),
    ("[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\nangle = nan", "angle = nan is not finite, room.toml:4; "),
    ("[[light]]\nkind = \"spot\"\nposition = [0, 0, 0]\nangle = 5", "kind = \"spot\" does not take `angle`, room.toml:2; it takes position, direction, target, inner, outer"),
    ("[[light]]\nkind = \"directional\"\ndirection = [0, -1, 0]\nspread = 5", "kind = \"directional\" does not take `spread`, room.toml:2; it takes direction, angle, visible, name"),
    ("[[light]]\nkind = \"sphere\"\nposition = [0, 0, 0]", "key `radius` is missing, room.toml:1; "),
    ("[[light]]\nkind = \"spot\"\nposition = [0, 0, 0]\ndirection = [0, 1, 0]\ninner = 50", "inner = 50 is above outer = 45, room.toml:5; "),
    ("[[light]]\nkind = \"rectangle\"\nposition = [0, 0, 0]\nu = [1, 0, 0]\nv = [1, 1, 0]", "v = [1, 1, 0] is not at a right angle to `u`, room.toml:5; "),
    ("[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = -1", "intensity = -1 is below 0, room.toml:4; "),
    ("[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"", "name = \"a\" is used by an earlier material, room.toml:4; "),
    ("[[mesh]]\nfile = \"none.obj\"", "none.obj; check that it exists and is readable (named by "),
    ("[[mesh]]\nfile = \"one.obj\"\nscale = 0", "scale = 0 is zero or not finite, room.toml:3; "),
    ("[[box]]\nmin = [0, 0, 0]\nmax = [1, 0, 1]", "max = [1, 0, 1] is not above `min` on every axis, room.toml:3; "),
    ("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]", "key `size` is missing, room.toml:1; "),
];

#[test]
fn every_mistake_is_named_with_its_line_and_a_remedy() {
    for (text, expected) in MISTAKES {
        let message = error(text);
        assert!(message.contains(expected), "{text}\n  says: {message}\nwanted: {expected}");
        assert!(message.contains("room.toml:") && message.contains("; "), "{message}");
        assert!(!message.contains('\n') && !message.starts_with("error"), "{message}");
    }
}

#[test]
fn text_that_is_not_utf8_is_refused_with_its_line() {
    let (_folder, path) = folder("");
    fs::write(&path, b"[camera]\nposition = \xff").unwrap();
    assert!(Scene::open(path).unwrap_err().to_string().contains("room.toml:2"));
}

/// A folder with an image of one red and one blue texel and a scene file.
fn textured_folder(text: &str) -> (TempDir, PathBuf) {
    let (folder, path) = folder(text);
    let picture = image::RgbImage::from_fn(2, 1, |x, _| image::Rgb(if x == 0 { [255, 0, 0] } else { [0, 0, 255] }));
    picture.save_with_format(folder.path().join("oak.png"), image::ImageFormat::Png).unwrap();
    (folder, path)
}

#[test]
fn a_material_may_have_a_texture() {
    let (_folder, path) = textured_folder(
        r#"
        [[material]]
        name = "oak"
        texture = "oak.png"
        texture_wrap = ["clamp", "mirror"]
        texture_scale = [4, 2]
        texture_rotate = 90
        texture_offset = [0.5, 0]
        [[material]]
        name = "floor"
        texture = "oak.png"
        texture_wrap = "mirror"
        texture_scale = 10
        [[material]]
        name = "plain"
        [[box]]
        min = [0, 0, 0]
        max = [1, 1, 1]
        material = "oak"
        [[sphere]]
        center = [4, 0, 0]
        radius = 1
        segments = 8
        material = "plain"
        [[triangle]]
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        uvs = [[0, 0], [2, 0], [0, -3]]
        material = "floor"
        "#,
    );
    let scene = Scene::open(path).unwrap();
    assert_eq!((scene.geometry.textures.len(), scene.geometry.textures[0].size), (1, [2, 1]));
    let [oak, floor, plain] = [0, 1, 2].map(|index: usize| scene.geometry.materials[index].texture);
    let (oak, floor) = (oak.unwrap(), floor.unwrap());
    assert_eq!((oak.wrap, floor.wrap), ([Wrap::Clamp, Wrap::Mirror], [Wrap::Mirror; 2]));
    // Scaled to (4, 2), turned to (-2, 4), moved.
    assert!(oak.transform.transform_point2(Vec2::ONE).distance(Vec2::new(-1.5, 4.0)) < 1e-6);
    assert_eq!(floor.transform.transform_point2(Vec2::ONE), Vec2::splat(10.0));
    assert_eq!(plain, None);
    let uv = |triangle: usize| {
        scene.geometry.mesh.triangles[triangle].map(|vertex| scene.geometry.mesh.uvs[vertex as usize])
    };
    let last = scene.geometry.mesh.triangles.len() - 1;
    assert_eq!(uv(last), [Vec2::ZERO, Vec2::new(2.0, 0.0), Vec2::new(0.0, -3.0)]);
    assert!((0..12).flat_map(uv).all(|uv| uv.cmpge(Vec2::ZERO).all() && uv.cmple(Vec2::ONE).all()));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn what_a_material_emits_may_have_a_texture() {
    let material = |lines: &str| {
        let shape = "[[box]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"sign\"";
        let (_folder, path) = textured_folder(&format!("[[material]]\nname = \"sign\"\n{lines}\n{shape}"));
        let scene = Scene::open(path).unwrap();
        assert_eq!(scene.geometry.mesh.uvs.is_empty(), scene.geometry.textures.is_empty());
        scene.geometry.materials[0].clone()
    };
    let shown = material("emission_texture = \"oak.png\"\ntexture_scale = 3");
    assert_eq!((shown.emission, shown.texture, shown.lamp), (Vec3::ONE, None, true));
    assert_eq!(shown.emission_texture.unwrap().transform.matrix2.x_axis, Vec2::new(3.0, 0.0));
    assert_eq!(material("emission_texture = \"oak.png\"\nemission = [2, 0, 4]").emission, Vec3::new(2.0, 0.0, 4.0));
    let gone = material("emission_texture = \"gone.png\"\nemission = [2, 0, 4]");
    assert_eq!((gone.emission, gone.emission_texture), (Vec3::ZERO, None));
}

#[test]
fn a_material_may_have_an_image_of_normals() {
    let text = |lines: &str| {
        let shape = "[[box]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"wall\"";
        format!("[[material]]\nname = \"wall\"\n{lines}\n{shape}")
    };
    let material = |lines: &str| {
        let (_folder, path) = textured_folder(&text(lines));
        let scene = Scene::open(path).unwrap();
        assert_eq!(scene.geometry.mesh.uvs.is_empty(), scene.geometry.textures.is_empty());
        scene.geometry.materials[0].clone()
    };
    let shown = material("normal_texture = \"oak.png\"\nnormal_scale = -2\ntexture_scale = 3").normal_texture.unwrap();
    assert_eq!((shown.scale, shown.uses.transform.matrix2.x_axis), (-2.0, Vec2::new(3.0, 0.0)));
    assert_eq!(material("normal_texture = \"oak.png\"").normal_texture.unwrap().scale, 1.0);
    assert_eq!(material("normal_texture = \"gone.png\"").normal_texture, None);
    let (_folder, path) = textured_folder(&text("texture = \"oak.png\"\nnormal_scale = 2"));
    let error = Scene::open(path).unwrap_err().to_string();
    assert!(error.contains("normal_scale") && error.contains("has no effect without an image of normals"), "{error}");
}

#[test]
fn a_material_may_have_an_image_of_how_rough_and_metallic_it_is() {
    let text = |lines: &str| {
        let shape = "[[box]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nmaterial = \"wall\"";
        format!("[[material]]\nname = \"wall\"\n{lines}\n{shape}")
    };
    let material = |lines: &str| {
        let (_folder, path) = textured_folder(&text(lines));
        let scene = Scene::open(path).unwrap();
        assert_eq!(scene.geometry.mesh.uvs.is_empty(), scene.geometry.textures.is_empty());
        scene.geometry.materials[0].clone()
    };
    let alone = material("metallic_roughness_texture = \"oak.png\"\ntexture_scale = 3");
    assert_eq!(alone.facets, Some(Facets::new(1.0).with_metallic(1.0)), "as the image says");
    assert_eq!(alone.ks, Vec3::splat(Facets::LAYER));
    let uses = alone.metallic_roughness_texture.unwrap();
    assert_eq!(uses.transform.matrix2.x_axis, Vec2::new(3.0, 0.0));
    let factors = material("metallic_roughness_texture = \"oak.png\"\nroughness = 0.5\nmetallic = 0.25");
    assert_eq!(factors.facets, Some(Facets::new(0.5).with_metallic(0.25)));
    let gone = material("metallic_roughness_texture = \"gone.png\"");
    assert_eq!((gone.metallic_roughness_texture, gone.facets), (None, Some(Facets::new(1.0))), "not a metal");
    for line in ["shininess = 30", "ior = 1.5"] {
        let (_folder, path) = textured_folder(&text(&format!("metallic_roughness_texture = \"oak.png\"\n{line}")));
        let error = Scene::open(path).unwrap_err().to_string();
        assert!(error.contains("facets") && error.contains("`metallic_roughness_texture`"), "{error}");
    }
}

#[test]
fn scenes_without_textures_have_no_texture_coordinates() {
    let scene = open("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1");
    assert!(scene.geometry.mesh.uvs.is_empty() && scene.geometry.textures.is_empty());
}

#[test]
fn a_texture_that_cannot_be_had_is_a_warning() {
    let shape = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nsize = [1, 1]\nmaterial = \"oak\"";
    for name in ["none.png", "../oak.png", "one.obj"] {
        let scene = open(&format!("[[material]]\nname = \"oak\"\ntexture = \"{name}\"\n{shape}"));
        assert_eq!(scene.geometry.materials[0].texture, None);
        assert!(scene.warnings[0].contains("room.toml: 1 texture cannot be used"), "{:?}", scene.warnings);
    }
}

#[test]
fn a_texture_on_a_mesh_without_texture_coordinates_is_a_warning() {
    let text = "[[material]]\nname = \"oak\"\ntexture = \"oak.png\"\n[[mesh]]\nfile = \"one.obj\"\nmaterial = \"oak\"";
    let (_folder, path) = textured_folder(text);
    let scene = Scene::open(path).unwrap();
    assert_eq!(scene.geometry.materials[scene.geometry.mesh.materials[0] as usize].texture, None);
    assert!(scene.warnings[0].starts_with("1 triangles have a texture but no"), "{:?}", scene.warnings);
}

#[test]
fn wrong_texture_keys_name_line_and_key() {
    let material = |line: &str| format!("[[material]]\nname = \"oak\"\n{line}\ntexture = \"none.png\"");
    let cases = [
        ("texture_wrap = \"tile\"", "room.toml:3", "expected \"repeat\", \"mirror\" or \"clamp\""),
        ("texture_scale = \"big\"", "room.toml:3", "expected a number or [u, v]"),
        ("texture_scale = nan", "texture_scale = nan is not finite, room.toml:3", "ordinary number"),
        ("texture_offset = [0, inf]", "texture_offset = [0, inf] is not finite, room.toml:3", "ordinary number"),
        ("texture_rotate = inf", "texture_rotate = inf is not finite, room.toml:3", "ordinary number"),
        ("texture_warp = \"clamp\"", "unknown key `texture_warp`, room.toml:3", "did you mean `texture_wrap`?"),
    ];
    for (line, place, remedy) in cases {
        let message = error(&material(line));
        assert!(message.contains(place) && message.contains(remedy), "{message}");
    }
    let message = error("[[material]]\nname = \"oak\"\ntexture_scale = 3");
    assert_eq!(message, "texture_scale = 3 has no effect without a texture, room.toml:3; add `texture = \"FILE\"`");
}

#[test]
fn a_mesh_outside_of_the_folder_names_its_line() {
    let message = error("[[mesh]]\nfile = \"../one.obj\"");
    assert_eq!(
        message,
        "`../one.obj` leads outside the scene's folder, room.toml:2; move the file there, or allow references outside"
    );
}

#[test]
fn damage_in_a_mesh_names_the_scene_too() {
    let (folder, path) = folder("[[mesh]]\nfile = \"bad.obj\"");
    fs::write(folder.path().join("bad.obj"), "v 0 0 zero\n").unwrap();
    let message = Scene::open(path).unwrap_err().to_string();
    let message = message.replace(&format!("{}/", folder.path().display()), "");
    assert_eq!(
        message,
        "`zero` in a line `v` is not a number, bad.obj:1; correct the line or export the file again (named by room.toml:2)"
    );
}

/// Each kind of reference, through a link out of the folder, and through one within it.
#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder() {
    use std::os::unix::fs::symlink;

    use lightmesh_scene::LoadOptions;

    const OBJ: &str = "mtllib linked\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    const GLTF: &str = r#"{"asset": {"version": "2.0"}, "buffers": [{"uri": "linked", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "nodes": [{"mesh": 0}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}"#;
    let mesh = "[[mesh]]\nfile = \"linked.obj\"";
    let texture = "[[material]]\nname = \"a\"\ntexture = \"linked\"\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"";
    let mut pixel = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(1, 1).write_to(&mut pixel, image::ImageFormat::Png).unwrap();
    let cases: [(&str, &str, &str, &[u8]); 4] = [
        ("room.toml", mesh, "linked.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("room.toml", texture, "linked", pixel.get_ref()),
        ("part.obj", OBJ, "linked", b"newmtl a\nKd 1 0 0\n"),
        ("part.gltf", GLTF, "linked", &[0; 36]),
    ];
    for (file, text, link, content) in cases {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("scene");
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join(file), text).unwrap();
        fs::write(place.path().join("secret"), content).unwrap();
        let open = |options: &LoadOptions| match Scene::open_with(folder.join(file), options) {
            Ok(scene) => scene.warnings.join("\n"),
            Err(error) => error.to_string(),
        };
        let strict = LoadOptions::default();
        for way in ["../secret", place.path().join("secret").to_str().unwrap()] {
            symlink(way, folder.join(link)).unwrap();
            let message = open(&strict);
            let expected = format!("`{link}` leads outside the scene's folder, ");
            assert!(message.contains(&expected) && message.contains(file), "{file}: {message}");
            assert_eq!(open(&strict.clone().with_allow_outside(true)), "", "{file}");
            fs::remove_file(folder.join(link)).unwrap();
        }
        fs::create_dir(folder.join("parts")).unwrap();
        fs::write(folder.join("parts/secret"), content).unwrap();
        symlink("parts/secret", folder.join(link)).unwrap();
        assert_eq!(open(&strict), "", "{file}");
        // A link that leads out, somewhere on the way.
        fs::remove_file(folder.join(link)).unwrap();
        symlink("..", folder.join("up")).unwrap();
        fs::write(folder.join(file), text.replace("linked", "up/linked")).unwrap();
        fs::write(place.path().join(link), content).unwrap();
        assert!(open(&strict).contains("leads outside the scene's folder"), "{file}: {}", open(&strict));
    }
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_without_waiting() {
    let (folder, path) = folder("[[mesh]]\nfile = \"pipe.obj\"");
    assert!(std::process::Command::new("mkfifo").arg(folder.path().join("pipe.obj")).status().unwrap().success());
    let message = Scene::open(&path).unwrap_err().to_string();
    assert!(message.starts_with("this is not a regular file, ") && message.ends_with("room.toml:2)"), "{message}");
    let _listener = std::os::unix::net::UnixListener::bind(folder.path().join("socket.obj")).unwrap();
    fs::write(&path, "[[mesh]]\nfile = \"socket.obj\"").unwrap();
    assert!(Scene::open(&path).unwrap_err().to_string().starts_with("this is not a regular file, "));
}

#[test]
fn messages_quote_little_of_a_file_that_is_no_model() {
    let secret = "root:x:0:0:root:/root:/bin/bash\n".repeat(9);
    for file in ["passwd.obj", "passwd.ply", "passwd.stl", "passwd.gltf", "passwd.toml"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(file);
        for text in
            [secret.clone(), format!("{{\"asset\": {secret:?}}}"), format!("v {secret}"), format!("a = {secret:?}")]
        {
            fs::write(&path, &text).unwrap();
            let said = Scene::open(&path).map_or_else(|error| error.to_string(), |scene| scene.warnings.join(" "));
            assert!(!said.contains("/root:/bin/bash") && !said.contains('\n'), "{file}: {said}");
        }
    }
}

#[test]
fn very_many_faulty_meshes_are_a_short_list_of_warnings() {
    let mesh = "[[mesh]]\nfile = \"part.obj\"\n";
    let (folder, path) = folder(&mesh.repeat(3000));
    fs::write(folder.path().join("part.obj"), "odd 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n").unwrap();
    let warnings = Scene::open(path).unwrap().warnings;
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(warnings.iter().all(|warning| warning.ends_with(" (3000 times)")), "{warnings:?}");
}
