//! `--sun LAT,LON,DATE,FROM-TO/STEP`: hours of a day at a place.

use std::fmt;
use std::str::FromStr;

use lightmesh_scene::{Moment, SunPosition};

use super::ValueError;
use super::number::{number, number_and_unit};

/// Minutes of a day.
const DAY: u32 = 24 * 60;
/// Minutes between moments if nothing says so.
const USUAL_STEP: u32 = 15;

/// Hours of a day at a place, in steps. The clock differs from universal time by the same offset all day; daylight saving is not modelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunSpec {
    /// Degrees north.
    pub latitude: f64,
    /// Degrees east.
    pub longitude: f64,
    /// Year, month and day.
    pub date: [u32; 3],
    /// Minutes by which the clock is ahead of universal time.
    pub offset: i32,
    /// The first minute of the day.
    pub from: u32,
    /// The last one, up to 24 hours.
    pub to: u32,
    /// Minutes between moments.
    pub step: u32,
}

const FORM: ValueError = ValueError::Form {
    form: "LATITUDE,LONGITUDE,DATE with its offset from universal time or Z,FROM-TO/STEP in minutes (m) or hours (h)",
    example: "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m",
};

impl SunSpec {
    /// A minute of the day.
    pub fn moment(&self, minute: f64) -> Moment {
        // The end of the day is not a time of it: it is a minute before it in a zone that is a minute behind.
        let late = u32::from(minute >= f64::from(DAY));
        let minute = minute - f64::from(late);
        let whole = minute as u32;
        Moment {
            date: self.date,
            time: [whole / 60, whole % 60],
            second: 60.0 * (minute - f64::from(whole)),
            offset: self.offset - late as i32,
        }
    }

    /// The date, as typed.
    pub fn date(&self) -> String {
        let [year, month, day] = self.date;
        format!("{year:04}-{month:02}-{day:02}")
    }

    /// The offset from universal time, as typed.
    pub fn zone(&self) -> String {
        let (sign, minutes) = (if self.offset < 0 { '-' } else { '+' }, self.offset.unsigned_abs());
        if minutes == 0 { "Z".to_owned() } else { format!("{sign}{}", clock(minutes)) }
    }
}

/// A minute of the day as `HH:MM`.
pub fn clock(minute: u32) -> String {
    format!("{:02}:{:02}", minute / 60, minute % 60)
}

impl fmt::Display for SunSpec {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let SunSpec { latitude, longitude, from, to, step, .. } = *self;
        let (date, zone, from, to) = (self.date(), self.zone(), clock(from), clock(to));
        write!(f, "{latitude},{longitude},{date}{zone},{from}-{to}/{step}m")
    }
}

impl FromStr for SunSpec {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<SunSpec, ValueError> {
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let [latitude, longitude, day, hours] = parts[..] else { return Err(FORM) };
        let (latitude, longitude) = (number(latitude)?, number(longitude)?);
        let (date, zone) = day.split_at_checked("2026-06-21".len()).ok_or(FORM)?;
        let midnight: Moment = format!("{date}T00:00{zone}").parse().map_err(|_| FORM)?;
        let (hours, step) = hours.split_once('/').map_or((hours, None), |(hours, step)| (hours, Some(step)));
        let (first, last) = hours.split_once('-').ok_or(FORM)?;
        let (from, to) = (minute(first).ok_or(FORM)?, minute(last).ok_or(FORM)?);
        let step = step.map_or(Ok(USUAL_STEP), minutes)?;
        let spec = SunSpec { latitude, longitude, date: midnight.date, offset: midnight.offset, from, to, step };
        if from >= to {
            return Err(ValueError::OutOfRange {
                what: "the end",
                text: last.trim().to_owned(),
                range: "a time of the same day after its beginning, up to 24:00; a night is two studies",
            });
        }
        // The place and the date exist.
        SunPosition::of(latitude, longitude, &spec.moment(0.0)).map_err(|problem| ValueError::Sun { problem })?;
        Ok(spec)
    }
}

/// The minute of the day of `HH:MM`.
fn minute(text: &str) -> Option<u32> {
    let (hour, minute) = text.trim().split_once(':')?;
    let two = |text: &str| {
        (text.len() == 2 && text.bytes().all(|byte| byte.is_ascii_digit())).then(|| text.parse::<u32>().ok())?
    };
    let minute = Some(60 * two(hour)? + two(minute).filter(|&minute| minute < 60)?);
    minute.filter(|&minute| minute <= DAY)
}

