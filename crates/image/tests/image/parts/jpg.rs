use lightmesh_image::internals::jpg::{is_cut_off, write};
use lightmesh_image::{Display, EncodeError, Frame};

#[test]
fn large_sides_are_refused() {
    let frame = Frame::new(65_536, 1, vec![[0.0; 3]; 65_536]).unwrap();
    assert!(matches!(write(&frame, &Display::default(), Vec::new()), Err(EncodeError::TooLarge { .. })));
}

#[test]
fn a_scan_without_an_end_is_noticed() {
    assert!(is_cut_off(b""));
    assert!(is_cut_off(b"\xff\xd8\xff\xd9 thumbnail, then \xff\xda scan"));
    assert!(!is_cut_off(b"\xff\xd8\xff\xda scan \xff\xd9 and more"));
}
