//! Where the sun stands: by place and time, through NREL's solar position algorithm.

use std::f32::consts::PI;
use std::str::FromStr;

use glam::Vec3;
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, RefractionCorrection, SolarPositions, delta_t};

use super::directions::{frame, from_angles};
use super::panorama::Environment;
use super::sun::{SUN_ANGLE, Sun};
use crate::{Light, LightError, Up};

/// Where the sun stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Angle above the horizon, degrees.
    pub elevation: f64,
    /// Clockwise from north, degrees.
    pub azimuth: f64,
}

/// A date and a time of day, with the difference from universal time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Year, month and day.
    pub date: [u32; 3],
    /// Hour and minute.
    pub time: [u32; 2],
    /// Second.
    pub second: f64,
    /// Minutes by which the clock is ahead of universal time.
    pub offset: i32,
}

/// Why there is no position of the sun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SunError {
    /// Not a date with a time.
    #[error(
        "`{text}` is not a date with a time and an offset from universal time; write 2026-06-21T15:00+02:00, or Z for universal time"
    )]
    Moment {
        /// What was given.
        text: String,
    },
    /// Latitude, longitude or date out of range.
    #[error(
        "no sun at latitude {latitude:?}, longitude {longitude:?} then ({problem}); write degrees, -90 to 90 and -180 to 180"
    )]
    Place {
        /// Degrees north.
        latitude: f64,
        /// Degrees east.
        longitude: f64,
        /// What is wrong.
        problem: String,
    },
}

impl SunPosition {
    /// As seen from a place, `latitude` in degrees north and `longitude` in degrees east, at sea level, with the refraction of an ordinary
    /// atmosphere.
    ///
    /// # Errors
    /// [`SunError::Place`] if the place or the date does not exist.
    pub fn of(latitude: f64, longitude: f64, moment: &Moment) -> Result<SunPosition, SunError> {
        let place =
            |error: solar_positioning::Error| SunError::Place { latitude, longitude, problem: error.to_string() };
        let [year, month, day] = moment.date;
        let [hour, minute] = moment.time;
        let delta = delta_t::estimate_from_date(year as i32, month).map_err(place)?;
        let there = JulianDate::from_utc(year as i32, month, day, hour, minute, moment.second, delta).map_err(place)?;
        let days = f64::from(moment.offset) / (24.0 * 60.0);
        let universal = JulianDate::new(there.julian_date() - days, delta).map_err(place)?;
        let refraction = Some(RefractionCorrection::standard());
        let position = SolarPositions::new()
            .at_from_julian(universal, Location { latitude, longitude }, 0.0, refraction)
            .map_err(place)?;
        Ok(SunPosition { elevation: position.elevation_angle(), azimuth: position.azimuth() })
    }

    /// The unit vector to the sun in a scene in which `up` is up, and north where it usually is.
    pub(super) fn direction(&self, up: Up) -> Vec3 {
        from_angles(frame(up), self.azimuth.to_radians() as f32, self.elevation.to_radians() as f32)
    }

    /// The sun alone, without a sky: where and as wide as the light of a [`Sky`](super::Sky) with the same `north`, but of intensity 1.
    ///
    /// # Errors
    /// If it has no direction.
    pub fn light(&self, up: Up, north: f32) -> Result<Light, LightError> {
        let sun = Sun::new(self.direction(up), SUN_ANGLE, Vec3::splat(PI));
        // The same turn as that of a whole sky.
        let turned = Environment::new("sun", [1; 2], vec![[0.0; 3]], up).with_sun(Some(sun)).turned(north);
        turned.sun().unwrap_or(&sun).light()
    }
}

impl Moment {
    /// The minutes by which a clock is ahead of universal time: of `Z` or `±HH:MM`, up to 18 hours.
    pub fn offset_of(text: &str) -> Option<i32> {
        if matches!(text, "Z" | "z") {
            return Some(0);
        }
        let clock = text.strip_prefix(['+', '-'])?;
        let [hours, minutes] = numbers::<2>(clock, ':')?;
        let is_short = clock.split(':').all(|part| part.len() <= 2);
        let offset = (60 * hours + minutes) as i32;
        let is_offset = is_short && minutes < 60 && offset <= 18 * 60;
        is_offset.then_some(if text.starts_with('-') { -offset } else { offset })
    }
}

impl FromStr for Moment {
    type Err = SunError;

    fn from_str(text: &str) -> Result<Moment, SunError> {
        moment(text.trim()).ok_or_else(|| SunError::Moment { text: text.chars().take(40).collect() })
    }
}

/// `YYYY-MM-DDTHH:MM[:SS](Z|±HH:MM)`, also with a space in place of the T.
fn moment(text: &str) -> Option<Moment> {
    let (date, rest) = text.split_once(['T', 't', ' '])?;
    let date = numbers::<3>(date, '-')?;
    let at = rest.find(['Z', 'z', '+', '-'])?;
    let (clock, zone) = rest.split_at(at);
    let [hour, minute] = numbers::<2>(clock.get(..5)?, ':')?;
    let second = match &clock[5..] {
        "" => 0.0,
        seconds => seconds.strip_prefix(':')?.parse::<f64>().ok().filter(|second| (0.0..60.0).contains(second))?,
    };
    let offset = Moment::offset_of(zone)?;
    (hour < 24 && minute < 60).then_some(Moment { date, time: [hour, minute], second, offset })
}

/// Numbers of digits alone.
fn numbers<const N: usize>(text: &str, between: char) -> Option<[u32; N]> {
    let parts: Vec<u32> = text
        .split(between)
        .map(|part| part.parse().ok().filter(|_| part.len() <= 4 && part.bytes().all(|byte| byte.is_ascii_digit())))
        .collect::<Option<_>>()?;
    parts.try_into().ok()
}
