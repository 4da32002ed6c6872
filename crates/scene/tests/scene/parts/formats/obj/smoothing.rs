use lightmesh_scene::internals::formats::obj::{Smoothing, group};

#[test]
fn a_group_is_a_number_or_off() {
    assert_eq!([&b"off"[..], b"OFF", b"0", b"007", b"99999999999"].map(group), [0, 0, 0, 7, u32::MAX].map(Some));
    assert_eq!([&b""[..], b"on", b"-1", b"1.5"].map(group), [None; 4]);
}

#[test]
fn triangles_above_the_first_group_are_in_none() {
    let mut smoothing = Smoothing::default();
    smoothing.extend_to(2);
    assert!(smoothing.groups.is_empty());
    assert!(!smoothing.begin(b"on", 2) && smoothing.groups.is_empty());
    assert!(smoothing.begin(b"3", 2));
    smoothing.extend_to(4);
    assert!(smoothing.begin(b"off", 4));
    smoothing.extend_to(5);
    assert_eq!(smoothing.groups, [0, 0, 3, 3, 0]);
}
