//! The part of an image that is rendered, with what lies around it.

use std::fmt;
use std::str::FromStr;

/// A crop has so many pixels beyond an edge of the image at most.
pub(crate) const MOST_OVERSCAN: u32 = 1 << 16;

/// A rectangle of an image's pixels. It may extend beyond the image, or lie beside it: the camera sees on there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Crop {
    /// Column and row of its first pixel; row 0 is the image's first. Negative to the left of the image and above.
    pub first: [i32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// A text that is no [`Crop`].
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected X,Y,WIDTH,HEIGHT in pixels of the image, the last two at least 1, for example 200,100,640,480, or -16,-16,672,512 around an image of \
     640x480"
)]
pub struct UnknownCrop;

impl Crop {
    /// The `width` × `height` pixels from column `x` and row `y` on.
    pub fn new([x, y]: [i32; 2], [width, height]: [u32; 2]) -> Crop {
        Crop { first: [x, y], size: [width, height] }
    }

    /// Whether it has pixels, and an image of `whole` pixels has all of them.
    pub fn is_within(&self, whole: [u32; 2]) -> bool {
        self.is_within_margin(whole, 0)
    }

    /// Whether it can be rendered: it has pixels, and none of them is more than 65536 pixels beyond an edge of an image of `whole` pixels.
    pub fn is_near(&self, whole: [u32; 2]) -> bool {
        self.is_within_margin(whole, MOST_OVERSCAN)
    }

    fn is_within_margin(&self, whole: [u32; 2], margin: u32) -> bool {
        let margin = i64::from(margin);
        (0..2).all(|axis| {
            let (first, size) = (i64::from(self.first[axis]), i64::from(self.size[axis]));
            size > 0 && first >= -margin && first + size <= i64::from(whole[axis]) + margin
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
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let [x, y, width, height] = parts[..] else { return Err(UnknownCrop) };
        let place = |part: &str| part.parse::<i32>().map_err(|_| UnknownCrop);
        let side = |part: &str| part.parse().ok().filter(|&side: &u32| side > 0).ok_or(UnknownCrop);
        Ok(Crop::new([place(x)?, place(y)?], [side(width)?, side(height)?]))
    }
}
