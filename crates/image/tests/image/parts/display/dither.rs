use lightmesh_image::internals::display::{LEVELS, threshold};

#[test]
fn thresholds_are_spread_evenly() {
    let thresholds: Vec<f32> = (0..64 * 64).map(|pixel| threshold(pixel % 64, pixel / 64)).collect();
    for tenth in 0..10 {
        let from = tenth as f32 / 10.0;
        let count = thresholds.iter().filter(|&&value| value >= from && value < from + 0.1).count();
        assert!((380..440).contains(&count), "{count} of 4096 thresholds from {from}");
    }
    assert!(thresholds.iter().all(|value| (0.5 / LEVELS..=1.0 - 0.5 / LEVELS).contains(value)));
}

#[test]
fn neighbours_differ() {
    // In every square of 4 x 4 pixels the mean is near one half, which is what makes it blue.
    for y in 0..60 {
        for x in 0..60 {
            let sum: f32 = (0..16).map(|pixel| threshold(x + pixel % 4, y + pixel / 4)).sum();
            assert!((sum / 16.0 - 0.5).abs() < 0.1, "({x}, {y}): {sum}");
        }
    }
}
