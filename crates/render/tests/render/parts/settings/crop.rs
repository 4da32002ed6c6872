use lightmesh_render::{Crop, UnknownCrop};

#[test]
fn crops_are_read_and_written() {
    assert_eq!("10,20, 30,40".parse(), Ok(Crop::new([10, 20], [30, 40])));
    assert_eq!("-16,-9,672,512".parse(), Ok(Crop::new([-16, -9], [672, 512])));
    assert_eq!(Crop::new([1, -2], [3, 4]).to_string(), "1,-2,3,4");
    for text in ["", "1,2,3", "1,2,3,0", "1,2,0,4", "1,2,-3,4", "1,2,3,4,5", "1.5,2,3,4", "99999999999,0,1,1"] {
        assert_eq!(text.parse::<Crop>(), Err(UnknownCrop), "{text}");
    }
}

#[test]
fn only_pixels_of_the_image_are_within() {
    assert!(Crop::new([0, 0], [640, 480]).is_within([640, 480]));
    assert!(Crop::new([639, 479], [1, 1]).is_within([640, 480]));
    for (first, size) in
        [([640, 0], [1, 1]), ([0, 1], [640, 480]), ([i32::MAX, 0], [2, 1]), ([0, 0], [0, 1]), ([-1, 0], [2, 2])]
    {
        assert!(!Crop::new(first, size).is_within([640, 480]), "{first:?} {size:?}");
    }
}

#[test]
fn pixels_next_to_the_image_are_near() {
    for (first, size) in [([-16, -16], [672, 512]), ([-65_536, 0], [1, 1]), ([66_175, 66_015], [1, 1])] {
        assert!(Crop::new(first, size).is_near([640, 480]), "{first:?} {size:?}");
    }
    for (first, size) in [
        ([-65_537, 0], [1, 1]),
        ([66_176, 0], [1, 1]),
        ([0, 0], [640, 66_017]),
        ([0, 0], [0, 1]),
        ([i32::MIN, i32::MIN], [1, 1]),
        ([i32::MAX, 0], [u32::MAX, 1]),
    ] {
        assert!(!Crop::new(first, size).is_near([640, 480]), "{first:?} {size:?}");
    }
}
