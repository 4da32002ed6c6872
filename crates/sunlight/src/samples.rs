//! The times when the sun is on one side of a plane, by samples of its way: for planes that it only touches, and what must be right whatever the circle.
//!
//! Signs that differ between two samples are bisected. Where the same sign turns towards zero between them, the turning point is found and tested.

use glam::DVec3;

use crate::spans::Spans;
use crate::time::RATE;

/// Seconds between samples.
const SAMPLE: f64 = 120.0;

/// The times between `begin` and `end` when m·s ≥ 0. `at` has the sun's direction and its change.
pub(crate) fn by_samples(at: impl Fn(f64) -> (DVec3, DVec3), (begin, end): (f64, f64), m: DVec3) -> Spans {
    let count = ((end - begin) / SAMPLE).ceil().max(4.0) as usize;
    let step = (end - begin) / count as f64;
    // More than a parabola can rise between two samples.
    let rise = m.length() * (RATE * step) * (RATE * step) * 0.5;
    let at = |time: f64| {
        let (direction, change) = at(time);
        (m.dot(direction), m.dot(change))
    };
    let is_on = |value: f64| value >= 0.0;
    // Where the sign changes between two times.
    let bisected = |low: f64, high: f64| {
        let first = is_on(at(low).0);
        halved(low, high, |time| is_on(at(time).0) == first)
    };
    let (mut spans, mut from) = (Spans::default(), begin);
    let mut before = at(begin);
    let mut was_on = is_on(before.0);
    let mut change = |time: f64| {
        if was_on {
            spans.push(from, time);
        }
        (was_on, from) = (!was_on, time);
    };
    for sample in 0..count {
        let (low, high) = (begin + step * sample as f64, begin + step * (sample + 1) as f64);
        let now = at(high);
        if is_on(before.0) != is_on(now.0) {
            change(bisected(low, high));
        } else if before.0.abs().min(now.0.abs()) < rise
            && (before.1 > 0.0) != (now.1 > 0.0)
            && (before.1 > 0.0) != is_on(before.0)
        {
            // It turns towards zero.
            let turning = halved(low, high, |time| (at(time).1 > 0.0) == (before.1 > 0.0));
            if is_on(at(turning).0) != is_on(before.0) {
                change(bisected(low, turning));
                change(bisected(turning, high));
            }
        }
        before = now;
    }
    if was_on {
        spans.push(from, end);
    }
    spans
}

/// The end of what is `as_before` from `low` on.
fn halved(mut low: f64, mut high: f64, as_before: impl Fn(f64) -> bool) -> f64 {
    while high - low > 1e-9 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if as_before(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
