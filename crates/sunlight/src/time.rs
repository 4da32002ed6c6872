//! Units of time.

use std::f64::consts::TAU;

/// Seconds of a day.
pub(crate) const DAY: f64 = 86_400.0;
/// Radians of hour angle in a second.
pub(crate) const RATE: f64 = TAU / DAY;
