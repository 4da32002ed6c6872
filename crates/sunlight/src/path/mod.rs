//! The sun's way over a day.
//!
//! 1. Reda and Andreas' algorithm (*Solar Position Algorithm for Solar Radiation Applications*, 2004) gives the true sun at the points of a table, and
//!    its formula (42) the refraction of 1013.25 hPa and 15 °C. Below −1.8° the refraction stays as it is there: the algorithm's own switch at −.83° is a
//!    jump, of which no smooth way could be made.
//! 2. Between them the direction is a cubic Hermite polynomial, with slopes from five points. The error is below 4·10⁻⁸ rad.
//! 3. The circle s(θ) = C + A cos θ + B sin θ, θ = 2π (t − noon) / 86400, is fitted by least squares to the way above the horizon. How far the way
//!    leaves it at most is known ([`SunPath::deviation`]).

mod place;

use glam::{DMat3, DVec3};

pub use place::{Place, PlaceError};

use crate::samples::by_samples;
use crate::spans::Spans;
use crate::time::{DAY, RATE};

/// Seconds between two points of the table.
const STEP: f64 = 120.0;
/// The table goes on for so many points beyond half a day before and after noon: Newton steps may leave the day, and slopes need two.
const BEYOND: usize = 20;
/// Points at which the circle is fitted, and compared.
const FITTED: usize = 400;
const COMPARED: usize = 2000;

/// The sun's way from one midnight of the sun to the next, as far as it is above the horizon and in the day that is asked for.
#[derive(Clone, Debug)]
pub struct SunPath {
    /// The time of the first point of the table.
    begin: f64,
    /// Direction, and its change in [`STEP`], for each point.
    points: Vec<[DVec3; 2]>,
    /// When the sun is highest.
    pub(crate) noon: f64,
    /// From the first to the last moment above the horizon.
    pub(crate) hull: (f64, f64),
    /// When it is above the horizon.
    pub(crate) up: Spans,
    /// C, A and B of the circle.
    pub(crate) circle: [DVec3; 3],
    /// The largest distance from the circle.
    pub(crate) deviation: f64,
    /// To the axes of the equator.
    axes: DMat3,
}

/// The sun's ways on a day at a place: one for each noon of the sun whose sun shines on the day. `east_up_south` has as columns what these are in the
/// scene. Without a sun there are none.
///
/// # Errors
/// [`PlaceError`] if place or date do not exist.
pub fn arcs_of_day(place: &Place, date: [u32; 3], east_up_south: DMat3) -> Result<Vec<SunPath>, PlaceError> {
    let sky = place::Sky::new(place, date, east_up_south)?;
    let mean_noon = sky.mean_noon();
    let mut arcs = Vec::new();
    for day in [-1.0, 0.0, 1.0] {
        let center = mean_noon + day * DAY;
        let window = ((center - 0.5 * DAY).max(0.0), (center + 0.5 * DAY).min(DAY));
        if window.0 < window.1
            && let Some(path) = SunPath::new(&sky, center, window)?
        {
            arcs.push(path);
        }
    }
    Ok(arcs)
}

impl SunPath {
    /// Around a noon, within `window`; `None` if the sun is not above the horizon then.
    fn new(sky: &place::Sky, center: f64, window: (f64, f64)) -> Result<Option<SunPath>, PlaceError> {
        let half = (0.5 * DAY / STEP) as usize + BEYOND;
        let begin = center - half as f64 * STEP;
        let directions: Vec<DVec3> =
            (0..=2 * half).map(|point| sky.direction(begin + point as f64 * STEP)).collect::<Result<_, _>>()?;
        let slope = |at: usize| {
            // At the ends, which no time of the day reaches, the slope is that of the neighbour.
            let at = at.clamp(2, directions.len() - 3);
            (8.0 * (directions[at + 1] - directions[at - 1]) - (directions[at + 2] - directions[at - 2])) / 12.0
        };
        let points = directions.iter().enumerate().map(|(at, &direction)| [direction, slope(at)]).collect();
        let mut path = SunPath {
            begin,
            points,
            noon: center,
            hull: window,
            up: Spans::default(),
            circle: [DVec3::ZERO; 3],
            deviation: f64::INFINITY,
            axes: sky.axes(),
        };
        path.noon = path.highest(sky.up(), center);
        path.up = by_samples(|time| path.at(time), path.hull, sky.up());
        let (Some(first), Some(last)) = (path.up.list().first().copied(), path.up.list().last().copied()) else {
            return Ok(None);
        };
        path.hull = (first.0, last.1);
        path.fit();
        Ok(Some(path))
    }

