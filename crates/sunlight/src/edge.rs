//! The times when the sun is on one side of a plane through the receiver.
//!
//! The plane of an edge v₀ v₁ seen from P has the normal m = (v₀−P)×(v₁−P). With a, b, c = m·A, m·B, m·C of the circle the sun is on its side where
//! c + a cos θ + b sin θ ≥ 0, but for the deviation ε from the circle. R² = a² + b², D² = R² − c².
//!
//! 1. |c| − R > ε|m|: no root; the sign of c holds all day.
//! 2. D² > 8 ε|m|R and D² > 10⁻⁶ R²: a rising and a falling root at atan2(b, a) ∓ atan2(D, −c), and Newton steps on m·s(t) from there. Roots outside of
//!    the times of interest need none.
//! 3. Else, where the plane is tangent to the sun's way, or a root is near the sun's midnight in a polar day: samples of two minutes. Signs that change are
//!    bisected; where the same sign turns towards zero, the turning point is found and tested.
//!
//! All steps are + − × ÷, square roots and comparisons of doubles: the same bits everywhere. Who asks orders the ends of the edge, so that both triangles
//! at an edge get the same roots.

use glam::DVec3;

use crate::path::SunPath;
use crate::samples::by_samples;
use crate::spans::Spans;
use crate::time::{DAY, RATE};
use crate::turn::atan2;

/// A root is settled when a step is shorter, in seconds: the next would be below 10⁻⁹.
const SETTLED: f64 = 1e-3;
/// Newton steps at most; 2.2 are usual.
const STEPS: usize = 8;
/// Further, in seconds, no root of the circle is from that of the sun.
const FAR: f64 = 5400.0;
/// Times of interest are widened by so many seconds at least.
const MARGIN: f64 = 60.0;

/// The times of the path when m·s ≥ 0. Ends outside of the times `of_interest` are those of the circle.
pub(crate) fn positive(path: &SunPath, m: DVec3, of_interest: (f64, f64)) -> Spans {
    let (begin, end) = path.hull;
    let [c, a, b] = path.circle.map(|part| m.dot(part));
    let deviation = path.deviation * m.length();
    let radius = (a * a + b * b).sqrt();
    if c.abs() - radius > deviation {
        return if c > 0.0 { Spans::one(begin, end) } else { Spans::default() };
    }
    let depth = radius * radius - c * c;
    if depth > 8.0 * deviation * radius && depth > 1e-6 * radius * radius {
        let depth = depth.sqrt();
        let (middle, half) = (atan2(b, a), atan2(depth, -c));
        let reach = 1.5 * deviation / depth / RATE + MARGIN;
        let [rising, falling] = [middle - half, middle + half].map(|angle| in_day(path, angle));
        let near_midnight = |time: f64| time < begin + reach || time > end - reach;
        let is_cut = end - begin > DAY - 2.0 * reach && (near_midnight(rising) || near_midnight(falling));
        if reach < 0.5 * FAR && !is_cut {
            let is_asked = |time: f64| time > of_interest.0 - reach && time < of_interest.1 + reach;
            let root = |time: f64, rises: bool| if is_asked(time) { newton(path, m, time, rises) } else { Some(time) };
            if let (Some(rising), Some(falling)) = (root(rising, true), root(falling, false)) {
                return between(rising, falling, path.hull);
            }
        }
    }
    by_samples(|time| path.at(time), path.hull, m)
}

/// The time of an angle that is nearest to the middle of the path.
fn in_day(path: &SunPath, angle: f64) -> f64 {
    let time = angle / RATE + path.noon;
    let off = time - 0.5 * (path.hull.0 + path.hull.1);
    // Angles are sums of two, each of half a turn at most.
    if off > 0.5 * DAY {
        time - DAY
    } else if off < -0.5 * DAY {
        time + DAY
    } else {
        time
    }
}

/// From the rising to the falling root, within the path.
fn between(rising: f64, falling: f64, (begin, end): (f64, f64)) -> Spans {
    let mut spans = Spans::default();
    if rising < falling {
        spans.push(rising.max(begin), falling.min(end));
        return spans;
    }
    if falling >= rising || falling.min(end) >= rising.max(begin) {
        return Spans::one(begin, end);
    }
    spans.push(begin, falling.min(end));
    spans.push(rising.max(begin), end);
    spans
}

/// A root of m·s near `start`, where it rises or falls; `None` if it does not settle.
fn newton(path: &SunPath, m: DVec3, start: f64, rises: bool) -> Option<f64> {
    let mut time = start;
    for step in 0..STEPS {
        let (value, slope) = path.side(m, time);
        if (slope > 0.0) != rises {
            return None;
        }
        let by = value / slope;
        time -= by;
        if time.is_nan() || (time - start).abs() > FAR {
            return None;
        }
        if by.abs() < 1e-7 || step >= 1 && by.abs() < SETTLED {
            return Some(time);
        }
    }
    None
}
