//! Tests of the image comparison: equal images pass, and every kind of difference is detected with its value.

use crate::pictures::{coded, layered, plain, ramp};
use lightmesh_image::{CompareError, Comparison, Frame, Transfer, compare, compare_linear};

fn close(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= 1e-6
}

#[test]
fn equal_pictures_differ_by_nothing() {
    for frame in [coded(33, 17), ramp(64, 64), plain(1, 1, [0.3; 3]), layered(8, 8)] {
        let comparison = compare(&frame, &frame.clone()).unwrap();
        assert_eq!((comparison.rmse, comparison.max_difference, comparison.mean_flip), (0.0, 0.0, 0.0));
        assert_eq!(comparison.psnr, f64::INFINITY);
        let difference = &comparison.difference;
        assert_eq!((difference.width(), difference.height()), (frame.width(), frame.height()));
        assert!(difference.layers().is_none());
        assert!(difference.color().iter().all(|color| color == &difference.color()[0]), "equal pixels have one colour");
    }
}

#[test]
fn black_and_white_are_as_far_apart_as_can_be() {
    let comparison = compare(&plain(32, 32, [0.0; 3]), &plain(32, 32, [1.0; 3])).unwrap();
    assert_eq!((comparison.rmse, comparison.psnr, comparison.max_difference), (1.0, 0.0, 1.0));
    assert!(comparison.mean_flip > 0.95, "{}", comparison.mean_flip);
}

#[test]
fn one_changed_pixel_has_its_known_weight() {
    let frame = plain(10, 10, [0.0; 3]);
    let mut changed = frame.clone();
    changed.color_mut()[37] = [0.0, Transfer::Srgb.decode(51), 0.0]; // display value 0.2
    let comparison = compare(&frame, &changed).unwrap();
    let rmse = 0.2 / 300.0_f64.sqrt();
    assert!(close(comparison.rmse, rmse), "{}", comparison.rmse);
    assert!(close(comparison.psnr, -20.0 * rmse.log10()), "{}", comparison.psnr);
    assert!(close(comparison.max_difference, 0.2), "{}", comparison.max_difference);
    assert!(comparison.mean_flip > 0.0);
    let map = comparison.difference.color();
    assert_ne!(map[37], map[99], "the map shows the location");
}

#[test]
fn the_largest_difference_counts_wherever_it_is() {
    let frame = plain(8, 8, [0.0; 3]);
    let mut changed = frame.clone();
    // Display values 0.4 and 0.2.
    changed.color_mut()[5] = [Transfer::Srgb.decode(102); 3];
    changed.color_mut()[60] = [Transfer::Srgb.decode(51); 3];
    let comparison = compare(&frame, &changed).unwrap();
    assert!(close(comparison.max_difference, 0.4), "{}", comparison.max_difference);
}

#[test]
fn a_grey_step_has_its_known_values() {
    let grey = |code| plain(16, 16, [Transfer::Srgb.decode(code); 3]);
    let comparison = compare(&grey(102), &grey(153)).unwrap();
    assert!(close(comparison.rmse, 0.2) && close(comparison.max_difference, 0.2), "{comparison:?}");
    assert!(close(comparison.psnr, 13.979_400), "{}", comparison.psnr);
}

#[test]
fn a_shifted_picture_is_seen() {
    let (width, height) = (64, 64);
    let stripes = |shift: u32| {
        let color = (0..width * height).map(|pixel| [(((pixel % width) + shift) / 8 % 2) as f32; 3]).collect();
        Frame::new(width, height, color).unwrap()
    };
    let comparison = compare(&stripes(0), &stripes(1)).unwrap();
    // One column in eight swaps black for white.
    assert!(close(comparison.rmse, (1.0_f64 / 8.0).sqrt()), "{}", comparison.rmse);
    assert_eq!(comparison.max_difference, 1.0);
    assert!(comparison.mean_flip > 0.1, "{}", comparison.mean_flip);

    let half = compare(&stripes(0), &stripes(8)).unwrap();
    assert_eq!(half.rmse, 1.0);
    assert!(half.mean_flip > comparison.mean_flip, "a larger shift is worse");
}

#[test]
fn what_is_brighter_than_the_screen_does_not_count() {
    let comparison = compare(&plain(8, 8, [1.0; 3]), &plain(8, 8, [f32::INFINITY; 3])).unwrap();
    assert_eq!((comparison.rmse, comparison.mean_flip), (0.0, 0.0));
}

#[test]
fn sizes_must_agree() {
    let error = compare(&ramp(4, 3), &ramp(3, 4)).unwrap_err();
    assert_eq!(error, CompareError::Size { first: (4, 3), second: (3, 4) });
    assert!(error.to_string().contains("4x3 pixels with one of 3x4"), "{error}");
}

