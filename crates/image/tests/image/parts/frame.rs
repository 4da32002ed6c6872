use lightmesh_image::{Frame, FrameError, Layers, Matte};

fn layers(pixels: usize) -> Layers {
    Layers {
        depth: vec![1.0; pixels],
        normal: vec![[0.0, 1.0, 0.0]; pixels],
        position: vec![[0.0; 3]; pixels],
        visibility: vec![vec![1.0; pixels]; 2],
        used: vec![7; pixels],
        lights: vec![vec![[0.25; 3]; pixels]; 2],
        rest: vec![[0.5; 3]; pixels],
        object: Matte::nothing(vec!["box".to_owned()], 2, pixels),
        material: Matte::default(),
    }
}

#[test]
fn rows_run_from_the_top() {
    let frame = Frame::new(2, 2, vec![[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]]).unwrap();
    assert_eq!(frame.pixel(1, 0), Some([1.0; 3]));
    assert_eq!(frame.pixel(0, 1), Some([2.0; 3]));
    assert_eq!((frame.pixel(2, 0), frame.pixel(0, 2)), (None, None));
    assert_eq!(frame.rows().last(), Some(&[[2.0; 3], [3.0; 3]][..]));
}

#[test]
fn what_is_not_covered_shows_the_background() {
    let frame = Frame::new(3, 1, vec![[0.0; 3], [0.1, 0.2, 0.3], [0.4; 3]]).unwrap();
    assert_eq!(frame.clone().over([9.0; 3]), frame);
    let over = frame.with_alpha(vec![0.0, 0.5, 1.0]).unwrap().over([0.8, 0.4, f32::INFINITY]);
    assert_eq!((over.pixel(0, 0), over.pixel(2, 0)), (Some([0.8, 0.4, f32::INFINITY]), Some([0.4; 3])));
    assert_eq!(over.pixel(1, 0).map(|[red, green, _]| [red, green]), Some([0.5, 0.4]));
    assert_eq!(over.alpha(), None);
}

#[test]
fn a_crop_has_the_pixels_of_the_image() {
    let color: Vec<[f32; 3]> = (0..30).map(|pixel| [pixel as f32; 3]).collect();
    let mut planes = layers(30);
    (planes.depth, planes.used) = ((0..30).map(|pixel| pixel as f32).collect(), (0..30).collect());
    let frame = Frame::new(6, 5, color).unwrap().with_layers(planes).unwrap().with_alpha(vec![0.5; 30]).unwrap();
    let crop = frame.cropped([2, 1], [3, 2]).unwrap();
    assert_eq!(crop.layers().unwrap().used, [8, 9, 10, 14, 15, 16]);
    assert_eq!(crop.layers().unwrap().visibility[1].len(), 6);
    assert_eq!((crop.pixel(0, 0), crop.pixel(2, 1)), (Some([8.0; 3]), Some([16.0; 3])));
    assert_eq!((crop.window().first, crop.window().whole), ([2, 1], [6, 5]));
    // What is around the image has places, too.
    let around = frame.clone().with_window([-2, -1], [2, 4]);
    let left = around.cropped([-1, 0], [3, 2]).unwrap();
    assert_eq!((left.layers().unwrap().used.clone(), left.window().first), (vec![7, 8, 9, 13, 14, 15], [-1, 0]));
    assert_eq!((around.cropped([-3, 0], [2, 2]), around.cropped([3, 0], [2, 1])), (None, None));
    // Cropping twice is cropping once.
    assert_eq!(crop.cropped([3, 2], [2, 1]), frame.cropped([3, 2], [2, 1]));
    for (first, size) in
        [([1, 1], [2, 2]), ([2, 1], [4, 2]), ([2, 1], [0, 1]), ([i32::MAX, 1], [2, 1]), ([-1, 1], [2, 1])]
    {
        assert_eq!(crop.cropped(first, size), None, "{first:?} {size:?}");
    }
}

#[test]
fn parts_are_those_that_were_given() {
    let color = vec![[0.5; 3]; 6];
    let (colors, planes) = (color.as_ptr(), layers(6));
    let depth = planes.depth.as_ptr();
    let frame = Frame::new(3, 2, color).unwrap().with_alpha(vec![0.5; 6]).unwrap();
    let parts = frame.with_layers(planes).unwrap().into_parts();
    assert_eq!((parts.size, parts.color.as_ptr()), ([3, 2], colors));
    assert_eq!(parts.alpha.unwrap(), [0.5; 6]);
    assert_eq!(parts.layers.unwrap().depth.as_ptr(), depth);
}

