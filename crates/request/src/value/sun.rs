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
    /// Minutes between moments; `None`: 15, and hours of sun are those of all the time between them.
    pub step: Option<u32>,
}

/// An example of a whole day.
const EXAMPLE: &str = "54.98,82.9,2026-06-21+07:00,06:00-20:00/15m";

impl SunSpec {
    /// Minutes between moments.
    pub fn minutes(&self) -> u32 {
        self.step.unwrap_or(USUAL_STEP)
    }

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
        write!(f, "{latitude},{longitude},{date}{zone},{from}-{to}")?;
        step.map_or(Ok(()), |step| write!(f, "/{step}m"))
    }
}

impl FromStr for SunSpec {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<SunSpec, ValueError> {
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let [latitude, longitude, day, hours] = parts[..] else {
            return Err(ValueError::Parts {
                count: if text.trim().is_empty() { 0 } else { parts.len() },
                form: "four, LATITUDE,LONGITUDE,DATE with the offset from universal time,FROM-TO/STEP",
                example: EXAMPLE,
            });
        };
        let latitude = degrees("the latitude", latitude, 90.0, "degrees north from -90 to 90", "54.98")?;
        let longitude = degrees("the longitude", longitude, 180.0, "degrees east from -180 to 180", "82.9")?;
        let (date, offset) = day_and_offset(day)?;
        let (hours, step) = hours.split_once('/').map_or((hours, None), |(hours, step)| (hours, Some(step)));
        let (first, last) = hours.split_once('-').ok_or_else(|| {
            part("the time of day", hours, "its beginning and its end with a minus sign between them", "06:00-20:00")
        })?;
        let time = |what, text, example| {
            minute(text).ok_or_else(|| part(what, text, "hours and minutes of two digits each, up to 24:00", example))
        };
        let (from, to) = (time("the beginning", first, "06:00")?, time("the end", last, "20:00")?);
        let step = step.map(minutes).transpose()?;
        let spec = SunSpec { latitude, longitude, date, offset, from, to, step };
        if from >= to {
            return Err(ValueError::OutOfRange {
                what: "the end",
                text: last.trim().to_owned(),
                range: "a time of the same day after its beginning, up to 24:00; a night is two studies",
            });
        }
        // The date exists, in a year in which its place in the sky is known.
        SunPosition::of(latitude, longitude, &spec.moment(0.0)).map_err(|_| {
            part("the date", &spec.date(), "a day of the years from 0001 to 2999 that exists", "2026-06-21")
        })?;
        Ok(spec)
    }
}

/// What is wrong with a part of the text.
fn part(what: &'static str, text: &str, form: &'static str, example: &'static str) -> ValueError {
    ValueError::Part { what, text: text.trim().to_owned(), form, example }
}

/// Degrees of a place.
fn degrees(
    what: &'static str,
    text: &str,
    most: f64,
    form: &'static str,
    example: &'static str,
) -> Result<f64, ValueError> {
    let degrees = number(text).ok().filter(|degrees| degrees.abs() <= most);
    degrees.ok_or_else(|| part(what, text, form, example))
}

/// Year, month and day, and the minutes by which the clock is ahead of universal time.
fn day_and_offset(text: &str) -> Result<([u32; 3], i32), ValueError> {
    // The date ends where an offset begins: at a sign, of which it has two itself, or at a letter.
    let dashes = text.match_indices('-').nth(2).map(|(at, _)| at);
    let end = text.find(|letter: char| letter == '+' || letter.is_alphabetic());
    let end = dashes.into_iter().chain(end).min().unwrap_or(text.len());
    let (day, offset) = text.split_at(end);
    let date = date(day).ok_or_else(|| part("the date", day, "a day that exists, as YYYY-MM-DD", "2026-06-21"))?;
    let offset = Moment::offset_of(offset.trim()).ok_or_else(|| {
        part(
            "the offset from universal time, right after the date,",
            offset,
            "a sign, hours and minutes, up to 18:00, or Z for universal time",
            "2026-06-21+07:00",
        )
    })?;
    Ok((date, offset))
}

/// Year, month and day of `YYYY-MM-DD`, whether there is such a day or not.
fn date(text: &str) -> Option<[u32; 3]> {
    let mut parts = text.trim().split('-');
    let date = [digits(parts.next()?, 4)?, digits(parts.next()?, 2)?, digits(parts.next()?, 2)?];
    parts.next().is_none().then_some(date)
}

/// A number of so many digits.
fn digits(text: &str, count: usize) -> Option<u32> {
    (text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit())).then(|| text.parse().ok())?
}

/// The minute of the day of `HH:MM`.
fn minute(text: &str) -> Option<u32> {
    let (hour, minute) = text.trim().split_once(':')?;
    let minute = 60 * digits(hour, 2)? + digits(minute, 2).filter(|&minute| minute < 60)?;
    (minute <= DAY).then_some(minute)
}

