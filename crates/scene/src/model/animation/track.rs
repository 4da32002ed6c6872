//! Values over time, by keys.

use glam::DQuat;

/// How values go from one key to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
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
pub enum Kind {
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
pub struct Track {
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
    pub fn new(
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
    pub fn with_slopes(kind: Kind, times: Vec<f64>, triples: &[f64]) -> Result<Track, &'static str> {
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
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Whether all keys have the same values, so that nothing moves.
    pub fn is_constant(&self) -> bool {
        let width = self.kind.width();
        let first = &self.values[..width];
        let straight = match &self.between {
            Between::Step | Between::Linear => true,
            Between::Cubic { before, after } => before.iter().chain(after).all(|&slope| slope == 0.0),
        };
        straight && self.values.chunks_exact(width).all(|values| values == first)
    }

    /// The values at `time`, seconds.
    pub fn sample(&self, time: f64, values: &mut [f64]) {
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
