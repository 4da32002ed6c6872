use lightmesh_render::internals::shading::{angle, logarithm, turns};

#[test]
fn turns_are_arc_tangents() {
    let (mut worst, mut radians) = (0.0f64, 0.0f64);
    for step in 0..10_000 {
        let expected = f64::from(step - 5000) * std::f64::consts::TAU / 10_001.0;
        let (sin, cos) = expected.sin_cos();
        let (y, x) = ((7.0 * sin) as f32, (7.0 * cos) as f32);
        let expected = f64::from(y).atan2(f64::from(x));
        worst = worst.max((f64::from(turns(y, x)) - expected / std::f64::consts::TAU).abs());
        radians = radians.max((f64::from(angle(y, x)) - expected).abs());
    }
    assert!(worst < 1e-7 && radians < 6e-7, "{worst}, {radians}");
    assert_eq!([turns(0.0, 0.0), turns(0.0, 1.0), turns(1.0, 0.0), turns(-1.0, 0.0)], [0.0, 0.0, 0.25, -0.25]);
    assert_eq!(turns(0.0, -1.0), 0.5);
}

#[test]
fn logarithms_are_natural() {
    let mut worst = 0.0f64;
    for step in 0..20_000 {
        let number = (f64::from(step) * 0.004).exp() as f32;
        let expected = f64::from(number).ln();
        worst = worst.max((f64::from(logarithm(number)) - expected).abs() / expected.max(1.0));
    }
    assert!(worst < 2e-7, "{worst}");
    assert_eq!(logarithm(1.0), 0.0);
}