/// The minutes of a step.
fn minutes(text: &str) -> Result<u32, ValueError> {
    let (number, unit) = number_and_unit(text);
    let unit = match unit {
        "m" => Some(1.0),
        "h" => Some(60.0),
        _ => None,
    };
    let minutes = unit.zip(number.parse::<f64>().ok()).map(|(unit, number)| unit * number);
    let whole = minutes.filter(|minutes| minutes.fract() == 0.0 && (1.0..=f64::from(DAY)).contains(minutes));
    let form = "whole minutes (m) or hours (h), from 1m to 24h";
    whole.map(|minutes| minutes as u32).ok_or_else(|| part("the step", text, form, "15m"))
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
            step: Some(15),
        };
        assert_eq!(day, expected);
        let usual = spec("54.98,82.9,2026-06-21+07:00,06:00-20:00").unwrap();
        assert_eq!((usual, usual.minutes()), (SunSpec { step: None, ..expected }, 15));
        for (text, shown) in [
            ("54.98,82.9,2026-06-21+07:00,06:00-20:00", "54.98,82.9,2026-06-21+07:00,06:00-20:00"),
            (" -33.9, 151.2 , 2026-12-21+11:00 , 00:00-24:00 / 1.5h", "-33.9,151.2,2026-12-21+11:00,00:00-24:00/90m"),
            ("1,2,2026-06-21-09:30,23:59-24:00/1m", "1,2,2026-06-21-09:30,23:59-24:00/1m"),
            ("1,2,2026-06-21+7:00,06:00-20:00/1h", "1,2,2026-06-21+07:00,06:00-20:00/60m"),
            ("1,2,2026-06-21z,00:00-12:00/24h", "1,2,2026-06-21Z,00:00-12:00/1440m"),
        ] {
            assert_eq!(spec(text).unwrap().to_string(), shown);
            assert_eq!(spec(shown), spec(text));
        }
    }

    #[test]
    fn the_part_that_is_wrong_is_named() {
        let wrong = [
            ("", "it has 0 parts between commas instead of four, LATITUDE,LONGITUDE,DATE"),
            ("1,2,2026-06-21Z", "it has 3 parts"),
            ("1,2,2026-06-21Z,06:00-20:00/15m,3", "it has 5 parts"),
            ("91,2,2026-06-21Z,06:00-20:00/15m", "the latitude cannot be `91`: write degrees north from -90 to 90"),
            ("north,2,2026-06-21Z,06:00-20:00/15m", "the latitude cannot be `north`: write degrees north"),
            ("1,181,2026-06-21Z,06:00-20:00/15m", "the longitude cannot be `181`: write degrees east from -180 to 180"),
            ("1,,2026-06-21Z,06:00-20:00/15m", "the longitude is missing: write degrees east"),
            ("1,2,2026-6-21Z,06:00-20:00/15m", "the date cannot be `2026-6-21`: write a day that exists"),
            ("1,2,21.06.2026+02:00,06:00-20:00/15m", "the date cannot be `21.06.2026`"),
            ("1,2,2026-06-31Z,06:00-20:00/15m", "the date cannot be `2026-06-31`"),
            ("1,2,9999-01-01Z,06:00-20:00/15m", "the date cannot be `9999-01-01`: write a day of the years from"),
            ("1,2,2025-02-29Z,06:00-20:00/15m", "the date cannot be `2025-02-29`"),
            ("1,2,2026-13-01Z,06:00-20:00/15m", "the date cannot be `2026-13-01`"),
            ("1,2,2026-06-2äZ,06:00-20:00/15m", "the date cannot be `2026-06-2`"),
            ("1,2,2026-06-21,06:00-20:00/15m", "the offset from universal time, right after the date, is missing"),
            (
                "1,2,2026-06-21+7,06:00-20:00/15m",
                "right after the date, cannot be `+7`: write a sign, hours and minutes",
            ),
            ("1,2,2026-06-21+19:00,06:00-20:00/15m", "cannot be `+19:00`"),
            ("1,2,2026-06-21T00:00Z,06:00-20:00/15m", "cannot be `T00:00Z`"),
            ("1,2,2026-06-21Z,06:00/15m", "the time of day cannot be `06:00`: write its beginning and its end"),
            ("1,2,2026-06-21Z,6-20/15m", "the beginning cannot be `6`: write hours and minutes"),
            ("1,2,2026-06-21Z,06:60-20:00/15m", "the beginning cannot be `06:60`"),
            ("1,2,2026-06-21Z,06:00-24:01/15m", "the end cannot be `24:01`"),
            ("1,2,2026-06-21Z,06:00-/15m", "the end is missing"),
            ("1,2,2026-06-21Z,20:00-06:00/15m", "the end must be a time of the same day after its beginning"),
            ("1,2,2026-06-21Z,06:00-06:00/15m", "but is 06:00"),
            ("1,2,2026-06-21Z,06:00-20:00/", "the step is missing"),
            (
                "1,2,2026-06-21Z,06:00-20:00/15",
                "the step cannot be `15`: write whole minutes (m) or hours (h), from 1m to 24h",
            ),
            ("1,2,2026-06-21Z,06:00-20:00/15s", "the step cannot be `15s`"),
            ("1,2,2026-06-21Z,06:00-20:00/0m", "the step cannot be `0m`"),
            ("1,2,2026-06-21Z,06:00-20:00/1.5m", "the step cannot be `1.5m`"),
            ("1,2,2026-06-21Z,06:00-20:00/25h", "the step cannot be `25h`"),
        ];
        for (text, expected) in wrong {
            let error = spec(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
        assert!(spec("1,2,2024-02-29Z,06:00-20:00").is_ok());
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
