//! Where and when: a place on Earth with its clock, and where the sun stands there.

use glam::{DMat3, DVec3};
use solar_positioning::time::JulianDate;
use solar_positioning::{Location, SolarPositions, delta_t};

use crate::time::DAY;

/// The lowest elevation, in degrees, whose refraction is computed.
const LOWEST: f64 = -1.8;
/// Pressure in hPa and temperature in °C.
const PRESSURE: f64 = 1013.25;
const TEMPERATURE: f64 = 15.0;

/// A place with its clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Degrees north.
    pub latitude: f64,
    /// Degrees east.
    pub longitude: f64,
    /// Minutes by which the clock is ahead of universal time.
    pub offset: i32,
    /// Whether the air bends light.
    pub refraction: bool,
}

/// Why there is no sun.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "no sun at latitude {latitude:?}, longitude {longitude:?} on {}-{:02}-{:02} ({problem}); write degrees, -90 to 90 and -180 to 180, and a date",
    date[0], date[1], date[2]
)]
pub struct PlaceError {
    /// Degrees north.
    pub latitude: f64,
    /// Degrees east.
    pub longitude: f64,
    /// Year, month and day.
    pub date: [u32; 3],
    /// What is wrong.
    pub problem: String,
}

/// The sky of a place on a day.
pub(super) struct Sky {
    place: Place,
    date: [u32; 3],
    /// The julian date of the clock's midnight.
    midnight: f64,
    /// Seconds between terrestrial and universal time.
    delta: f64,
    east_up_south: DMat3,
}

impl Sky {
    pub(super) fn new(place: &Place, date: [u32; 3], east_up_south: DMat3) -> Result<Sky, PlaceError> {
        let mut sky = Sky { place: *place, date, midnight: 0.0, delta: 0.0, east_up_south };
        let [year, month, day] = date;
        sky.delta = delta_t::estimate_from_date(year as i32, month).map_err(|error| sky.wrong(&error))?;
        let universal = JulianDate::from_utc(year as i32, month, day, 0, 0, 0.0, sky.delta);
        let universal = universal.map_err(|error| sky.wrong(&error))?;
        sky.midnight = universal.julian_date() - f64::from(place.offset) / (24.0 * 60.0);
        // That the place exists is known before its noon is asked for.
        sky.position(0.0)?;
        Ok(sky)
    }

    fn wrong(&self, problem: &solar_positioning::Error) -> PlaceError {
        let Place { latitude, longitude, .. } = self.place;
        PlaceError { latitude, longitude, date: self.date, problem: problem.to_string() }
    }

    /// The mean sun's noon, in seconds after midnight.
    pub(super) fn mean_noon(&self) -> f64 {
        let ahead = f64::from(self.place.offset) * 60.0 - self.place.longitude / 360.0 * DAY;
        (0.5 * DAY + ahead).rem_euclid(DAY)
    }

    /// Azimuth and true elevation at a time, in degrees.
    fn position(&self, time: f64) -> Result<(f64, f64), PlaceError> {
        let at = || -> Result<_, solar_positioning::Error> {
            let date = JulianDate::new(self.midnight + time / DAY, self.delta)?;
            let Place { latitude, longitude, .. } = self.place;
            SolarPositions::new().at_from_julian(date, Location { latitude, longitude }, 0.0, None)
        };
        let position = at().map_err(|error| self.wrong(&error))?;
        Ok((position.azimuth(), 90.0 - position.zenith_angle()))
    }

    /// The apparent direction at a time.
    pub(super) fn direction(&self, time: f64) -> Result<DVec3, PlaceError> {
        let (azimuth, elevation) = self.position(time)?;
        let bent = if self.place.refraction { refraction(elevation) } else { 0.0 };
        let (sin_azimuth, cos_azimuth) = azimuth.to_radians().sin_cos();
        let (sin, cos) = (elevation + bent).to_radians().sin_cos();
        Ok(self.east_up_south * DVec3::new(sin_azimuth * cos, sin, -cos_azimuth * cos))
    }

    /// What is up.
    pub(super) fn up(&self) -> DVec3 {
        self.east_up_south * DVec3::Y
    }

    /// To the axes of the equator: meridian, pole, west.
    pub(super) fn axes(&self) -> DMat3 {
        let (sin, cos) = self.place.latitude.to_radians().sin_cos();
        let (meridian, pole) = (DVec3::new(0.0, cos, sin), DVec3::new(0.0, sin, -cos));
        DMat3::from_cols(meridian, pole, -DVec3::X).transpose() * self.east_up_south.transpose()
    }
}

/// How much higher the sun seems to stand than it does at a true elevation, in degrees: formula (42) of Reda and Andreas.
fn refraction(elevation: f64) -> f64 {
    let elevation = elevation.max(LOWEST);
    let air = (PRESSURE / 1010.0) * (283.0 / (273.0 + TEMPERATURE));
    air * 1.02 / (60.0 * (elevation + 10.3 / (elevation + 5.11)).to_radians().tan())
}
