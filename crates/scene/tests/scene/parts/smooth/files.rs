//! Which files get normals, and that a scene is the same when it is written and read again.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use glam::{DMat4, Vec3};
use lightmesh_scene::internals::draft::Draft;
use lightmesh_scene::{CreaseAngle, LoadError, LoadOptions, Mesh, Scene};

use super::LoadedMesh;
use super::cylinder;
use super::icosphere;
use super::soup;

const SIDES: usize = 24;

fn open(path: &Path) -> Scene {
    let options = LoadOptions::default().with_smooth(CreaseAngle::default());
    Scene::open_with(path, &options).unwrap_or_else(|error| panic!("{error}"))
}

/// Opens a file of this name and content.
fn read(name: &str, content: impl AsRef<[u8]>) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    open(&path)
}

/// The lines `v` and `f` of an OBJ file; `before` is put in front of each triangle.
fn obj(mesh: &LoadedMesh<glam::DVec3>, before: impl Fn(usize) -> String) -> String {
    let mut text = String::new();
    for position in &mesh.positions {
        writeln!(text, "v {} {} {}", position.x, position.y, position.z).unwrap();
    }
    for (index, [a, b, c]) in mesh.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + 1)).enumerate() {
        writeln!(text, "{}f {a} {b} {c}", before(index)).unwrap();
    }
    text
}

fn ply(mesh: &LoadedMesh<glam::DVec3>) -> String {
    let [vertices, faces] = [mesh.positions.len(), mesh.triangles.len()];
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    mesh.positions.iter().for_each(|p| writeln!(text, "{} {} {}", p.x, p.y, p.z).unwrap());
    mesh.triangles.iter().for_each(|[a, b, c]| writeln!(text, "3 {a} {b} {c}").unwrap());
    text
}

fn stl(mesh: &LoadedMesh<glam::DVec3>) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0; 12]);
        let corners = triangle.map(|vertex| mesh.positions[vertex as usize].as_vec3());
        bytes.extend(corners.iter().flat_map(|corner| corner.to_array()).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

fn normals_of(mesh: &Mesh, triangle: usize) -> [Vec3; 3] {
    mesh.triangles[triangle].map(|vertex| mesh.normals.get(vertex as usize).copied().unwrap_or(Vec3::ZERO))
}

fn is_flat(mesh: &Mesh, triangle: usize) -> bool {
    normals_of(mesh, triangle).contains(&Vec3::ZERO)
}

#[test]
fn files_of_each_format_become_round() {
    let cylinder = cylinder(SIDES as u32);
    let files = [
        ("a.obj", obj(&cylinder, |_| String::new()).into_bytes()),
        ("a.ply", ply(&cylinder).into_bytes()),
        ("b.ply", ply(&soup(&cylinder)).into_bytes()),
        ("a.stl", stl(&cylinder)),
    ];
    for (name, content) in files {
        let scene = read(name, &content);
        let mesh = &scene.geometry.mesh;
        assert_eq!(mesh.normals.len(), mesh.positions.len(), "{name}");
        for triangle in 0..mesh.triangles.len() {
            assert_eq!(is_flat(mesh, triangle), triangle >= 2 * SIDES, "{name}: {triangle}");
        }
        let made = mesh.normals.iter().filter(|&&normal| normal != Vec3::ZERO).count();
        assert!(made > 0 && scene.smooth_normals == made, "{name}");
        let level = |normal: &Vec3| normal.z.abs() < 1e-6;
        assert!(mesh.normals.iter().all(level), "{name}");
    }
}

#[test]
fn without_being_asked_nothing_is_smooth() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.obj");
    fs::write(&path, obj(&cylinder(SIDES as u32), |_| "s 1\n".to_owned())).unwrap();
    let scene = Scene::open(&path).unwrap();
    assert!(scene.geometry.mesh.normals.is_empty() && scene.smooth_normals == 0);
    assert_eq!(scene.geometry.mesh.positions.len(), 2 * SIDES);
}

#[test]
fn files_with_any_normals_stay_as_they_are() {
    let mut text = obj(&cylinder(SIDES as u32), |_| String::new());
    text.push_str("vn 0 0 1\nf 1//1 2//1 3//1\n");
    let scene = read("a.obj", text);
    assert_eq!(scene.smooth_normals, 0);
    assert!((0..2 * SIDES).all(|triangle| is_flat(&scene.geometry.mesh, triangle)));
}

