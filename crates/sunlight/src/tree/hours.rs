//! From a box to the times when the sun can be behind it.
//!
//! In the axes of the equator (meridian, pole, west) the sun's angle about the pole only grows over a day, and its distance from the equator hardly changes.
//! So a box, seen from a receiver, can be before the sun only if it reaches the band between the day's least and greatest slope, and then only between the
//! times of its first and last angle, which two of its corners have. Angles are looked up in bins; a pseudo-angle stands for them.

use super::node::{Node, WIDTH};
use crate::path::SunPath;

/// Bins of the whole turn.
const BINS: usize = 2048;
/// Seconds between the samples of the table.
const SAMPLE: f64 = 5.0;
/// Rounding of slopes.
const SLACK: f32 = 2e-5;
/// Never.
const NEVER: (f32, f32) = (f32::MAX, f32::MIN);

/// When the sun can be behind boxes, on one path.
#[derive(Clone, Debug)]
pub struct HourTable {
    /// The earliest time with an angle of a bin, or a later bin.
    earliest: Vec<f32>,
    /// The latest time with an angle of a bin, or an earlier bin.
    latest: Vec<f32>,
    /// The whole path, a little widened.
    hull: (f32, f32),
    /// The least and the greatest height above the equator, relative to the distance from the axis.
    slopes: (f32, f32),
}

/// What grows as the angle from the x axis to (x, y) does, from −2 to 2.
#[inline(always)]
fn pseudo_angle(x: f32, y: f32) -> f32 {
    let share = y / (x.abs() + y.abs());
    if x >= 0.0 {
        share
    } else if y >= 0.0 {
        2.0 - share
    } else {
        -2.0 - share
    }
}

#[inline(always)]
fn bin(angle: f32) -> usize {
    (((angle + 2.0) * (BINS as f32 * 0.25)) as i32).clamp(0, BINS as i32 - 1) as usize
}

impl HourTable {
    /// Of a path.
    pub fn new(path: &SunPath) -> HourTable {
        let (begin, end) = path.hull;
        let count = ((end - begin) / SAMPLE).ceil().max(1.0);
        let step = (end - begin) / count;
        let margin = step as f32 + 1.0;
        let mut table = HourTable {
            earliest: vec![f32::MAX; BINS],
            latest: vec![f32::MIN; BINS],
            hull: (begin as f32 - 1.0, end as f32 + 1.0),
            slopes: (f32::MAX, f32::MIN),
        };
        let axes = path.axes();
        let mut before = None;
        for sample in 0..=count as usize {
            let time = begin + step * sample as f64;
            let direction = axes * path.at(time).0;
            let (x, y, z) = (direction.x as f32, direction.y as f32, direction.z as f32);
            let at = bin(pseudo_angle(x, z));
            // Bins between two samples are passed; from the last to the first one the turn begins anew.
            let from = before.filter(|&before: &usize| before.abs_diff(at) < BINS / 2).unwrap_or(at);
            for passed in at.min(from).saturating_sub(1)..=(at.max(from) + 1).min(BINS - 1) {
                table.earliest[passed] = table.earliest[passed].min(time as f32 - margin);
                table.latest[passed] = table.latest[passed].max(time as f32 + margin);
            }
            before = Some(at);
            let slope = y / (x * x + z * z).sqrt();
            table.slopes = (table.slopes.0.min(slope), table.slopes.1.max(slope));
        }
        for at in (0..BINS - 1).rev() {
            table.earliest[at] = table.earliest[at].min(table.earliest[at + 1]);
        }
        for at in 1..BINS {
            table.latest[at] = table.latest[at].max(table.latest[at - 1]);
        }
        table.slopes = (table.slopes.0 - SLACK, table.slopes.1 + SLACK);
        table
    }

    /// All times.
    pub(super) fn always(&self) -> [(f32, f32); 2] {
        [self.hull, NEVER]
    }

    /// The boxes of a node as they lie about a receiver. All eight are done in the same steps, which compilers turn into SIMD.
    #[inline(always)]
    pub(super) fn around(&self, node: &Node, point: [f32; 3], slack: f32) -> Around {
        let mut around = Around { low: node.low, high: node.high, ..Around::default() };
        let axes = around.low.iter_mut().zip(&mut around.high).zip(point);
        for ((low, high), place) in axes {
            low.iter_mut().for_each(|low| *low -= place + slack);
            high.iter_mut().for_each(|high| *high -= place - slack);
        }
        let ([x0, y0, z0], [x1, y1, z1]) = (around.low, around.high);
        let (least, greatest) = self.slopes;
        for lane in 0..WIDTH {
            let gap = |low: f32, high: f32| low.max(-high).max(0.0);
            let (dx, dy, dz) = (gap(x0[lane], x1[lane]), gap(y0[lane], y1[lane]), gap(z0[lane], z1[lane]));
            let (far_x, far_z) = (x1[lane].max(-x0[lane]), z1[lane].max(-z0[lane]));
            let near = dx * dx + dz * dz;
            let (near_edge, far_edge) = (near.sqrt(), (far_x * far_x + far_z * far_z).sqrt());
            // A slope above the equator is least near the axis, and one below it far away.
            let lowest = (least * near_edge).min(least * far_edge);
            let highest = (greatest * near_edge).max(greatest * far_edge);
            around.near[lane] = near;
            around.distance[lane] = near + dy * dy;
            around.is_in_band[lane] = y1[lane] >= lowest && y0[lane] <= highest;
        }
        around
    }

    /// The times when the sun can be behind a box of a node. `None`: never.
    #[inline(always)]
    pub(super) fn times(&self, around: &Around, lane: usize) -> Option<[(f32, f32); 2]> {
        if !around.is_in_band[lane] {
            return None;
        }
        if around.near[lane] == 0.0 {
            return Some(self.always());
        }
        let ([x0, _, z0], [x1, _, z1]) = (around.low.map(|lanes| lanes[lane]), around.high.map(|lanes| lanes[lane]));
        // The corners with the first and the last angle, seen from the axis.
        let (west, crosses_x) = (z0 > 0.0, z1 >= 0.0);
        let (noon, crosses_z) = (x0 > 0.0, x1 >= 0.0);
        let first = [if west || crosses_x && !noon { x1 } else { x0 }, if noon || crosses_z && west { z0 } else { z1 }];
        let last = [if west || crosses_x && noon { x0 } else { x1 }, if noon || crosses_z && !west { z1 } else { z0 }];
        let [first, last] = [first, last].map(|[x, z]| pseudo_angle(x, z));
        let (begin, end) = (self.earliest[bin(first)], self.latest[bin(last)]);
        let times = if first <= last {
            [(begin, end), NEVER]
        } else {
            // Across midnight.
            [(begin, self.hull.1), (self.hull.0, end)]
        };
        Some(times)
    }
}

/// The boxes of a node as they lie about a receiver.
#[derive(Clone, Copy, Default)]
pub(super) struct Around {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    /// Squares of distances from the axis.
    near: [f32; WIDTH],
    /// Squares of distances.
    pub(super) distance: [f32; WIDTH],
    /// Whether it reaches between the day's slopes.
    is_in_band: [bool; WIDTH],
}
