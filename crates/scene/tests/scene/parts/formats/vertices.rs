use lightmesh_scene::internals::formats::vertices::{Corner, NONE, Vertices};

#[test]
fn equal_corners_share_a_vertex_however_many_there_are() {
    let corners: Vec<Corner> = (0..100).map(|index| [index % 2, index / 2, NONE]).collect();
    let mut vertices = Vertices::default();
    for _ in 0..2 {
        assert!((0..100).all(|index| vertices.of(corners[index]) == index as u32));
    }
    assert_eq!(vertices.into_corners(), corners);
}
