use glam::Vec3;
use lightmesh_scene::internals::builtin::{Random, around, srgb};

#[test]
fn the_circle_agrees_with_the_library() {
    for step in -40..40 {
        let turns = step as f32 / 16.0 + 0.01;
        let (sin, cos) = (f64::from(turns) * std::f64::consts::TAU).sin_cos();
        let point = around(turns);
        assert!((f64::from(point.x) - cos).abs() < 1e-6 && (f64::from(point.y) - sin).abs() < 1e-6, "{turns}");
    }
}

#[test]
fn random_numbers_fill_the_interval() {
    let mut random = Random::new(1);
    let values: Vec<f32> = (0..1000).map(|_| random.unit()).collect();
    let mean = values.iter().sum::<f32>() / 1000.0;
    assert!(values.iter().all(|value| (0.0..1.0).contains(value)) && (mean - 0.5).abs() < 0.03);
}

#[test]
fn directions_are_unit_vectors_and_disks_are_round() {
    let mut random = Random::new(2);
    assert!((0..100).all(|_| (random.direction().length() - 1.0).abs() < 1e-5));
    assert!((0..100).all(|_| random.disk().length() < 1.0 + 1e-6));
}

#[test]
fn colours_follow_the_srgb_curve() {
    let mid = srgb(0x808080).x;
    assert!((mid - 0.2159).abs() < 0.003, "{mid}");
    assert!((srgb(0xff0000) - Vec3::X).length() < 1e-4);
}
