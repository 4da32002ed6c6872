//! Numbers of frames, and the names of their files.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::ValueError;

/// Frames: numbers, ranges, and every so many of a range, in one list. They are rendered in the order of their numbers, each once. Numbers below 1 can
/// be named, as schedulers do, but no film has such frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frames {
    /// At least one.
    parts: Vec<Part>,
}

/// Frames from a first to a last one, every so many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    first: i64,
    last: i64,
    step: u32,
}

impl Frames {
    /// All from 1 on.
    pub fn up_to(last: u32) -> Frames {
        Frames { parts: vec![Part { first: 1, last: last.into(), step: 1 }] }
    }

    /// These numbers, which rise; `None` if there are none.
    pub fn of_numbers(numbers: &[u32]) -> Option<Frames> {
        let mut parts: Vec<Part> = Vec::new();
        for number in numbers.iter().map(|&number| i64::from(number)) {
            match parts.last_mut() {
                Some(part) if part.first == part.last => (part.last, part.step) = (number, (number - part.last) as u32),
                Some(part) if part.last + i64::from(part.step) == number => part.last = number,
                _ => parts.push(Part { first: number, last: number, step: 1 }),
            }
        }
        (!parts.is_empty()).then_some(Frames { parts })
    }

    /// Their numbers, from the smallest on.
    pub fn numbers(&self) -> impl Iterator<Item = i64> + Clone {
        let from = |number| self.parts.iter().filter_map(|part| part.from(number)).min();
        std::iter::successors(from(self.first()), move |number| from(number + 1))
    }

    /// The smallest number.
    pub fn first(&self) -> i64 {
        self.parts.iter().map(|part| part.first).min().unwrap_or_default()
    }

    /// The largest number that may occur.
    pub fn last(&self) -> i64 {
        self.parts.iter().map(|part| part.last).max().unwrap_or_default()
    }
}

impl Part {
    /// Its smallest number that is not below `number`.
    fn from(&self, number: i64) -> Option<i64> {
        let (ahead, step) = ((number - self.first).max(0), i64::from(self.step));
        let next = self.first + (ahead + step - 1) / step * step;
        (next <= self.last).then_some(next)
    }
}

impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (index, Part { first, last, step }) in self.parts.iter().enumerate() {
            f.write_str(if index == 0 { "" } else { "," })?;
            match step {
                _ if first == last => write!(f, "{first}"),
                1 => write!(f, "{first}-{last}"),
                _ => write!(f, "{first}-{last}x{step}"),
            }?;
        }
        Ok(())
    }
}

impl FromStr for Frames {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Frames, ValueError> {
        let parts = text.split(',').map(part).collect::<Option<_>>();
        parts.map(|parts| Frames { parts }).ok_or(ValueError::Form {
            form: "A, A-B or every N-th of them, A-BxN or A-B:N, in whole numbers, A up to B, or several with commas between them",
            example: "1-120, 1-120x4 or 7,9,20-30",
        })
    }
}

/// One part of a list: `A`, `A-B`, `A-BxN` or `A-B:N`; A and B may have a minus sign.
fn part(text: &str) -> Option<Part> {
    let (range, step) = match text.trim().split_once(['x', ':']) {
        Some((range, step)) => (range, whole(step)?),
        None => (text.trim(), 1),
    };
    // The first minus may be a sign.
    let dash = range.get(1..)?.find('-').map(|dash| dash + 1);
    let (first, last) = dash.map_or((range, range), |dash| (&range[..dash], &range[dash + 1..]));
    let part = Part { first: signed(first)?, last: signed(last)?, step };
    (part.first <= part.last && part.step > 0).then_some(part)
}

fn signed(text: &str) -> Option<i64> {
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |digits| (-1, digits));
    whole(digits).map(|number| sign * i64::from(number))
}

fn whole(text: &str) -> Option<u32> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
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
    fn ranges_and_lists_are_read_as_they_are_shown() {
        for (text, numbers) in [
            ("1-3", vec![1, 2, 3]),
            ("2-9x3", vec![2, 5, 8]),
            ("7", vec![7]),
            ("7,9", vec![7, 9]),
            ("20-22,1-5x2,3-4", vec![1, 3, 4, 5, 20, 21, 22]),
            ("4294967290-4294967295x4", vec![4294967290, 4294967294]),
            ("-3-0", vec![-3, -2, -1, 0]),
            ("-7--1x3", vec![-7, -4, -1]),
            ("-5", vec![-5]),
        ] {
            let frames: Frames = text.parse().unwrap();
            assert_eq!((frames.numbers().collect::<Vec<_>>(), frames.to_string()), (numbers, text.to_owned()));
        }
        for (text, shown) in [("7-7", "7"), ("5-5", "5"), ("1-5:2", "1-5x2"), (" 9, 7 ", "9,7"), ("-3-0:3", "-3-0x3")] {
            assert_eq!(text.parse::<Frames>().unwrap().to_string(), shown);
        }
        let frames: Frames = "9,2-4".parse().unwrap();
        assert_eq!((frames.first(), frames.last()), (2, 9));
        let wrong = [
            "",
            "3-1",
            "1-3x0",
            "1-",
            "+1-3",
            "a-b",
            "1-3x",
            "1-3:",
            "1-3:2x2",
            "1.5-3",
            "1-99999999999",
            "7,",
            ",7",
            "--3",
            "1--3",
            "-1--3",
            "-",
            "é-3",
        ];
        for wrong in wrong {
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
