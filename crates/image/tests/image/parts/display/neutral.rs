use lightmesh_image::internals::display::neutral;

fn is_near(color: [f32; 3], expected: [f32; 3]) -> bool {
    color.into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-6)
}

#[test]
fn known_values() {
    // Below compression: minus 0.04, or minus x - 6.25 x² where the least channel is below 0.08.
    assert!(is_near(neutral([0.5, 0.3, 0.1]), [0.46, 0.26, 0.06]));
    assert!(is_near(neutral([0.5, 0.3, 0.04]), [0.47, 0.27, 0.01]));
    assert_eq!(neutral([0.0, 0.3, 0.7]), [0.0, 0.3, 0.7]);
    assert_eq!(neutral([0.0; 3]), [0.0; 3]);
    // Grey of 1: 0.96, of which 0.76 is kept and the rest compressed to 1 - 0.24² / (0.96 + 0.24 - 0.76).
    assert!(is_near(neutral([1.0; 3]), [1.0 - 0.0576 / 0.44; 3]));
    // Red of 2: the peak 2 becomes 1 - 0.0576 / 1.48, and the other channels that much of 1 - 1 / (0.15 * (2 - peak) + 1).
    let peak = 1.0 - 0.0576 / 1.48;
    assert!(is_near(neutral([2.0, 0.0, 0.0]), [peak, peak * 0.134_826_7, peak * 0.134_826_7]));
}

#[test]
fn compression_begins_smoothly() {
    let [below, above] = [0.799_999, 0.800_001].map(|grey| neutral([grey; 3])[0]);
    assert!(above > below && above - below < 3e-6, "{below} {above}");
}
