//! Tables that show the same file.

use lightmesh_scene::{Instancing, LoadOptions};

use super::*;

const PLACES: &str = r#"
    [[mesh]]
    file = "one.obj"
    [[mesh]]
    file = "one.obj"
    translate = [3, 0, 0]
    rotate = [0, 30, 0]
    name = "second"
    [[mesh]]
    file = "one.obj"
    translate = [0, 3, 0]
    scale = [-1, 1, 2]
    [[mesh]]
    file = "one.obj"
    translate = [0, 0, 3]
    scale = [-1, 2, 2]
    [[mesh]]
    file = "one.obj"
    translate = [5, 0, 0]
    motion = { key = [{ time = 0, rotate = [0, 0, 0] }, { time = 2, rotate = [0, 90, 0], translate = [0, 1, 0] }] }
    [[mesh]]
    file = "one.obj"
    translate = [7, 0, 0]
    motion = { key = [{ time = 0, scale = 1 }, { time = 2, scale = 2 }] }
"#;

/// All corners, to four digits, with the names of objects.
fn corners(scene: &Scene) -> Vec<String> {
    let mesh = scene.geometry.mesh.flattened().unwrap();
    let name = |index: usize| mesh.objects.name(mesh.object_of(index as u32)).to_owned();
    let rounded = |index: usize| mesh.corners(index).map(|corner| (corner * 1e4).round() + 0.0);
    let mut all: Vec<String> =
        (0..mesh.triangles.len()).map(|index| format!("{:?} {}", rounded(index), name(index))).collect();
    all.sort();
    all
}

#[test]
fn tables_share_what_they_show() {
    let (_folder, path) = folder(PLACES);
    let read = |instancing| Scene::open_with(&path, &LoadOptions::default().with_instancing(instancing)).unwrap();
    let [shared, copied] = [Instancing::Always, Instancing::Never].map(read);
    // The first that mirrors and the first that does not are copied, and what is enlarged over time.
    assert_eq!(shared.geometry.mesh.instances.list().len(), 3);
    assert_eq!(shared.geometry.mesh.triangle_count(), copied.geometry.mesh.triangles.len());
    assert_eq!(corners(&shared), corners(&copied));
    for time in [0.0, 0.5, 2.0] {
        assert_eq!(corners(&shared.at(time)), corners(&copied.at(time)), "at {time}");
    }
    assert_ne!(corners(&shared.at(0.0)), corners(&shared.at(2.0)));
}
