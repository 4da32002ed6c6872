use std::sync::Arc;

use glam::{DMat4, DVec3};
use lightmesh_scene::internals::animation::{Interpolation, Kind, Node, Place, Rig, Track};

#[test]
fn children_go_with_their_parents() {
    let mut rig = Rig::default();
    let east = Track::new(Kind::Numbers(3), vec![0.0, 2.0], vec![1., 0., 0., 3., 0., 0.], Interpolation::Linear);
    let parent = Node { translation: Some(Arc::new(east.unwrap())), ..Node::fixed(None, Place::at(DVec3::ZERO)) };
    let parent = rig.add(parent);
    let child = rig.add(Node::fixed(Some(parent), Place::Matrix(DMat4::from_translation(DVec3::Y))));
    let other = rig.add(Node::fixed(None, Place::at(DVec3::ZERO)));
    assert_eq!(rig.moving(), [true, true, false]);
    assert_eq!(rig.scaling(), [false; 3]);
    let at = |time| rig.places(time)[child as usize].transform_point3(DVec3::ZERO);
    assert_eq!([at(None), at(Some(0.0)), at(Some(1.0))].map(|place| place.x), [0.0, 1.0, 2.0]);
    assert_eq!((at(Some(1.0)).y, rig.places(Some(1.0))[other as usize]), (1.0, DMat4::IDENTITY));
}