    /// When the sun is highest, about `center`: by thirds.
    fn highest(&self, up: DVec3, center: f64) -> f64 {
        let (mut low, mut high) = (center - 3000.0, center + 3000.0);
        for _ in 0..60 {
            let third = (high - low) / 3.0;
            let height = |time: f64| self.at(time).0.dot(up);
            if height(low + third) < height(high - third) { low += third } else { high -= third }
        }
        0.5 * (low + high)
    }

    /// The sun's direction at a time, and its change in a second.
    #[inline]
    pub fn at(&self, time: f64) -> (DVec3, DVec3) {
        let place = (time - self.begin) * (1.0 / STEP);
        let index = (place.max(0.0) as usize).min(self.points.len() - 2);
        let along = place - index as f64;
        let ([p, dp], [q, dq]) = (self.points[index], self.points[index + 1]);
        let rise = q - p;
        let cubic = dp + dq - 2.0 * rise;
        let square = rise - dp - cubic;
        let direction = p + along * (dp + along * (square + along * cubic));
        (direction, (dp + along * (2.0 * square + along * (3.0 * cubic))) * (1.0 / STEP))
    }

    /// m·s at a time, and its change in a second: the same polynomial for one number instead of three.
    #[inline]
    pub(crate) fn side(&self, m: DVec3, time: f64) -> (f64, f64) {
        let place = (time - self.begin) * (1.0 / STEP);
        let index = (place.max(0.0) as usize).min(self.points.len() - 2);
        let along = place - index as f64;
        let [p, dp] = self.points[index].map(|part| m.dot(part));
        let [q, dq] = self.points[index + 1].map(|part| m.dot(part));
        let rise = q - p;
        let cubic = dp + dq - 2.0 * rise;
        let square = rise - dp - cubic;
        let value = p + along * (dp + along * (square + along * cubic));
        (value, (dp + along * (2.0 * square + along * (3.0 * cubic))) * (1.0 / STEP))
    }

    /// From the scene's axes to those of the equator: to the meridian, to the pole, to the west. They are the same on all days of a place.
    pub fn axes(&self) -> DMat3 {
        self.axes
    }

    /// From the first to the last moment above the horizon.
    pub fn hull(&self) -> (f64, f64) {
        self.hull
    }

    /// When it is above the horizon.
    pub fn up(&self) -> &Spans {
        &self.up
    }

    /// The largest distance between the sun's way and the circle.
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// 1, cos θ and sin θ.
    fn angles(&self, time: f64) -> [f64; 3] {
        let (sin, cos) = (RATE * (time - self.noon)).sin_cos();
        [1.0, cos, sin]
    }

    fn times(&self, count: usize) -> impl Iterator<Item = f64> + use<> {
        let (first, last) = self.hull;
        (0..=count).map(move |step| first + (last - first) * step as f64 / count as f64)
    }

    /// Fits the circle by least squares.
    fn fit(&mut self) {
        let (mut matrix, mut right) = ([[0.0; 3]; 3], [DVec3::ZERO; 3]);
        for time in self.times(FITTED) {
            let (angles, direction) = (self.angles(time), self.at(time).0);
            for row in 0..3 {
                for column in 0..3 {
                    matrix[row][column] += angles[row] * angles[column];
                }
                right[row] += angles[row] * direction;
            }
        }
        self.circle = solved(matrix, right);
        let [c, a, b] = self.circle;
        let off = |time: f64| {
            let [_, cos, sin] = self.angles(time);
            (c + a * cos + b * sin - self.at(time).0).length()
        };
        let worst = self.times(COMPARED).map(off).fold(0.0, f64::max);
        // Between the points at which it is compared it is hardly more.
        self.deviation = 1.02 * worst + 1e-9;
    }
}

/// The solution of three linear equations, by elimination with pivots.
fn solved(mut matrix: [[f64; 3]; 3], mut right: [DVec3; 3]) -> [DVec3; 3] {
    for at in 0..3 {
        let pivot = (at..3).max_by(|&a, &b| matrix[a][at].abs().total_cmp(&matrix[b][at].abs())).unwrap_or(at);
        matrix.swap(at, pivot);
        right.swap(at, pivot);
        for other in (0..3).filter(|&other| other != at) {
            let factor = matrix[other][at] / matrix[at][at];
            let row = matrix[at];
            matrix[other].iter_mut().zip(row).for_each(|(value, pivot)| *value -= factor * pivot);
            let value = right[at];
            right[other] -= factor * value;
        }
    }
    [0, 1, 2].map(|at| right[at] / matrix[at][at])
}
