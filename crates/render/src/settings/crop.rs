//! The part of an image that is rendered.

use std::fmt;
use std::str::FromStr;

/// A rectangle of an image's pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Crop {
    /// Column and row of its first pixel; row 0 is the top.
    pub first: [u32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A text that is no [`Crop`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected X,Y,WIDTH,HEIGHT in pixels of the image, the first two at least 0 and the last two at least 1, for example 200,100,640,480"
)]
pub struct UnknownCrop;

impl Crop {
    /// The `width` × `height` pixels from column `x` and row `y` on.
    pub fn new([x, y]: [u32; 2], [width, height]: [u32; 2]) -> Crop {
        Crop { first: [x, y], size: [width, height] }
    }

    /// Whether it has pixels, and an image of `whole` pixels has all of them.
    pub fn is_within(&self, whole: [u32; 2]) -> bool {
        (0..2).all(|axis| {
            let end = u64::from(self.first[axis]) + u64::from(self.size[axis]);
            self.size[axis] > 0 && end <= u64::from(whole[axis])
        })
    }
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([x, y], [width, height]) = (self.first, self.size);
        write!(f, "{x},{y},{width},{height}")
    }
}

impl FromStr for Crop {
    type Err = UnknownCrop;

    fn from_str(text: &str) -> Result<Crop, UnknownCrop> {
        let parts: Result<Vec<u32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
        match parts.as_deref() {
            Ok(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop::new([x, y], [width, height])),
            _ => Err(UnknownCrop),
        }
    }
}
