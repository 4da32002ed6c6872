use lightmesh_render::internals::light_mesh::{GROWTH, Probe, points_per_pixel, raised, rounded};

#[test]
fn steps_are_rounded_up_to_two_digits() {
    for (step, expected) in [(0.1234, 0.13), (1.0, 1.0), (9.91, 10.0), (432.0, 440.0), (1.5e-6, 1.5e-6)] {
        let result = rounded(step);
        assert!((result / expected - 1.0).abs() < 1e-6 && result >= step * 0.999_999, "{step} became {result}");
    }
}

#[test]
fn a_step_is_raised_until_it_is_not_too_fine() {
    for enough in [0.5, 1.0, 1.04, 1.2, 7.0, 1e6] {
        let mut expected = 1.0_f32;
        while expected < enough {
            expected *= GROWTH;
        }
        assert_eq!(raised(1.0, |step| step < enough).to_bits(), expected.to_bits(), "{enough}");
    }
}

#[test]
fn more_light_points_are_expected_of_a_finer_mesh() {
    let probes: Vec<Probe> = (1..100).map(|i| Probe { spacing: 1.0, area: f64::from(i) * 0.01 }).collect();
    let expected: Vec<f64> = [0.1, 0.2, 0.4, 0.8].iter().map(|&h| points_per_pixel(&probes, h, 2.1)).collect();
    assert!(expected.is_sorted_by(|a, b| a > b), "{expected:?}");
}