/// The minutes of a step.
fn minutes(text: &str) -> Result<u32, ValueError> {
    let (number, unit) = number_and_unit(text);
    let unit = match unit {
        "m" => 1.0,
        "h" => 60.0,
        _ => return Err(FORM),
    };
    let minutes = unit * number.parse::<f64>().map_err(|_| FORM)?;
    if minutes.fract() == 0.0 && (1.0..=f64::from(DAY)).contains(&minutes) {
        return Ok(minutes as u32);
    }
    let text = text.trim().to_owned();
    Err(ValueError::OutOfRange { what: "the step", text, range: "whole minutes, from 1m to 24h" })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(text: &str) -> Result<SunSpec, String> {
        text.parse().map_err(|error: ValueError| error.to_string())
    }

    #[test]
    fn a_day_is_read_as_it_is_shown() {
        let day = spec("54.98,82.9,2026-06-21+07:00,06:00-20:00/15m").unwrap();
        let expected = SunSpec {
            latitude: 54.98,
            longitude: 82.9,
            date: [2026, 6, 21],
            offset: 420,
            from: 360,
            to: 1200,
            step: 15,
        };
        assert_eq!(day, expected);
        for (text, shown) in [
            ("54.98,82.9,2026-06-21+07:00,06:00-20:00", "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m"),
            (" -33.9, 151.2 , 2026-12-21+11:00 , 00:00-24:00 / 1.5h", "-33.9,151.2,2026-12-21+11:00,00:00-24:00/90m"),
            ("1,2,2026-06-21-09:30,23:59-24:00/1m", "1,2,2026-06-21-09:30,23:59-24:00/1m"),
            ("1,2,2026-06-21z,00:00-12:00/24h", "1,2,2026-06-21Z,00:00-12:00/1440m"),
        ] {
            assert_eq!(spec(text).unwrap().to_string(), shown);
            assert_eq!(spec(shown), spec(text));
        }
    }

    #[test]
    fn what_is_no_day_says_what_is() {
        for text in [
            "",
            "1,2,2026-06-21Z",
            "1,2,2026-06-21Z,06:00-20:00/15m,3",
            "1,2,2026-06-21,06:00-20:00/15m",
            "1,2,2026-6-21Z,06:00-20:00/15m",
            "1,2,2026-06-21+7,06:00-20:00/15m",
            "1,2,2026-06-21+19:00,06:00-20:00/15m",
            "1,2,2026-06-21Z,6-20/15m",
            "1,2,2026-06-21Z,06:00/15m",
            "1,2,2026-06-21Z,06:60-20:00/15m",
            "1,2,2026-06-21Z,06:00-24:01/15m",
            "1,2,2026-06-21Z,06:00-20:00/15",
            "1,2,2026-06-21Z,06:00-20:00/15s",
            "1,2,2026-06-2äZ,06:00-20:00/15m",
        ] {
            let error = spec(text).unwrap_err();
            assert!(error.contains("for instance 54.98,82.9,2026-06-21+07:00,06:00-20:00/15m"), "{text}: {error}");
        }
        for (text, expected) in [
            ("91,2,2026-06-21Z,06:00-20:00/15m", "-90 to 90"),
            ("1,181,2026-06-21Z,06:00-20:00/15m", "-180 to 180"),
            ("1,2,2026-06-31Z,06:00-20:00/15m", "no sun at"),
            ("north,2,2026-06-21Z,06:00-20:00/15m", "`north` is not a valid number"),
            ("1,2,2026-06-21Z,20:00-06:00/15m", "the end must be a time of the same day after its beginning"),
            ("1,2,2026-06-21Z,06:00-06:00/15m", "but is 06:00"),
            ("1,2,2026-06-21Z,06:00-20:00/0m", "the step must be whole minutes, from 1m to 24h, but is 0m"),
            ("1,2,2026-06-21Z,06:00-20:00/1.5m", "but is 1.5m"),
            ("1,2,2026-06-21Z,06:00-20:00/25h", "but is 25h"),
        ] {
            let error = spec(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }

    #[test]
    fn the_end_of_a_day_is_the_beginning_of_the_next() {
        let at = |text: &str, minute| {
            let spec = spec(text).unwrap();
            SunPosition::of(spec.latitude, spec.longitude, &spec.moment(minute)).unwrap()
        };
        let end = at("1,2,2026-06-30+02:00,00:00-24:00", 1440.0);
        let begin = at("1,2,2026-07-01+02:00,00:00-24:00", 0.0);
        assert!((end.elevation - begin.elevation).abs() < 1e-6 && (end.azimuth - begin.azimuth).abs() < 1e-6);
        let moment = spec("1,2,2026-06-30Z,00:00-24:00").unwrap().moment(61.5);
        assert_eq!((moment.time, moment.second), ([1, 1], 30.0));
    }
}
