//! Shapes that are stored once for many places: the same image as with a copy for each, bit by bit.

use std::f32::consts::TAU;
use std::fmt::Write as _;
use std::fs;

use lightmesh_render::{Acceleration, Lookup, MeshCache, Mode, Quality, Settings, Unobserved};
use lightmesh_scene::{Geometry, Instancing, LoadOptions, Scene};
use lightmesh_testkit::{MODES, Picture};

use crate::{light_mesh, mode, renderer};

const SIZE: [u32; 2] = [64, 48];

/// A shape with normals, a crossed pair of quads with holes, and a pane, several times each.
const TABLES: &str = r#"
[[material]]
name = "floor"
kd = [0.7, 0.7, 0.7]

[[material]]
name = "red"
kd = [0.8, 0.2, 0.1]
ks = [0.2, 0.2, 0.2]

[[camera]]
position = [0.0, 2.5, 7.0]
target = [0.0, 0.7, 0.0]
vfov = 40.0

[[light]]
kind = "sphere"
position = [-2.0, 4.0, 2.0]
radius = 0.6

[[light]]
kind = "point"
position = [2.0, 4.0, 1.0]

[[box]]
min = [-4.0, -0.2, -4.0]
max = [4.0, 0.0, 4.0]
material = "floor"
"#;

/// A lumpy ball with normals.
fn ball() -> String {
    let (columns, rows) = (12, 6);
    let mut text = String::from("o ball\n");
    for row in 0..=rows {
        for column in 0..columns {
            let (a, b) = (TAU * column as f32 / columns as f32, 0.5 * TAU * row as f32 / rows as f32);
            let normal = [b.sin() * a.cos(), b.cos(), b.sin() * a.sin()];
            let size = 0.5 + 0.1 * (3.0 * a).sin() * b.sin();
            let [x, y, z] = normal.map(|axis| size * axis);
            writeln!(text, "v {x} {y} {z}\nvn {} {} {}", normal[0], normal[1], normal[2]).unwrap();
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let at = |row: i32, column: i32| 1 + row * columns + column % columns;
            let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            let [a, b, c, d] = corners.map(|corner| format!("{corner}//{corner}"));
            writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
        }
    }
    text
}

fn scene() -> Scene {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ball.obj"), ball()).unwrap();
    let places = [
        ("[-1.5, 0.6, 0.0]", "[0, 30, 0]", "1.0"),
        ("[0.0, 0.6, 0.0]", "[20, 50, 10]", "[1.0, 1.5, 0.7]"),
        ("[1.5, 0.6, 0.5]", "[0, 0, 45]", "0.8"),
        ("[0.7, 0.6, 1.5]", "[0, 70, 0]", "[-1.0, 1.0, 1.0]"),
        ("[-0.8, 0.5, 1.8]", "[80, 0, 0]", "[0.6, -1.0, 1.0]"),
        ("[0.2, 1.8, -0.5]", "[10, 20, 30]", "[1.3, 0.4, 1.3]"),
    ];
    let mut tables = TABLES.to_owned();
    for (translate, rotate, scale) in places {
        let place = format!("translate = {translate}\nrotate = {rotate}\nscale = {scale}");
        writeln!(tables, "\n[[mesh]]\nfile = \"ball.obj\"\nmaterial = \"red\"\n{place}").unwrap();
    }
    let path = folder.path().join("balls.toml");
    fs::write(&path, tables).unwrap();
    let shared = Scene::open_with(&path, &LoadOptions::default().with_instancing(Instancing::Always)).unwrap();
    let copied = Scene::open(&path).unwrap();
    assert!(copied.geometry.mesh.instances.is_empty());
    // The first of each orientation is copied.
    assert_eq!(shared.geometry.mesh.instances.list().len(), 4);
    assert_eq!(shared.geometry.mesh.triangle_count(), copied.geometry.mesh.triangles.len());
    let apart = (shared.geometry.mesh.bounds().min - copied.geometry.mesh.bounds().min).abs().max_element();
    assert!(apart < 1e-6, "{apart}");
    shared
}

