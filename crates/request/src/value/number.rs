//! Numbers, and lists of them.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use super::ValueError;

/// A number in the range of single precision.
pub(super) fn number(text: &str) -> Result<f64, ValueError> {
    let text = text.trim();
    let number = text.parse().ok().filter(|number: &f64| (*number as f32).is_finite());
    number.ok_or_else(|| ValueError::NotANumber { text: text.to_owned() })
}

/// A number of at least 0.
pub(super) fn not_negative(what: &'static str, text: &str) -> Result<f64, ValueError> {
    let value = number(text)?;
    if value >= 0.0 {
        return Ok(value);
    }
    Err(ValueError::OutOfRange { what, text: text.trim().to_owned(), range: "0 or more" })
}

/// The leading number of a text, digits and points and perhaps an exponent, and the unit after it.
pub fn number_and_unit(text: &str) -> (&str, &str) {
    let text = text.trim();
    let digits = |from: usize| {
        let end = text[from..].find(|c: char| !c.is_ascii_digit() && c != '.');
        end.map_or(text.len(), |end| from + end)
    };
    let mantissa = digits(0);
    let sign = text[mantissa..].strip_prefix(['e', 'E']).map(|rest| rest.starts_with(['+', '-']));
    let exponent = sign.map(|has_sign| mantissa + 1 + usize::from(has_sign)).filter(|&from| digits(from) > from);
    let (number, unit) = text.split_at(exponent.map_or(mantissa, digits));
    (number, unit.trim())
}

/// Three numbers; `None` if there are more or fewer.
pub(super) fn triple(text: &str) -> Result<Option<DVec3>, ValueError> {
    let parts: Vec<&str> = text.split(',').collect();
    let Ok(parts) = <[&str; 3]>::try_from(parts) else { return Ok(None) };
    let [x, y, z] = parts.map(number);
    Ok(Some(DVec3::new(x?, y?, z?)))
}

/// A number above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Positive(pub f32);

impl fmt::Display for Positive {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for Positive {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Positive, ValueError> {
        let value = number(text)? as f32;
        if value > 0.0 {
            return Ok(Positive(value));
        }
        Err(ValueError::OutOfRange { what: "the number", text: text.to_owned(), range: "above 0" })
    }
}

/// A threshold on a measure: a number of at least 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound(pub f64);

impl FromStr for Bound {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Bound, ValueError> {
        not_negative("the threshold", text).map(Bound)
    }
}

/// Exposure of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// Chosen for the image.
    Auto,
    /// A number of stops.
    Stops(f32),
}

/// Beyond this, single precision cannot represent the brightness.
const MAX_STOPS: f32 = 100.0;

impl fmt::Display for Exposure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Exposure::Auto => f.write_str("auto"),
            Exposure::Stops(stops) => stops.fmt(f),
        }
    }
}

impl FromStr for Exposure {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Exposure, ValueError> {
        if text == "auto" {
            return Ok(Exposure::Auto);
        }
        let stops = number(text)? as f32;
        if stops.abs() <= MAX_STOPS {
            return Ok(Exposure::Stops(stops));
        }
        Err(ValueError::OutOfRange {
            what: "the exposure",
            text: text.trim().to_owned(),
            range: "between -100 and 100 stops",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!("0.25".parse(), Ok(Positive(0.25)));
        assert_eq!("0".parse(), Ok(Bound(0.0)));
        for text in ["", "x", "nan", "inf", "1e39", "1e-60", "0", "-1"] {
            assert!(text.parse::<Positive>().is_err(), "{text}");
        }
        assert!("-0.1".parse::<Bound>().is_err());
    }

    #[test]
    fn an_exposure_is_a_number_of_stops_or_auto() {
        assert_eq!(["auto".parse(), "-2.5".parse()], [Ok(Exposure::Auto), Ok(Exposure::Stops(-2.5))]);
        assert_eq!(
            "1e9".parse::<Exposure>().unwrap_err().to_string(),
            "the exposure must be between -100 and 100 stops, but is 1e9"
        );
    }

    #[test]
    fn a_triple_has_three_numbers() {
        assert_eq!(triple("1, -2,3e2"), Ok(Some(DVec3::new(1.0, -2.0, 300.0))));
        assert_eq!(triple("1,2"), Ok(None));
        assert!(triple("1,,2").is_err());
    }
}
