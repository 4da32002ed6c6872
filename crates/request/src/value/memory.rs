//! Memory sizes.

use std::fmt;
use std::str::FromStr;

use super::ValueError;
use super::number::number_and_unit;

/// A number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByteSize(pub u64);

const FORM: ValueError = ValueError::Form {
    form: "a number of bytes above 0, alone or with K, M, G, T, KiB, MiB, GiB, TiB, kB, MB, GB or TB",
    example: "512M",
};

impl fmt::Display for ByteSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for ByteSize {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<ByteSize, ValueError> {
        let (number, unit) = number_and_unit(text);
        let unit = unit_bytes(unit).ok_or(FORM)?;
        let number: f64 = number.parse().map_err(|_| FORM)?;
        let bytes = number * unit as f64;
        if bytes >= 1.0 && bytes < u64::MAX as f64 { Ok(ByteSize(bytes as u64)) } else { Err(FORM) }
    }
}

fn unit_bytes(unit: &str) -> Option<u64> {
    let lower = unit.to_ascii_lowercase();
    let mut rest = lower.chars();
    let power = match rest.next() {
        Some('k') => 1,
        Some('m') => 2,
        Some('g') => 3,
        Some('t') => 4,
        _ => return matches!(lower.as_str(), "" | "b").then_some(1),
    };
    match rest.as_str() {
        "" | "ib" => Some(1024_u64.pow(power)),
        "b" => Some(1000_u64.pow(power)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known() {
        let bytes = |text: &str| text.parse().map(|ByteSize(bytes)| bytes);
        assert_eq!(bytes("4096"), Ok(4096));
        assert_eq!(bytes("256M"), Ok(256 << 20));
        assert_eq!(bytes("1.5 GiB"), Ok(3 << 29));
        assert_eq!(bytes("2kB"), Ok(2000));
        assert_eq!(bytes("1t"), Ok(1 << 40));
        assert_eq!(bytes("12 B"), Ok(12));
    }

    #[test]
    fn what_is_no_size_is_refused() {
        for text in ["", "M", "-1M", "1.2.3M", "5 apples", "0", "0.1", "1e-3", "1e", "99999999T", "10µB"] {
            assert!(text.parse::<ByteSize>().is_err(), "{text}");
        }
    }
}
