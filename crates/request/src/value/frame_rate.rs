//! Frames per second.

use std::fmt;
use std::str::FromStr;

use super::ValueError;

/// The largest rate.
const MAX: u64 = 1000;
/// Digits of each number of a rate: their products with a power of ten fit into 64 bits.
const DIGITS: usize = 9;

/// Frames per second, above 0 and up to 1000, as a ratio in lowest terms: the usual ones are no decimals, such as 30000/1001.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    frames: u64,
    seconds: u64,
}

impl FrameRate {
    /// In lowest terms; `None` if it is 0 or too large.
    fn ratio(frames: u64, seconds: u64) -> Option<FrameRate> {
        let is_valid = frames > 0 && seconds > 0 && frames <= seconds.saturating_mul(MAX);
        let divisor = common_divisor(frames, seconds);
        is_valid.then(|| FrameRate { frames: frames / divisor, seconds: seconds / divisor })
    }
}

impl FrameRate {
    /// The time of a frame in seconds; frame 1 is at 0.
    pub fn time(self, number: u32) -> f64 {
        f64::from(number.saturating_sub(1)) * self.seconds as f64 / self.frames as f64
    }

    /// The last frame that begins within `duration` seconds.
    pub fn last_frame(self, duration: f64) -> u32 {
        /// Ends that are written in single precision may lie a little before the frame that is meant.
        const ROUNDING: f64 = 1e-3;
        1 + (duration * self.frames as f64 / self.seconds as f64 + ROUNDING).min(f64::from(u32::MAX - 1)) as u32
    }
}

impl Default for FrameRate {
    /// That of films.
    fn default() -> FrameRate {
        FrameRate { frames: 24, seconds: 1 }
    }
}

fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.seconds {
            1 => write!(f, "{}", self.frames),
            seconds => write!(f, "{}/{seconds}", self.frames),
        }
    }
}

impl FromStr for FrameRate {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<FrameRate, ValueError> {
        let form = ValueError::Form { form: "frames per second, as a decimal or a ratio", example: "24 or 30000/1001" };
        let text = text.trim();
        let (frames, seconds) = match text.split_once('/') {
            Some((frames, seconds)) => whole(frames).zip(whole(seconds)),
            None => decimal(text),
        }
        .ok_or(form)?;
        FrameRate::ratio(frames, seconds).ok_or_else(|| ValueError::OutOfRange {
            what: "the number of frames per second",
            text: text.to_owned(),
            range: "above 0 and at most 1000",
        })
    }
}

fn whole(text: &str) -> Option<u64> {
    let is_plain = (1..=DIGITS).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    is_plain.then(|| text.parse().ok()).flatten()
}

/// A decimal as a ratio.
fn decimal(text: &str) -> Option<(u64, u64)> {
    if text.contains(['e', 'E']) {
        // Shown without an exponent.
        return decimal(&text.parse::<f64>().ok()?.to_string());
    }
    let Some((units, parts)) = text.split_once('.') else { return whole(text).map(|frames| (frames, 1)) };
    let seconds = 10_u64.pow(u32::try_from(parts.len()).ok().filter(|&digits| digits as usize <= DIGITS)?);
    Some((whole(units)? * seconds + whole(parts)?, seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_decimals_or_ratios() {
        for (text, shown) in [
            ("24", "24"),
            ("23.976", "2997/125"),
            ("30000/1001", "30000/1001"),
            ("50/2", "25"),
            ("12.50", "25/2"),
            ("2.4E+1", "24"),
            ("5e-1", "1/2"),
        ] {
            let rate: FrameRate = text.parse().unwrap();
            assert_eq!((rate.to_string().as_str(), shown.parse()), (shown, Ok(rate)), "{text}");
        }
        assert_eq!(FrameRate::default().to_string(), "24");
    }

    #[test]
    fn what_is_no_rate_is_refused() {
        for text in ["", "0", "0/1", "1/0", "1001", "1000.1", "-24", "+24", "24.", ".5", "1e4", "1e", "24/", "a", "nan"]
        {
            assert!(text.parse::<FrameRate>().is_err(), "{text}");
        }
        let message = "2000".parse::<FrameRate>().unwrap_err().to_string();
        assert_eq!(message, "the number of frames per second must be above 0 and at most 1000, but is 2000");
    }

    #[test]
    fn frame_1_is_the_beginning() {
        let rate: FrameRate = "24".parse().unwrap();
        assert_eq!([1, 2, 25].map(|number| rate.time(number)), [0.0, 1.0 / 24.0, 1.0]);
        assert_eq!([0.0, 0.99, 1.0, f64::from(0.041_666_665_f32)].map(|end| rate.last_frame(end)), [1, 24, 25, 2]);
        assert_eq!(rate.last_frame(1e30), u32::MAX);
    }
}
