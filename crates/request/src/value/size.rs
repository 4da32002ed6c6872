//! Integers separated by x.

use std::fmt;
use std::str::FromStr;

use super::ValueError;

/// Integers of at least 1, separated by `x`; `None` for any other text.
fn counts<const N: usize>(text: &str) -> Option<[u32; N]> {
    let parts: Option<Vec<u32>> = text.split(['x', 'X']).map(|part| part.parse().ok().filter(|&n| n > 0)).collect();
    parts?.try_into().ok()
}

/// Width and height of an image in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl Default for Size {
    fn default() -> Size {
        Size([1024, 1024])
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [width, height] = self.0;
        write!(f, "{width}x{height}")
    }
}

impl FromStr for Size {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Size, ValueError> {
        let form = ValueError::Form { form: "WIDTHxHEIGHT, both integers of at least 1", example: "1024x768" };
        counts(text).map(Size).ok_or(form)
    }
}

/// Cells of a grid along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dims(pub [u32; 3]);

impl fmt::Display for Dims {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0;
        write!(f, "{x}x{y}x{z}")
    }
}

impl FromStr for Dims {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Dims, ValueError> {
        let form = ValueError::Form { form: "NXxNYxNZ, all integers of at least 1", example: "160x120x140" };
        counts(text).map(Dims).ok_or(form)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        assert_eq!("15x10X20".parse(), Ok(Dims([15, 10, 20])));
    }

    #[test]
    fn what_is_no_size_is_refused() {
        for text in ["", "640", "640x", "x480", "0x480", "640x-480", "640x480x3", "6.4x4", "640*480", "9999999999x1"] {
            assert!(text.parse::<Size>().is_err(), "{text}");
        }
        assert!("15x10".parse::<Dims>().is_err());
    }
}
