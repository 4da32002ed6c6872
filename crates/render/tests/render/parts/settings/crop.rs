use lightmesh_render::{Crop, UnknownCrop};

#[test]
fn crops_are_read_and_written() {
    assert_eq!("10,20, 30,40".parse(), Ok(Crop::new([10, 20], [30, 40])));
    assert_eq!(Crop::new([1, 2], [3, 4]).to_string(), "1,2,3,4");
    for text in ["", "1,2,3", "1,2,3,0", "1,2,0,4", "-1,2,3,4", "1,2,3,4,5", "1.5,2,3,4", "99999999999,0,1,1"] {
        assert_eq!(text.parse::<Crop>(), Err(UnknownCrop), "{text}");
    }
}

#[test]
fn only_pixels_of_the_image_are_within() {
    assert!(Crop::new([0, 0], [640, 480]).is_within([640, 480]));
    assert!(Crop::new([639, 479], [1, 1]).is_within([640, 480]));
    for (first, size) in [([640, 0], [1, 1]), ([0, 1], [640, 480]), ([u32::MAX, 0], [2, 1]), ([0, 0], [0, 1])] {
        assert!(!Crop::new(first, size).is_within([640, 480]), "{first:?} {size:?}");
    }
}
