//! Whether two corresponding images are equal: identical in every pixel, nearly so, or different.

use lightmesh::image::{CompareError, Frame, compare};

/// Mean FLIP up to which images count as alike: about that of one pixel in fifty thousand that is white instead of grey, or of
/// one in a thousand that is rounded differently. Runs on different CPUs differ by as much where a ray just hits an edge.
pub(crate) const ALIKE: f64 = 1e-4;

/// The difference between corresponding images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Likeness {
    /// No pixel differs.
    Same,
    /// Some pixels differ, by no more than [`ALIKE`] on average.
    Alike(Trace),
    /// It differs by more.
    Different,
    /// It has a different size, so pixels cannot be compared.
    OtherSize,
}

/// The small difference between images that are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trace {
    /// Pixels that differ.
    pub(crate) differing: usize,
    /// All pixels.
    pub(crate) pixels: usize,
    pub(crate) mean_flip: f64,
}

impl Likeness {
    /// Of `picture` to `first`.
    pub(crate) fn of(picture: &Frame, first: &Frame) -> Result<Likeness, CompareError> {
        if (picture.width(), picture.height()) != (first.width(), first.height()) {
            return Ok(Likeness::OtherSize);
        }
        let differing = picture.color().iter().zip(first.color()).filter(|(a, b)| a != b).count();
        if differing == 0 {
            return Ok(Likeness::Same);
        }
        let mean_flip = compare(first, picture)?.mean_flip;
        let trace = Trace { differing, pixels: first.color().len(), mean_flip };
        Ok(if mean_flip <= ALIKE { Likeness::Alike(trace) } else { Likeness::Different })
    }

    /// Whether one image may represent both.
    pub(crate) fn one_for_both(&self) -> bool {
        matches!(self, Likeness::Same | Likeness::Alike(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey image with its first pixels lighter.
    fn frame(width: u32, lighter: usize) -> Frame {
        let pixel = |index| if index < lighter { [0.3; 3] } else { [0.2; 3] };
        Frame::new(width, 128, (0..width as usize * 128).map(pixel).collect()).unwrap()
    }

    #[test]
    fn a_pixel_is_little_and_a_line_is_not() {
        let likeness = |lighter| Likeness::of(&frame(256, lighter), &frame(256, 0)).unwrap();
        assert_eq!(likeness(0), Likeness::Same);
        let Likeness::Alike(trace) = likeness(1) else { panic!("{:?}", likeness(1)) };
        assert_eq!((trace.differing, trace.pixels), (1, 32_768));
        assert!(trace.mean_flip > 0.0 && trace.mean_flip <= ALIKE, "{trace:?}");
        assert_eq!(likeness(256), Likeness::Different);
    }

    #[test]
    fn sizes_are_not_compared() {
        let likeness = Likeness::of(&frame(64, 0), &frame(128, 0)).unwrap();
        assert_eq!(likeness, Likeness::OtherSize);
        assert!(!likeness.one_for_both());
    }
}
