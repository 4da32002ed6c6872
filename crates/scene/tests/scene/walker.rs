//! A skinned, morphed and walking tube: its vertices are where another program has them. `tests/data/walker.py` makes both files.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;
use lightmesh_scene::{Scene, glam};

/// Blender places keys of rotations a little differently between frames.
const CLOSE: f32 = 5e-4;

#[test]
fn skinned_and_morphed_vertices_are_where_blender_has_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let scene = Scene::open(folder.join("walker.glb")).unwrap();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let text = std::fs::read_to_string(folder.join("walker.json")).unwrap();
    let expected: BTreeMap<String, Vec<[f32; 3]>> = serde_json::from_str(&text).unwrap();
    assert_eq!((expected.len(), scene.animation().unwrap().duration()), (5, 2.0));
    for (time, places) in &expected {
        let moved = scene.at(time.parse().unwrap());
        let found = &moved.geometry.mesh.positions;
        for &place in places {
            let place = Vec3::from(place);
            let nearest = found.iter().map(|found| found.distance(place)).fold(f32::INFINITY, f32::min);
            assert!(nearest < CLOSE, "{time} s: {place} is {nearest} from the nearest vertex");
        }
        for place in found {
            let near = places.iter().any(|&other| place.distance(other.into()) < CLOSE);
            assert!(near, "{time} s: {place} is not expected");
        }
    }
}