#[test]
fn smoothing_groups_of_a_file_are_honoured() {
    let cylinder = cylinder(SIDES as u32);
    let smooth_sides = |text: String| {
        let scene = read("a.obj", text);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        (0..2 * SIDES).filter(|&triangle| !is_flat(&scene.geometry.mesh, triangle)).count()
    };
    let all = |group: &str| smooth_sides(obj(&cylinder, |_| format!("s {group}\n")));
    assert_eq!([all("off"), all("0"), all("1"), all("7 # all")], [0, 0, 2 * SIDES, 2 * SIDES]);
    // Each quad is a group of its own.
    assert_eq!(smooth_sides(obj(&cylinder, |index| format!("s {}\n", 1 + index / 2))), 0);
    // What is above the first group is in none.
    let late = |index| if index == SIDES { "s 1\n".to_owned() } else { String::new() };
    assert_eq!(smooth_sides(obj(&cylinder, late)), SIDES);
}

#[test]
fn a_word_that_names_no_group_is_ignored_with_a_warning() {
    let text = obj(&cylinder(SIDES as u32), |index| if index == 0 { "s on\n".to_owned() } else { String::new() });
    let scene = read("a.obj", &text);
    assert!(
        scene.warnings[0].ends_with("a.obj:49: `on` is no smoothing group, and is ignored"),
        "{:?}",
        scene.warnings
    );
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.smooth_normals > 0);
}

#[test]
fn models_of_a_scene_are_smooth_wherever_they_are_placed() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.obj"), obj(&cylinder(SIDES as u32), |_| String::new())).unwrap();
    let placed = "[[mesh]]\nfile = \"a.obj\"\nscale = [-1, 2, 3]\n[[mesh]]\nfile = \"a.obj\"\ntranslate = [5, 0, 0]\n";
    fs::write(at("a.toml"), placed).unwrap();
    let scene = open(&at("a.toml"));
    let mesh = &scene.geometry.mesh;
    assert_eq!(scene.smooth_normals, 2 * 2 * SIDES);
    for triangle in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(triangle);
        let outward = (b - a).cross(c - a).normalize();
        for normal in normals_of(mesh, triangle) {
            assert!(normal == Vec3::ZERO || normal.dot(outward) > 0.9, "{triangle}: {normal} {outward}");
        }
    }
}

#[test]
fn what_is_exported_is_the_same_when_it_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("a.obj"), obj(&cylinder(SIDES as u32), |_| String::new())).unwrap();
    fs::write(at("a.toml"), "[[mesh]]\nfile = \"a.obj\"\nrotate = [10, 20, 30]\n").unwrap();
    let scene = open(&at("a.toml"));
    let written = &scene;
    let count = written.geometry.mesh.triangles.len();
    let corners = |scene: &Scene| (0..count).map(|triangle| scene.geometry.mesh.corners(triangle)).collect::<Vec<_>>();
    for name in ["b.glb", "b.toml"] {
        written.export(at(name)).unwrap();
        // Once more, normals are not made twice.
        for read in [Scene::open(at(name)).unwrap(), open(&at(name))] {
            assert_eq!(corners(&read), corners(written), "{name}");
            assert_eq!(read.smooth_normals, 0, "{name}");
            for triangle in 0..count {
                let [read, written] = [&read, written].map(|scene| normals_of(&scene.geometry.mesh, triangle));
                if triangle < 2 * SIDES {
                    assert_eq!(read, written, "{name}: {triangle}");
                } else {
                    // The format has no flat triangles among others: they have the normals of their planes.
                    let [a, b, c] = corners(&scene)[triangle];
                    let plane = (b - a).cross(c - a).normalize();
                    assert!(read.iter().all(|normal| normal.distance(plane) < 1e-6), "{name}: {triangle}");
                }
            }
        }
    }
}

#[test]
fn what_does_not_fit_into_memory_is_refused_with_the_file_and_the_remedy() {
    let options = LoadOptions::default().with_smooth(CreaseAngle::default()).with_memory_limit(1 << 20);
    let mut draft = Draft::new(Path::new("a.ply"), &options);
    let error = draft.take(icosphere(6), &DMat4::IDENTITY).unwrap_err();
    assert!(matches!(error, LoadError::SmoothMemory { triangles: 81_920, .. }), "{error}");
    let message = error.to_string();
    assert!(message.starts_with("there is not enough memory for smooth normals of 81920 triangles: "), "{message}");
    assert!(message.ends_with("a.ply; raise the memory limit, or do not smooth"), "{message}");
}
