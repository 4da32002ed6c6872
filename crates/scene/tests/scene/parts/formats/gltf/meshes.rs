use std::borrow::Cow;

use lightmesh_scene::internals::formats::gltf::{Mode, triangles, vertices_used};

#[test]
fn strips_and_fans_face_one_way() {
    assert_eq!(*triangles(Mode::Triangles, &[0, 1, 2, 3, 4, 5, 6]), [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(*triangles(Mode::Strip, &[0, 1, 2, 3, 4]), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(*triangles(Mode::Fan, &[0, 1, 2, 3]), [[1, 2, 0], [2, 3, 0]]);
    assert!(triangles(Mode::Fan, &[]).is_empty());
}

#[test]
fn vertices_that_are_not_used_are_left_out() {
    let mut indices = Cow::from(vec![7, 3, 9, 3]);
    assert_eq!(vertices_used(&mut indices, 10), Some(vec![3, 7, 9]));
    assert_eq!(*indices, [1, 0, 2, 0]);
    assert_eq!(vertices_used(&mut indices, 4), None);
    assert_eq!(*indices, [1, 0, 2, 0]);
}

#[test]
fn triangles_are_as_many_as_counted() {
    let indices: Vec<u32> = (0..9).collect();
    for mode in [Mode::Triangles, Mode::Strip, Mode::Fan, Mode::PointsOrLines] {
        for count in 0..indices.len() {
            assert_eq!(triangles(mode, &indices[..count]).len(), mode.count(count), "{mode:?} {count}");
        }
    }
}
