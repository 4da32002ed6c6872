//! Numbers of frames, and the names of their files.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::ValueError;

/// Frames from a first to a last one, every so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    first: u32,
    last: u32,
    step: u32,
}

impl Frames {
    /// All from 1 on.
    pub fn up_to(last: u32) -> Frames {
        Frames { first: 1, last, step: 1 }
    }

    /// Their numbers.
    pub fn numbers(self) -> impl Iterator<Item = u32> + Clone {
        (self.first..=self.last).step_by(self.step as usize)
    }

    /// The smallest number.
    pub fn first(self) -> u32 {
        self.first
    }

    /// The largest number that may occur.
    pub fn last(self) -> u32 {
        self.last
    }
}

impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Frames { first, last, step } = self;
        match step {
            1 => write!(f, "{first}-{last}"),
            _ => write!(f, "{first}-{last}x{step}"),
        }
    }
}

impl FromStr for Frames {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Frames, ValueError> {
        let form =
            || ValueError::Form { form: "A-B or A-BxN in whole numbers, A up to B", example: "1-120 or 1-120x4" };
        let whole = |text: &str| {
            let is_plain = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
            is_plain.then(|| text.parse().ok()).flatten()
        };
        let (range, step) =
            text.trim().split_once('x').map_or((text.trim(), Some(1)), |(range, step)| (range, whole(step)));
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        match (whole(first), whole(last), step) {
            (Some(first), Some(last), Some(step)) if first <= last && step > 0 => Ok(Frames { first, last, step }),
            _ => Err(form()),
        }
    }
}

/// The file of a frame: `####` in the name of `path`, or `%04d`, stands for its number, with as many digits at least. `None` if the name has
/// no place for it.
pub fn numbered(path: &Path, number: u32) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let (place, digits) = place_of_number(name)?;
    let (before, after) = (&name[..place.start], &name[place.end..]);
    Some(path.with_file_name(format!("{before}{number:0digits$}{after}")))
}

/// Where in a name the number goes, and its digits.
fn place_of_number(name: &str) -> Option<(std::ops::Range<usize>, usize)> {
    if let Some(start) = name.find('#') {
        let digits = name[start..].bytes().take_while(|&byte| byte == b'#').count();
        return Some((start..start + digits, digits));
    }
    let start = name.find('%')?;
    let digits = name[start + 1..].bytes().take_while(u8::is_ascii_digit).count();
    let end = start + 1 + digits;
    let width = if digits == 0 { 1 } else { name[start + 1..end].parse().ok().filter(|&width| width <= 20)? };
    (name.as_bytes().get(end) == Some(&b'd')).then_some((start..end + 1, width))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_as_they_are_shown() {
        for (text, numbers) in [("1-3", vec![1, 2, 3]), ("2-9x3", vec![2, 5, 8]), ("7-7", vec![7])] {
            let frames: Frames = text.parse().unwrap();
            assert_eq!((frames.numbers().collect::<Vec<_>>(), frames.to_string()), (numbers, text.to_owned()));
        }
        assert_eq!("7".parse::<Frames>().unwrap().to_string(), "7-7");
        for wrong in ["", "-", "3-1", "1-3x0", "1-", "+1-3", "a-b", "1-3x", "1.5-3", "1-99999999999"] {
            assert!(wrong.parse::<Frames>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_name_has_one_place_for_the_number() {
        let name = |pattern: &str, number| numbered(Path::new(pattern), number).map(|path| path.display().to_string());
        assert_eq!(name("a/out.####.png", 7).as_deref(), Some("a/out.0007.png"));
        assert_eq!(name("out#.png", 120).as_deref(), Some("out120.png"));
        assert_eq!(name("a#b/out_%03d.exr", 12).as_deref(), Some("a#b/out_012.exr"));
        assert_eq!(name("%d.png", 12).as_deref(), Some("12.png"));
        for without in ["out.png", "a####/out.png", "100%.png", "%99d.png", "-"] {
            assert_eq!(name(without, 1), None, "{without}");
        }
    }
}
