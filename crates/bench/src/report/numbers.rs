//! Human-readable numbers.

/// Separator of groups of three digits: narrow and non-breaking.
const GROUP: char = '\u{202f}';

/// `digits` significant digits without an exponent, with grouped thousands: 0.0282, 2.82, 551, 12 345.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "—".to_owned() };
    }
    // Rounded first, so that 9.996 has two digits before the decimal point.
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    let before = rounded.abs().log10().floor() as i32 + 1;
    let after = usize::try_from(digits as i32 - before).unwrap_or(0);
    grouped(&format!("{rounded:.after$}"))
}

/// Three significant digits; below a ten-thousandth, with two and an exponent: 0.0341, 5.9e-7.
pub(crate) fn small(error: f64) -> String {
    const LEAST: f64 = 1e-4;
    if error != 0.0 && error.abs() < LEAST { format!("{error:.1e}") } else { significant(error, 3) }
}

/// Seconds as milliseconds, as in [`small`].
pub(crate) fn milliseconds(seconds: f64) -> String {
    small(1e3 * seconds)
}

/// An integer.
pub(crate) fn count(value: f64) -> String {
    grouped(&format!("{value:.0}"))
}

/// A ratio, as in 2.4×.
pub(crate) fn ratio(value: f64) -> String {
    format!("{}×", significant(value, if value < 10.0 { 2 } else { 3 }))
}

/// A share, as in 12.3 %.
pub(crate) fn percent(share: f64) -> String {
    format!("{}\u{a0}%", significant(100.0 * share, 3))
}

/// Bytes in binary units.
pub(crate) fn bytes(value: f64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let steps = if value < 1.0 { 0 } else { ((value.log2() / 10.0) as usize).min(UNITS.len() - 1) };
    format!("{}\u{a0}{}", significant(value / 1024_f64.powi(steps as i32), 3), UNITS[steps])
}

/// A setting, in its shortest exact form.
pub(crate) fn setting(value: f64) -> String {
    let text = format!("{value}");
    if text.len() > 8 { significant(value, 4) } else { text }
}

/// Groups digits from ten thousand on; four digits are readable without.
fn grouped(text: &str) -> String {
    let (sign, digits) = text.strip_prefix('-').map_or(("", text), |rest| ("-", rest));
    let (whole, fraction) = digits.split_once('.').map_or((digits, ""), |(whole, fraction)| (whole, fraction));
    let mut out = sign.to_owned();
    for (place, digit) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place).is_multiple_of(3) && whole.len() > 4 {
            out.push(GROUP);
        }
        out.push(digit);
    }
    if fraction.is_empty() { out } else { format!("{out}.{fraction}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_count_from_the_first() {
        let three = |value| significant(value, 3);
        assert_eq!([0.02824, 2.824, 551.2, 1528.4].map(three), ["0.0282", "2.82", "551", "1530"]);
        assert_eq!([9.996, 0.0, -12.34, 1e6].map(three), ["10.0", "0", "-12.3", "1\u{202f}000\u{202f}000"]);
        assert_eq!(three(f64::NAN), "—");
        assert_eq!([5.94e-7, 1e-4, 0.03412, 0.0].map(small), ["5.9e-7", "0.000100", "0.0341", "0"]);
    }

    #[test]
    fn units_are_what_people_expect() {
        assert_eq!([ratio(2.44), ratio(133.2), percent(0.1234)], ["2.4×", "133×", "12.3\u{a0}%"]);
        assert_eq!([bytes(0.0), bytes(1536.0), bytes(3e9)], ["0\u{a0}B", "1.50\u{a0}KiB", "2.79\u{a0}GiB"]);
        assert_eq!([count(510_000.4), count(1234.0)], ["510\u{202f}000", "1234"]);
        assert_eq!([setting(0.05), setting(2048.0), setting(f64::from(0.1_f32))], ["0.05", "2048", "0.1000"]);
    }
}
