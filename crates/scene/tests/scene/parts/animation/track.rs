use std::f64::consts::FRAC_PI_2;

use glam::DQuat;
use lightmesh_scene::internals::animation::{Interpolation, Kind, Track};

fn track(times: &[f64], values: &[f64], interpolation: Interpolation) -> Track {
    Track::new(Kind::Numbers(values.len() / times.len()), times.to_vec(), values.to_vec(), interpolation).unwrap()
}

fn at(track: &Track, time: f64) -> f64 {
    let mut value = [0.0];
    track.sample(time, &mut value);
    value[0]
}

#[test]
fn values_pass_through_their_keys() {
    for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::Smooth] {
        let track = track(&[1.0, 2.0, 4.0], &[3.0, -1.0, 7.0], interpolation);
        let found = [0.0, 1.0, 2.0, 4.0, 9.0].map(|time| at(&track, time));
        assert_eq!(found, [3.0, 3.0, -1.0, 7.0, 7.0], "{interpolation:?}");
        assert_eq!(track.end(), 4.0);
    }
}

#[test]
fn each_interpolation_has_its_way_between() {
    let keys = |interpolation| track(&[0.0, 1.0, 3.0, 4.0], &[0.0, 2.0, 6.0, 8.0], interpolation);
    assert_eq!(at(&keys(Interpolation::Step), 2.9), 2.0);
    assert_eq!(at(&keys(Interpolation::Linear), 2.5), 5.0);
    // A line stays one, whatever the distances of its keys.
    let smooth = keys(Interpolation::Smooth);
    assert!((0..40).all(|i| (at(&smooth, 0.1 * f64::from(i)) - 0.2 * f64::from(i)).abs() < 1e-12));
}

#[test]
fn rotations_take_the_short_way() {
    let turn = |angle: f64| DQuat::from_rotation_z(angle);
    let keys = [turn(0.0), -turn(FRAC_PI_2), turn(2.0 * FRAC_PI_2)];
    let values: Vec<f64> = keys.iter().flat_map(|key| key.to_array()).collect();
    for (interpolation, close) in [(Interpolation::Linear, 1e-9), (Interpolation::Smooth, 0.05)] {
        let track = Track::new(Kind::Rotations, vec![0.0, 1.0, 2.0], values.clone(), interpolation).unwrap();
        let mut found = [0.0; 4];
        track.sample(0.5, &mut found);
        let difference = DQuat::from_array(found).angle_between(turn(0.5 * FRAC_PI_2));
        assert!(difference < close, "{interpolation:?} {difference}");
    }
}

#[test]
fn slopes_of_a_file_are_followed() {
    // From 0 to 0, leaving and arriving with the slope 1: s³ - 2s² + s + s³ - s².
    let track = Track::with_slopes(Kind::Numbers(1), vec![0.0, 1.0], &[9.0, 0.0, 1.0, 1.0, 0.0, 9.0]).unwrap();
    assert!((at(&track, 0.25) - 0.09375).abs() < 1e-12 && !track.is_constant());
}

#[test]
fn damaged_tracks_are_refused() {
    let new = |times: &[f64], values: &[f64]| {
        Track::new(Kind::Numbers(1), times.to_vec(), values.to_vec(), Interpolation::Smooth).is_ok()
    };
    assert!(new(&[0.0, 1.0, 1.0], &[1.0; 3]));
    assert!(!new(&[], &[]) && !new(&[0.0], &[1.0; 2]) && !new(&[1.0, 0.0], &[1.0; 2]));
    assert!(!new(&[f64::NAN], &[1.0]) && new(&[-1.0], &[1.0]));
}
