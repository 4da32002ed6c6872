use lightmesh_image::internals::display::Curve;

#[test]
fn powers_are_close() {
    for exponent in [1.0 / 2.4, 1.0, 2.4] {
        let curve = Curve::new(1.0 / 512.0, 4.0, |x| x.powf(exponent));
        for step in 0..=100_000 {
            let x = 1.0 / 512.0 * 2048.0_f32.powf(step as f32 / 100_000.0);
            let exact = f64::from(x.min(4.0)).powf(exponent);
            assert!((f64::from(curve.at(x)) / exact - 1.0).abs() < 1e-5, "{x}^{exponent}");
        }
    }
}

#[test]
fn outside_are_the_ends() {
    let curve = Curve::new(0.5, 2.0, |x| 10.0 * x);
    assert_eq!([0.5, 1.0, 1.75, 2.0].map(|x| curve.at(x)), [5.0, 10.0, 17.5, 20.0]);
    assert_eq!([f32::NAN, f32::NEG_INFINITY, -1.0, 0.0].map(|x| curve.at(x)), [5.0; 4]);
    assert_eq!([2.1, f32::MAX, f32::INFINITY].map(|x| curve.at(x)), [20.0; 3]);
}
