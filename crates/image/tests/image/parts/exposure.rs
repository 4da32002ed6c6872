use lightmesh_image::Frame;

fn frame(values: &[f32]) -> Frame {
    Frame::new(values.len() as u32, 1, values.iter().map(|&value| [value; 3]).collect()).unwrap()
}

#[test]
fn a_stop_doubles() {
    let mut picture = frame(&[0.25, 1.0]);
    picture.expose(2.0);
    assert_eq!(picture.color(), [[1.0; 3], [4.0; 3]]);
    picture.expose(-3.0);
    assert_eq!(picture.color(), [[0.125; 3], [0.5; 3]]);
}

#[test]
fn any_light_level_comes_to_the_same() {
    let values: Vec<f32> = (1..=100).map(|value| 0.003 * value as f32).collect();
    let stops = frame(&values).auto_exposure();
    for level in [-40.0f32, -3.0, 5.0, 30.0] {
        let other: Vec<f32> = values.iter().map(|value| value * level.exp2()).collect();
        assert!((frame(&other).auto_exposure() + level - stops).abs() < 0.011, "{level}");
    }
    // The mean of a uniform grey is that grey.
    assert_eq!(frame(&[0.18 / 4.0; 7]).auto_exposure(), 2.0);
}

#[test]
fn highlights_keep_a_dark_picture_dark() {
    let mut values = vec![0.001; 80];
    values.extend([2.0; 20]);
    assert_eq!(frame(&values).auto_exposure(), -1.0);
    // Fewer may be clipped.
    values.truncate(83);
    assert!(frame(&values).auto_exposure() > 4.0);
}

#[test]
fn what_is_black_or_no_number_does_not_count() {
    assert_eq!(frame(&[0.0, f32::NAN, f32::INFINITY, -1.0]).auto_exposure(), 0.0);
    assert_eq!(frame(&[0.0, f32::NAN, 0.09]).auto_exposure(), 1.0);
}

#[test]
fn highlights_are_brought_back_and_little_is_brightened() {
    assert_eq!(frame(&[0.01; 9]).highlight_exposure(), 0.5);
    assert_eq!(frame(&[0.0; 9]).highlight_exposure(), 0.5);
    assert_eq!(frame(&[0.85; 9]).highlight_exposure(), 0.0);
    assert_eq!(frame(&[1.7; 9]).highlight_exposure(), -1.0);
    // A hundredth may be white.
    let mut values = [0.1; 1000];
    values[..9].fill(100.0);
    assert_eq!(frame(&values).highlight_exposure(), 0.5);
    values[..11].fill(100.0);
    assert!(frame(&values).highlight_exposure() < -6.0);
    let blue = Frame::new(1, 1, vec![[0.0, 0.0, 3.4]]).unwrap();
    assert_eq!(blue.highlight_exposure(), -2.0);
}