#[test]
fn a_frame_without_pixels_is_refused() {
    assert_eq!(Frame::new(0, 3, vec![]), Err(FrameError::Size { width: 0, height: 3 }));
    assert_eq!(Frame::new(3, 0, vec![]), Err(FrameError::Size { width: 3, height: 0 }));
    assert!(matches!(Frame::new(u32::MAX, u32::MAX, vec![]), Err(FrameError::Size { .. })));
}

#[test]
fn lengths_are_checked() {
    let error = Frame::new(3, 2, vec![[0.0; 3]; 5]).unwrap_err();
    assert_eq!(error.to_string(), "plane 'color' has 5 entries, but a frame of 3x2 pixels needs 6");

    let frame = || Frame::new(3, 2, vec![[0.0; 3]; 6]).unwrap();
    assert_eq!(frame().with_layers(layers(6)).unwrap().layers(), Some(&layers(6)));
    let mut short = layers(6);
    short.visibility[1].pop();
    let error = frame().with_layers(short).unwrap_err();
    assert!(error.to_string().contains("visibility[1]"), "{error}");
    assert!(frame().with_layers(layers(7)).is_err());
    assert!(frame().with_alpha(vec![1.0; 5]).unwrap_err().to_string().contains("plane 'alpha' has 5"));
}

#[test]
fn parts_of_an_image_become_the_image() {
    let color: Vec<[f32; 3]> = (0..30).map(|pixel| [pixel as f32; 3]).collect();
    let mut planes = layers(30);
    planes.depth = (0..30).map(|pixel| pixel as f32).collect();
    planes.object.ranks[1].share = planes.depth.clone();
    let frame = Frame::new(3, 10, color).unwrap().with_layers(planes).unwrap().with_alpha(vec![0.5; 30]).unwrap();
    let frame = frame.with_window([7, -2], [20, 10]);
    let rows = |first: i32, count: u32| frame.cropped([7, first], [3, count]).unwrap();
    let mut all = Frame::around(&rows(2, 1), [7, -2], [3, 10]).unwrap();
    assert_eq!((all.window(), all.pixel(2, 9)), (frame.window(), Some([0.0; 3])));
    // In any order, without what a part has around.
    for (part, first, count) in [(rows(2, 6), 3, 5), (rows(-2, 5), -2, 4), (rows(1, 2), 2, 1)] {
        assert_ne!(all, frame);
        assert!(all.put(&part, [7, first], [3, count]));
    }
    assert_eq!(all, frame);
    // Columns, too.
    let mut all = Frame::around(&frame, [7, -2], [3, 10]).unwrap();
    assert!((7..10).all(|column| all.put(&frame.cropped([column, -2], [1, 10]).unwrap(), [column, -2], [1, 10])));
    assert_eq!(all, frame);
    // Pixels that the part does not have, or the frame; none; another image; other planes; other names.
    let renamed = |part: Frame| {
        let mut planes = part.layers().unwrap().clone();
        planes.object.names = vec!["ball".to_owned()];
        part.with_layers(planes).unwrap()
    };
    let bare = Frame::new(3, 1, vec![[0.0; 3]; 3]).unwrap().with_window([7, 2], [20, 10]);
    let wrong = [
        (rows(2, 1), [7, 2], [3, 2]),
        (frame.clone().with_window([7, 3], [20, 10]), [7, 7], [3, 2]),
        (rows(2, 1), [6, 2], [3, 1]),
        (rows(2, 1), [7, 2], [3, 0]),
        (rows(2, 1).with_window([7, 2], [21, 10]), [7, 2], [3, 1]),
        (bare.clone(), [7, 2], [3, 1]),
        (bare.with_alpha(vec![0.5; 3]).unwrap(), [7, 2], [3, 1]),
        (renamed(rows(2, 1)), [7, 2], [3, 1]),
    ];
    for (part, first, size) in wrong {
        assert!(!all.put(&part, first, size), "{first:?} {size:?}");
    }
    assert_eq!(all, frame);
    assert_eq!(Frame::around(&frame, [0, 0], [0, 3]), None);
}
