use glam::Vec3;
use lightmesh_render::sampling::{Pattern, light_center, light_point};
use lightmesh_render::sampling::{disk_radius, in_ball, sobol_1, sobol_2};
use lightmesh_scene::{Light, LightKind};

#[test]
fn every_power_of_two_is_stratified_in_each_dimension() {
    for key in 0..20 {
        let pattern = Pattern::new(7, key, 0);
        for count in [2u32, 16, 64, 256] {
            for axis in 0..3 {
                let mut strata = vec![0; count as usize];
                for index in 0..count {
                    strata[(pattern.point(index)[axis] * count as f32) as usize] += 1;
                }
                assert!(strata.iter().all(|&hits| hits == 1), "key {key}, {count} points, axis {axis}");
            }
        }
    }
}

#[test]
fn the_first_two_dimensions_are_a_zero_two_sequence() {
    let pattern = Pattern::new(0, 3, 1);
    for (nx, ny) in [(16, 1), (8, 2), (4, 4), (2, 8), (1, 16)] {
        let cells: std::collections::BTreeSet<_> = (0..16)
            .map(|index| pattern.point(index))
            .map(|u| ((u.x * nx as f32) as u32, (u.y * ny as f32) as u32))
            .collect();
        assert_eq!(cells.len(), 16, "{nx} by {ny}");
    }
}

#[test]
fn dimensions_are_sobols() {
    // Direction numbers as Sobol defines them, the first digit most significant.
    let (mut first, mut second, mut next) = (1u32 << 31, 1u32 << 31, 3u32 << 30);
    for bit in 0..32 {
        assert_eq!(sobol_1(1 << bit).reverse_bits(), first, "bit {bit}");
        assert_eq!(sobol_2(1 << bit).reverse_bits(), second, "bit {bit}");
        first ^= first >> 1;
        (second, next) = (next, next ^ second ^ (second >> 2));
    }
    for index in [0, 5, 0xdead_beef, u32::MAX] {
        let bits = || (0..32).map(|bit| index & 1 << bit);
        assert_eq!(sobol_1(index), bits().fold(0, |sum, bit| sum ^ sobol_1(bit)), "{index}");
        assert_eq!(sobol_2(index), bits().fold(0, |sum, bit| sum ^ sobol_2(bit)), "{index}");
    }
}

#[test]
fn patterns_depend_on_seed_key_and_light() {
    let first = |seed, key, light| Pattern::new(seed, key, light).point(0);
    let reference = first(0, 0, 0);
    assert_eq!(reference, first(0, 0, 0));
    for other in [first(1, 0, 0), first(0, 1, 0), first(0, 0, 1)] {
        assert_ne!(reference, other);
    }
}

#[test]
fn a_directional_light_fills_a_disk_of_its_angle_evenly() {
    let (direction, from) = (Vec3::new(0.48, -0.8, 0.36), Vec3::new(3.0, -2.0, 1.0));
    let pattern = Pattern::new(0, 0, 0);
    for angle in [0.0093f32, 0.5, 3.0] {
        let sun = Light::directional(direction).unwrap().with_angle(angle);
        let shifts: Vec<Vec3> = (0..4096)
            .map(|index| light_point(&sun, from, 50.0, pattern.point(index)) - light_center(&sun, from, 50.0))
            .collect();
        let radius = 50.0 * (0.5 * angle).tan();
        let farthest = shifts.iter().map(|shift| shift.length()).fold(0.0, f32::max);
        assert!((0.99..1.001).contains(&(farthest / radius)), "{angle}: {farthest}, not {radius}");
        let mean = shifts.iter().sum::<Vec3>() / 4096.0;
        let inner = shifts.iter().filter(|shift| shift.length() < 0.5 * radius).count();
        assert!(
            mean.length() < 0.01 * radius && (inner as f32 / 4096.0 - 0.25).abs() < 0.005,
            "{angle}: {mean}, {inner}"
        );
        assert!(shifts.iter().all(|shift| shift.dot(direction).abs() < 1e-4 * radius.max(1.0)), "{angle}");
    }
}

#[test]
fn a_disk_has_a_radius_exactly_if_the_light_has_a_size() {
    let angles = [0.0, -0.0, -1.0, f32::NAN, 1e-45, 1e-40, 0.0093, 3.0, std::f32::consts::PI, 4.0, f32::INFINITY];
    for angle in angles {
        let sun = Light::new(LightKind::Directional { direction: Vec3::NEG_Y, angle });
        assert_eq!(disk_radius(angle) > 0.0, sun.has_size(), "{angle}");
    }
}

#[test]
fn a_ball_is_filled_evenly() {
    let pattern = Pattern::new(0, 0, 0);
    let points: Vec<Vec3> = (0..4096).map(|index| in_ball(pattern.point(index))).collect();
    let mean = points.iter().sum::<Vec3>() / 4096.0;
    let inner = points.iter().filter(|point| point.length() < 0.5).count();
    assert!(mean.length() < 0.01, "{mean}");
    assert!((inner as f32 / 4096.0 - 0.125).abs() < 0.005, "{inner}");
}
