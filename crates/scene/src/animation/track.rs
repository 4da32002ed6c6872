//! Values over time, by keys.

use glam::DQuat;

/// How values go from one key to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Interpolation {
    /// They stay until the next key.
    Step,
    /// Along a line, rotations along the shortest arc.
    Linear,
    /// By cubic Hermite splines with the slopes of Catmull and Rom, 1974: those between the keys before and after.
    #[default]
    Smooth,
}

/// What a track is the values of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// This many numbers at each key.
    Numbers(usize),
    /// Unit quaternions: x, y, z, w.
    Rotations,
}

impl Kind {
    /// Numbers at each key.
    pub(crate) fn width(self) -> usize {
        match self {
            Kind::Numbers(width) => width,
            Kind::Rotations => 4,
        }
    }
}

/// Values over time. Before the first key and after the last one they stay.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    kind: Kind,
    /// Seconds, ascending; at least one.
    times: Vec<f64>,
    /// One after another.
    values: Vec<f64>,
    between: Between,
}

#[derive(Clone, Debug)]
enum Between {
    Step,
    Linear,
    /// Slopes before and after each key, per second.
    Cubic {
        before: Vec<f64>,
        after: Vec<f64>,
    },
}

impl Track {
    /// A track of keys at `times` in seconds, with the values of each after those of the one before. What is wrong with it, if something is.
    pub(crate) fn new(
        kind: Kind,
        times: Vec<f64>,
        mut values: Vec<f64>,
        interpolation: Interpolation,
    ) -> Result<Track, &'static str> {
        check(kind, &times, &values)?;
        let between = match interpolation {
            Interpolation::Step => Between::Step,
            Interpolation::Linear => Between::Linear,
            Interpolation::Smooth => {
                if kind == Kind::Rotations {
                    take_short_ways(&mut values);
                }
                let slopes = slopes(kind.width(), &times, &values);
                Between::Cubic { before: slopes.clone(), after: slopes }
            }
        };
        Ok(Track { kind, times, values, between })
    }

    /// A track with the slopes of its file: each key has the slope before it, its values, and the slope after it.
    pub(crate) fn with_slopes(kind: Kind, times: Vec<f64>, triples: &[f64]) -> Result<Track, &'static str> {
        let width = kind.width();
        let part = |part: usize| -> Vec<f64> {
            triples.chunks_exact(3 * width).flat_map(|key| &key[part * width..(part + 1) * width]).copied().collect()
        };
        let (before, values, after) = (part(0), part(1), part(2));
        check(kind, &times, &values)?;
        Ok(Track { kind, times, values, between: Between::Cubic { before, after } })
    }

    /// Numbers at each key.
    pub(crate) fn width(&self) -> usize {
        self.kind.width()
    }

    /// The time of the last key, seconds.
    pub(crate) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Whether all keys have the same values, so that nothing moves.
    pub(crate) fn is_constant(&self) -> bool {
        let width = self.kind.width();
        let first = &self.values[..width];
        let straight = match &self.between {
            Between::Step | Between::Linear => true,
            Between::Cubic { before, after } => before.iter().chain(after).all(|&slope| slope == 0.0),
        };
        straight && self.values.chunks_exact(width).all(|values| values == first)
    }

    /// The values at `time`, seconds.
    pub(crate) fn sample(&self, time: f64, values: &mut [f64]) {
        let width = self.kind.width();
        let at = |key: usize| &self.values[key * width..(key + 1) * width];
        let next = self.times.partition_point(|&key| key <= time);
        if next == 0 || next == self.times.len() {
            let key = next.saturating_sub(1);
            values.copy_from_slice(at(key));
            return self.keep_unit(values);
        }
        let key = next - 1;
        let length = self.times[next] - self.times[key];
        let share = (time - self.times[key]) / length;
        match &self.between {
            Between::Step => values.copy_from_slice(at(key)),
            Between::Linear if self.kind == Kind::Rotations => {
                let rotation = |key| DQuat::from_slice(at(key)).normalize();
                values.copy_from_slice(&rotation(key).slerp(rotation(next), share).to_array());
            }
            Between::Linear => {
                for (value, (&a, &b)) in values.iter_mut().zip(at(key).iter().zip(at(next))) {
                    *value = a + share * (b - a);
                }
            }
            Between::Cubic { before, after } => {
                let [s, s2, s3] = [share, share * share, share * share * share];
                for (index, value) in values.iter_mut().enumerate() {
                    let [a, b] = [key, next].map(|key| self.values[key * width + index]);
                    let (leaving, arriving) = (after[key * width + index], before[next * width + index]);
                    *value = (2.0 * s3 - 3.0 * s2 + 1.0) * a
                        + (s3 - 2.0 * s2 + s) * length * leaving
                        + (3.0 * s2 - 2.0 * s3) * b
                        + (s3 - s2) * length * arriving;
                }
            }
        }
        self.keep_unit(values);
    }

    /// The three numbers at `time`.
    pub(crate) fn vector(&self, time: f64) -> [f64; 3] {
        let mut values = [0.0; 3];
        self.sample(time, &mut values);
        values
    }

    fn keep_unit(&self, values: &mut [f64]) {
        if self.kind == Kind::Rotations {
            let unit = DQuat::from_slice(values).normalize();
            values.copy_from_slice(&if unit.is_finite() { unit } else { DQuat::IDENTITY }.to_array());
        }
    }
}

fn check(kind: Kind, times: &[f64], values: &[f64]) -> Result<(), &'static str> {
    if times.is_empty() {
        return Err("has no keys");
    }
    if Some(values.len()) != times.len().checked_mul(kind.width()) {
        return Err("does not have one value for each key");
    }
    if !times.iter().all(|time| time.is_finite()) {
        return Err("has a key at a time that is not finite");
    }
    if !times.is_sorted() {
        return Err("has keys that are not in the order of their times");
    }
    Ok(())
}

/// A quaternion and its negative are the same rotation: of the two each key has the one that is nearer to the key before.
fn take_short_ways(values: &mut [f64]) {
    for key in 1..values.len() / 4 {
        let (before, own) = values.split_at_mut(4 * key);
        if DQuat::from_slice(&before[4 * (key - 1)..]).dot(DQuat::from_slice(own)) < 0.0 {
            own[..4].iter_mut().for_each(|value| *value = -*value);
        }
    }
}

/// The slope at each key: that between its neighbours, at the ends that to the only one.
fn slopes(width: usize, times: &[f64], values: &[f64]) -> Vec<f64> {
    let last = times.len() - 1;
    let slope = |key: usize, index: usize| {
        let (from, to) = (key.saturating_sub(1), (key + 1).min(last));
        let seconds = times[to] - times[from];
        if seconds > 0.0 { (values[to * width + index] - values[from * width + index]) / seconds } else { 0.0 }
    };
    (0..=last).flat_map(|key| (0..width).map(move |index| (key, index))).map(|(key, index)| slope(key, index)).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

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
}
