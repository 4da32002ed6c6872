use glam::{Vec2, Vec3};
use lightmesh_render::internals::irradiance_cache::{BINS, above, basis, bin};

#[test]
fn weights_are_those_of_the_cosine() {
    // Over the hemisphere, ∫ cos = π, ∫ cos² = 2π/3; the square's area is 4.
    let n = 256;
    let place = |index: usize| (2 * index + 1) as f32 / n as f32 - 1.0;
    let (mut first, mut second) = (0.0f64, 0.0f64);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let (direction, weight) = above(Vec2::new(place(i), place(j)));
        assert!((direction.length() - 1.0).abs() < 1e-5 && direction.z >= 0.0 && weight >= 0.0);
        first += f64::from(weight);
        second += f64::from(weight * direction.z);
    }
    let area = 4.0 / (n * n) as f64;
    assert!((area * first - std::f64::consts::PI).abs() < 1e-3, "{}", area * first);
    assert!((area * second - 2.0 * std::f64::consts::PI / 3.0).abs() < 1e-3, "{}", area * second);
}

#[test]
fn every_direction_has_a_bin_and_a_basis() {
    let mut met = [0; BINS];
    for i in 0..4000 {
        let (sin, cos) = (2.4 * i as f32).sin_cos();
        let z = 1.0 - (2 * i + 1) as f32 / 4000.0;
        let r = (1.0 - z * z).sqrt();
        let n = Vec3::new(r * cos, r * sin, z);
        met[bin(n)] += 1;
        let [a, b] = basis(n);
        assert!((a.cross(b) - n).length() < 1e-5 && a.dot(b).abs() < 1e-5);
    }
    assert!(met.iter().all(|&count| count > 20), "{met:?}");
}
