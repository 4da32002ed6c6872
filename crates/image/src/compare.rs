//! How far two pictures are apart, as numbers and as a picture.
//!
//! RMSE, PSNR and the largest difference are taken over *display values*: linear values clamped to [0, 1] and put through
//! the sRGB curve, without rounding. So an error counts about as much as it shows, and what is brighter than the screen
//! does not count. FLIP (Andersson et al., *FLIP: A Difference Evaluator for Alternating Images*, HPG 2020) predicts what
//! a viewer sees who flips between both, at 67 pixels per degree: a 0.7 m wide 4K screen from 0.7 m away. It gets the
//! display values in 8 bits.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, flip, magma_lut};
use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::transfer::linear_to_srgb;
use crate::{Frame, Transfer};

/// The most pixels that the FLIP library can index.
const MAX_PIXELS: usize = i32::MAX as usize / 3;

/// How far two frames are apart; 0 throughout (and an infinite PSNR) where they look the same.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Root of the mean squared difference over all pixels and channels, in [0, 1].
    pub rmse: f64,
    /// Peak signal-to-noise ratio in dB, `-20 log10(rmse)`: infinite where nothing differs, which is `null` in JSON.
    #[serde(serialize_with = "null_where_infinite")]
    pub psnr: f64,
    /// The largest difference of any channel of any pixel, in [0, 1].
    pub max_difference: f64,
    /// Mean of the FLIP error over all pixels, in [0, 1].
    pub mean_flip: f64,
    /// The FLIP error of each pixel through the magma colour map: black is equal, yellow is as different as can be.
    #[serde(skip)]
    pub difference: Frame,
}

/// Why two frames cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum CompareError {
    /// The frames have different sizes.
    #[error(
        "cannot compare a picture of {}x{} pixels with one of {}x{}: render or scale both to one size",
        first.0, first.1, second.0, second.1
    )]
    Size {
        /// Width and height of the first frame.
        first: (u32, u32),
        /// Width and height of the second frame.
        second: (u32, u32),
    },
    /// A frame has a value that is not a number, to which no difference exists.
    #[error("cannot compare: the {which} picture has NaN at column {x}, row {y}; render it anew")]
    NotANumber {
        /// `first` or `second`.
        which: &'static str,
        /// Column of the pixel, 0 at the left.
        x: usize,
        /// Row of the pixel, 0 at the top.
        y: usize,
    },
    /// The frames have more pixels than FLIP can work on.
    #[error(
        "cannot compare pictures of {width}x{height} pixels: at most {MAX_PIXELS} pixels can be, compare parts of them"
    )]
    TooLarge {
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

/// Compares `test` with `reference`. FLIP is very nearly symmetric in both; the other measures are exactly so.
///
/// # Errors
/// [`CompareError`] where the sizes differ, a value is NaN, or there are too many pixels.
pub fn compare(reference: &Frame, test: &Frame) -> Result<Comparison, CompareError> {
    let (width, height) = (reference.width(), reference.height());
    if (width, height) != (test.width(), test.height()) {
        return Err(CompareError::Size { first: (width, height), second: (test.width(), test.height()) });
    }
    if reference.color().len() > MAX_PIXELS {
        return Err(CompareError::TooLarge { width, height });
    }
    check_numbers("first", reference)?;
    check_numbers("second", test)?;

    let (rmse, max_difference) = display_difference(reference, test);
    let (mean_flip, difference) = flip_difference(reference, test);
    Ok(Comparison { rmse, psnr: -20.0 * rmse.log10(), max_difference, mean_flip, difference })
}

fn check_numbers(which: &'static str, frame: &Frame) -> Result<(), CompareError> {
    let Some(index) = frame.color().iter().position(|color| color.iter().any(|value| value.is_nan())) else {
        return Ok(());
    };
    let width = frame.width() as usize;
    Err(CompareError::NotANumber { which, x: index % width, y: index / width })
}

/// RMSE and the largest difference, over display values.
fn display_difference(reference: &Frame, test: &Frame) -> (f64, f64) {
    let (reference, test) = (reference.color().as_flattened(), test.color().as_flattened());
    let (mut sum, mut largest) = (0.0, 0.0_f64);
    for (&a, &b) in reference.iter().zip(test) {
        if a != b {
            let difference = (display(a) - display(b)).abs();
            sum += difference * difference;
            largest = largest.max(difference);
        }
    }
    ((sum / reference.len() as f64).sqrt(), largest)
}

/// In single precision, as the colours are: the curve's decimal constants then give exactly 1 for white.
fn display(linear: f32) -> f64 {
    f64::from(linear_to_srgb(f64::from(linear.clamp(0.0, 1.0))) as f32)
}

/// Mean FLIP, and the map of it.
fn flip_difference(reference: &Frame, test: &Frame) -> (f64, Frame) {
    let error = flip(flip_image(reference), flip_image(test), DEFAULT_PIXELS_PER_DEGREE);
    let values = error.to_vec();
    let mean = values.iter().copied().map(f64::from).sum::<f64>() / values.len() as f64;

    let map = error.apply_color_lut(&magma_lut()).to_vec();
    let difference =
        reference.recolored(|pixel| [0, 1, 2].map(|channel| Transfer::Srgb.decode(map[3 * pixel + channel])));
    (mean, difference)
}

fn flip_image(frame: &Frame) -> FlipImageRgb8 {
    let mut bytes = Vec::with_capacity(3 * frame.color().len());
    Transfer::Srgb.encode_into(frame.color(), &mut bytes);
    FlipImageRgb8::with_data(frame.width(), frame.height(), &bytes)
}

/// JSON has no infinity; other formats get the same so that they agree.
fn null_where_infinite<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(value).serialize(serializer)
}
