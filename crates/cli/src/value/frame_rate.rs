//! `--fps`.

use std::fmt;
use std::str::FromStr;

use super::ValueError;

/// Frames per second, as a ratio: films have rates such as 30000/1001.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameRate {
    frames: f64,
    seconds: f64,
}

/// The highest rate.
const HIGHEST: f64 = 1000.0;

impl Default for FrameRate {
    fn default() -> FrameRate {
        FrameRate { frames: 24.0, seconds: 1.0 }
    }
}

impl FrameRate {
    /// The time of a frame in seconds; frame 1 is at 0.
    pub(crate) fn time(self, number: u32) -> f64 {
        f64::from(number.saturating_sub(1)) * self.seconds / self.frames
    }

    /// The last frame that begins within `duration` seconds.
    pub(crate) fn last_frame(self, duration: f64) -> u32 {
        /// Ends that are written in single precision may lie a little before the frame that is meant.
        const ROUNDING: f64 = 1e-3;
        1 + (duration * self.frames / self.seconds + ROUNDING).min(f64::from(u32::MAX - 1)) as u32
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let FrameRate { frames, seconds } = self;
        if *seconds == 1.0 { write!(f, "{frames}") } else { write!(f, "{frames}/{seconds}") }
    }
}

impl FromStr for FrameRate {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<FrameRate, ValueError> {
        let form = || ValueError::Form { form: "frames per second, up to 1000", example: "24, 29.97 or 30000/1001" };
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
        let (frames, seconds) = text.split_once('/').unwrap_or((text, "1"));
        let (frames, seconds) = number(frames).zip(number(seconds)).ok_or_else(form)?;
        let rate = frames / seconds;
        if rate > 0.0 && rate <= HIGHEST { Ok(FrameRate { frames, seconds }) } else { Err(form()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_read_as_they_are_shown() {
        for text in ["24", "29.97", "30000/1001", "0.5"] {
            assert_eq!(text.parse::<FrameRate>().unwrap().to_string(), text);
        }
        for wrong in ["", "0", "-24", "1001", "24/0", "24/", "/2", "inf", "NaN", "1/2/3"] {
            assert!(wrong.parse::<FrameRate>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn frame_1_is_the_beginning() {
        let rate: FrameRate = "24".parse().unwrap();
        assert_eq!([1, 2, 25].map(|number| rate.time(number)), [0.0, 1.0 / 24.0, 1.0]);
        assert_eq!([0.0, 0.99, 1.0, f64::from(0.041_666_665_f32)].map(|end| rate.last_frame(end)), [1, 24, 25, 2]);
        assert_eq!(rate.last_frame(1e30), u32::MAX);
    }
}
