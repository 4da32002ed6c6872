//! Time budgets.

use std::str::FromStr;
use std::time::Duration;

use lightmesh::request::value::{ValueError, number_and_unit};

/// A time above 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Budget(pub(crate) Duration);

const FORM: ValueError = ValueError::Form { form: "a number of seconds, or one with s, m or h", example: "15m" };
/// More than anybody would wait for.
const MAX_SECONDS: f64 = 1e7;

impl FromStr for Budget {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Budget, ValueError> {
        let (number, unit) = number_and_unit(text);
        let unit = match unit {
            "" | "s" => 1.0,
            "m" => 60.0,
            "h" => 3600.0,
            _ => return Err(FORM),
        };
        let seconds = unit * number.parse::<f64>().map_err(|_| FORM)?;
        if !(0.0..=MAX_SECONDS).contains(&seconds) {
            return Err(FORM);
        }
        // Less than a nanosecond is no time.
        let time = Duration::from_secs_f64(seconds);
        if time.is_zero() { Err(FORM) } else { Ok(Budget(time)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_units() {
        let seconds = |text: &str| text.parse().map(|Budget(time)| time.as_secs_f64());
        assert_eq!([seconds("90"), seconds("90s"), seconds("1.5 m")], [Ok(90.0), Ok(90.0), Ok(90.0)]);
        assert_eq!([seconds("2h"), seconds("1E+3"), seconds("15e-1m")], [Ok(7200.0), Ok(1000.0), Ok(90.0)]);
        for text in ["", "m", "0", "-1m", "1d", "1e9", "1.2.3s", "99999999h", "0.0000000001"] {
            assert!(text.parse::<Budget>().is_err(), "{text}");
        }
    }
}
