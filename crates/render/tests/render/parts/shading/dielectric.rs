use glam::Vec3;
use lightmesh_render::internals::shading::{exp_of_minus, fresnel, refracted};

#[test]
fn the_exponential_is_that_of_the_library() {
    for step in 0..8700 {
        let x = step as f32 / 100.0;
        let (found, expected) = (f64::from(exp_of_minus(x)), (-f64::from(x)).exp());
        assert!(((found - expected) / expected).abs() < 3e-7, "{x}: {found}, not {expected}");
    }
    assert_eq!((exp_of_minus(0.0), exp_of_minus(200.0), exp_of_minus(f32::INFINITY)), (1.0, 0.0, 0.0));
}

#[test]
fn fresnels_equations_have_their_known_values() {
    // Glass at normal incidence, at Brewster's angle (where all reflected light is polarised across), and at a grazing angle.
    let (glass, brewster) = (1.0 / 1.5, 1.5_f32.atan().cos());
    assert!((fresnel(1.0, glass) - 0.04).abs() < 1e-6);
    assert!((fresnel(brewster, glass) - 0.5 * (5.0_f32 / 13.0).powi(2)).abs() < 1e-6);
    assert!(fresnel(1e-4, glass) > 0.999);
    // The way back, and beyond the critical angle of 41.8 degrees.
    assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-6);
    assert_eq!(fresnel(42_f32.to_radians().cos(), 1.5), 1.0);
    assert!(fresnel(41_f32.to_radians().cos(), 1.5) < 0.5);
}

#[test]
fn snells_law_holds_both_ways() {
    for degrees in [0.0_f32, 10.0, 35.0, 60.0, 85.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let down = Vec3::new(sine, -cosine, 0.0);
        let within = refracted(down, Vec3::Y, 1.0 / 1.5).unwrap();
        assert!((1.5 * within.x - sine).abs() < 1e-6 && within.is_normalized() && within.y < 0.0, "{within}");
        assert!(refracted(within, Vec3::Y, 1.5).unwrap().abs_diff_eq(down, 2e-6), "{degrees}");
    }
    assert_eq!(refracted(Vec3::new(0.8, -0.6, 0.0), Vec3::Y, 1.5), None);
}