#[test]
fn nan_is_an_error_and_not_a_match() {
    let mut broken = plain(4, 3, [0.5; 3]);
    broken.color_mut()[6][1] = f32::NAN;
    let error = compare(&broken, &broken).unwrap_err();
    assert_eq!(error, CompareError::NotANumber { which: "first", x: 2, y: 1 });
    let error = compare(&plain(4, 3, [0.5; 3]), &broken).unwrap_err();
    assert_eq!(error, CompareError::NotANumber { which: "second", x: 2, y: 1 });
}

#[test]
fn json_has_the_four_measures() {
    let json = |a: &Frame, b: &Frame| serde_json::to_value(compare(a, b).unwrap()).unwrap();
    let equal = json(&ramp(8, 8), &ramp(8, 8));
    assert_eq!(equal, serde_json::json!({"rmse": 0.0, "psnr": null, "max_difference": 0.0, "mean_flip": 0.0}));
    let opposite = json(&plain(8, 8, [0.0; 3]), &plain(8, 8, [1.0; 3]));
    assert_eq!(opposite["psnr"], 0.0);
    assert!(opposite["mean_flip"].as_f64().is_some_and(|flip| flip > 0.9));
}

#[test]
fn light_above_1_differs_although_a_screen_shows_it_white() {
    let (two, four) = (plain(16, 16, [2.0; 3]), plain(16, 16, [4.0; 3]));
    let display = compare(&two, &four).unwrap();
    assert_eq!((display.rmse, display.mean_flip, display.linear), (0.0, 0.0, None));
    let comparison = compare_linear(&two, &four).unwrap();
    assert_eq!((comparison.rmse, comparison.mean_flip), (0.0, 0.0), "what is displayed is compared as before");
    let linear = comparison.linear.unwrap();
    assert_eq!((linear.relative_rmse, linear.max_linear_difference), (1.0, 2.0));
    assert!(linear.mean_hdr_flip > 0.1, "{linear:?}");
    assert_eq!(linear.hdr_exposures.2, 2);
    assert!(comparison.difference.color() != display.difference.color(), "the map is that of HDR-FLIP");
}

#[test]
fn linear_measures_are_those_of_the_reference() {
    let ramp = ramp(64, 64);
    let equal = compare_linear(&ramp, &ramp.clone()).unwrap().linear.unwrap();
    assert_eq!((equal.relative_rmse, equal.max_linear_difference, equal.mean_hdr_flip), (0.0, 0.0, 0.0));
    // A scale changes neither measure.
    let scaled = |frame: &Frame, factor: f32| {
        Frame::new(64, 64, frame.color().iter().map(|color| color.map(|value| factor * value)).collect()).unwrap()
    };
    let brighter = scaled(&ramp, 1.5);
    let dim = compare_linear(&scaled(&ramp, 1.0 / 1024.0), &scaled(&brighter, 1.0 / 1024.0)).unwrap().linear.unwrap();
    let bright = compare_linear(&ramp, &brighter).unwrap().linear.unwrap();
    assert!(close(bright.relative_rmse, 0.5) && close(dim.relative_rmse, 0.5), "{bright:?} {dim:?}");
    assert!((bright.mean_hdr_flip - dim.mean_hdr_flip).abs() < 1e-4, "{bright:?} {dim:?}");

    let [black, light] = [plain(4, 4, [0.0; 3]), plain(4, 4, [1.0; 3])];
    let linear = compare_linear(&black, &light).unwrap().linear.unwrap();
    assert_eq!(linear.relative_rmse, f64::INFINITY);
    let infinite = plain(4, 4, [f32::INFINITY; 3]);
    assert_eq!(compare_linear(&infinite, &infinite.clone()).unwrap().linear.unwrap().relative_rmse, 0.0);
    assert_eq!(compare_linear(&infinite, &light).unwrap().linear.unwrap().relative_rmse, f64::INFINITY);
}

#[test]
fn json_has_linear_measures_beside_the_others() {
    let (two, four) = (plain(8, 8, [2.0; 3]), plain(8, 8, [4.0; 3]));
    let keys = |comparison: &Comparison| -> Vec<String> {
        let json = serde_json::to_value(comparison).unwrap();
        json.as_object().unwrap().keys().cloned().collect()
    };
    let mut old = keys(&compare(&two, &four).unwrap());
    old.sort();
    assert_eq!(old, ["max_difference", "mean_flip", "psnr", "rmse"]);
    let new = keys(&compare_linear(&two, &four).unwrap());
    for key in ["relative_rmse", "max_linear_difference", "mean_hdr_flip", "hdr_exposures"] {
        assert!(new.iter().any(|other| other == key), "{new:?}");
    }
}