/// The same scene with copies.
fn flat(scene: &Scene) -> Scene {
    let mesh = scene.geometry.mesh.flattened().unwrap();
    scene.clone().with_geometry(Geometry { mesh, ..(*scene.geometry).clone() })
}

/// All modes and lookups, and gathered light.
fn ways() -> Vec<Settings> {
    let lookup = |lookup| mode(Mode::LightMesh, SIZE).with_lookup(lookup).with_samples(16);
    let modes = MODES.into_iter().map(|which| match which {
        Mode::LightMesh => light_mesh(SIZE, 0.2, 2.1),
        other => mode(other, SIZE),
    });
    let gathered = lookup(Lookup::Lists).with_quality(Quality::Draft).with_bounces(2);
    let all = modes.chain([lookup(Lookup::Lists), lookup(Lookup::Adaptive), gathered]);
    all.map(|settings| settings.with_layers(true)).collect()
}

#[test]
fn places_of_a_shape_look_like_its_copies() {
    let shared = scene();
    let flat = flat(&shared);
    for settings in ways() {
        let [one, other] = [&shared, &flat].map(|scene| renderer().render(scene, &settings).unwrap());
        assert!(Picture::new(&one).bits() == Picture::new(&other).bits(), "{settings:?}");
        assert_eq!(one.stats.scene.triangles, other.stats.scene.triangles);
    }
}

#[test]
fn structures_without_instances_hold_copies() {
    let shared = scene();
    let settings = mode(Mode::Area, SIZE).with_samples(4).with_layers(true);
    let expected = renderer().render(&shared, &settings).unwrap();
    for acceleration in [Acceleration::Grid(None), Acceleration::BruteForce] {
        let found = renderer().render(&shared, &settings.clone().with_acceleration(acceleration.clone())).unwrap();
        assert!(Picture::new(&found).bits() == Picture::new(&expected).bits(), "{acceleration}");
    }
}

/// A shape that moves among others that do not: kept light points give the same images as none, and those of copies.
#[test]
fn light_points_are_kept_beside_instances_that_move() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ball.obj"), ball()).unwrap();
    let mut tables = TABLES.to_owned();
    for x in [-1.5, 0.0, 1.5] {
        writeln!(tables, "\n[[mesh]]\nfile = \"ball.obj\"\nmaterial = \"red\"\ntranslate = [{x}, 0.6, 0.0]").unwrap();
    }
    let key = "{ time = 0, translate = [0, 0, 0] }, { time = 2, translate = [0, 0.2, 0.3], rotate = [0, 40, 0] }";
    writeln!(tables, "motion = {{ key = [{key}] }}").unwrap();
    let path = folder.path().join("balls.toml");
    fs::write(&path, tables).unwrap();
    let scene = Scene::open_with(&path, &LoadOptions::default().with_instancing(Instancing::Always)).unwrap();
    assert_eq!(scene.geometry.mesh.instances.list().len(), 2);
    let settings = light_mesh(SIZE, 0.2, 2.1).with_layers(true);
    let (renderer, mut cache) = (renderer(), MeshCache::new());
    let mut prepared = renderer.prepare(&scene.at(0.0), &settings, &Unobserved).unwrap();
    let mut saved = Vec::new();
    for time in [0.0, 0.5, 1.0] {
        let moment = scene.at(time);
        prepared = renderer.prepare_moved(&prepared, &moment, &settings, &Unobserved).unwrap();
        let kept = renderer.render_with(&mut cache, &prepared, &settings, &Unobserved).unwrap();
        let fresh = self::renderer().render(&moment, &settings).unwrap();
        assert!(Picture::new(&kept).bits() == Picture::new(&fresh).bits(), "at {time}");
        let copied = self::renderer().render(&flat(&moment), &settings).unwrap();
        assert!(Picture::new(&kept).bits() == Picture::new(&copied).bits(), "at {time}");
        saved.push(kept.stats.counts.long_tests_saved);
    }
    assert!(saved[0] == 0 && saved[1] > 0 && saved[2] > 0, "{saved:?}");
}
