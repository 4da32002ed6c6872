//! The difference between two images, as numbers and as an image.
//!
//! RMSE, PSNR and the maximum difference are computed on *display values*: linear values clamped to [0, 1] and converted by the
//! sRGB curve, without rounding. Errors are thus weighted approximately by visibility, and values brighter than the screen do not
//! count. FLIP (Andersson et al., *FLIP: A Difference Evaluator for Alternating Images*, HPG 2020) predicts the difference that a
//! viewer perceives when flipping between the images, at 67 pixels per degree: a 0.7 m wide 4K screen at 0.7 m. It gets display
//! values rounded to 8 bits.
//!
//! [`compare_linear`] adds measures of linear values, which have no limit: 2 and 4 are both white on a screen, and not the same light.

pub(crate) mod flip;
mod hdr_flip;
mod magma;

use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::transfer::linear_to_srgb;
use crate::{Frame, Transfer, Window};
use flip::flip;
use hdr_flip::{Exposures, hdr_flip};
use magma::MAGMA;

/// The difference between two frames; all 0 (and an infinite PSNR) if they look the same.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// Root of the mean squared difference over all pixels and channels, in [0, 1].
    pub rmse: f64,
    /// Peak signal-to-noise ratio in dB, `-20 log10(rmse)`: infinite without any difference, which is `null` in JSON.
    #[serde(serialize_with = "null_where_infinite")]
    pub psnr: f64,
    /// Maximum difference over all channels and pixels, in [0, 1].
    pub max_difference: f64,
    /// Mean of the FLIP error over all pixels, in [0, 1].
    pub mean_flip: f64,
    /// The difference of linear values, of [`compare_linear`] only: in JSON, its fields are beside the others.
    #[serde(flatten)]
    pub linear: Option<LinearDifference>,
    /// The FLIP error of each pixel in the magma colour map, from black (equal) to yellow (maximum); of [`compare_linear`], the HDR-FLIP error.
    #[serde(skip)]
    pub difference: Frame,
}

/// The difference between the linear values of two frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LinearDifference {
    /// Root of the mean squared difference over all pixels and channels, divided by the root of the reference's mean square: 1 if all values are
    /// twice those of the reference. Infinite if there is light in the test only, which is `null` in JSON.
    #[serde(serialize_with = "null_where_infinite")]
    pub relative_rmse: f64,
    /// Maximum difference over all channels and pixels.
    #[serde(serialize_with = "null_where_infinite")]
    pub max_linear_difference: f64,
    /// Mean of the HDR-FLIP error over all pixels, in [0, 1].
    pub mean_hdr_flip: f64,
    /// The first and the last exposure of HDR-FLIP, in stops, and their number.
    pub hdr_exposures: (f32, f32, usize),
}

/// Why two frames cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum CompareError {
    /// The frames have different sizes.
    #[error(
        "cannot compare an image of {}x{} pixels with one of {}x{}: render both with the same size and crop, or scale one of them",
        first.0, first.1, second.0, second.1
    )]
    Size {
        /// Width and height of the first frame.
        first: (u32, u32),
        /// Width and height of the second frame.
        second: (u32, u32),
    },
    /// The frames show different parts of an image.
    #[error(
        "cannot compare {} with {}: render both with the same crop, or both without; scaling would not bring their pixels together",
        part(.parts[0]), part(.parts[1])
    )]
    Part {
        /// The place of each frame in its image, and its width and height.
        parts: Box<[(Window, [u32; 2]); 2]>,
    },
    /// A frame contains NaN, for which there is no difference.
    #[error("cannot compare: the {which} image has NaN at column {x}, row {y}; render it again")]
    NotANumber {
        /// `first` or `second`.
        which: &'static str,
        /// Column of the pixel, 0 at the left.
        x: usize,
        /// Row of the pixel, 0 at the top.
        y: usize,
    },
}

/// Compares `test` with `reference`. FLIP is very nearly symmetric; the other measures are exactly symmetric.
///
/// # Errors
/// [`CompareError`] if the sizes differ, or a value is NaN.
pub fn compare(reference: &Frame, test: &Frame) -> Result<Comparison, CompareError> {
    check_sizes(reference, test)?;
    check_numbers("first", reference)?;
    check_numbers("second", test)?;

    let (rmse, max_difference) = display_difference(reference, test);
    let (mean_flip, difference) = flip_difference(reference, test);
    Ok(Comparison { rmse, psnr: -20.0 * rmse.log10(), max_difference, mean_flip, linear: None, difference })
}

/// Frames of which one is a part of an image, or more than it, need other advice than those of images of different sizes.
fn check_sizes(reference: &Frame, test: &Frame) -> Result<(), CompareError> {
    let sides = |frame: &Frame| [frame.width(), frame.height()];
    let (first, second) = ((reference.window(), sides(reference)), (test.window(), sides(test)));
    if first.1 == second.1 {
        return Ok(());
    }
    if first.0.whole == second.0.whole {
        return Err(CompareError::Part { parts: Box::new([first, second]) });
    }
    Err(CompareError::Size { first: first.1.into(), second: second.1.into() })
}

/// A frame as a part of its image, for messages.
fn part((Window { first, whole }, [width, height]): (Window, [u32; 2])) -> String {
    let [x, y] = first;
    if (first, whole) == ([0, 0], [width, height]) {
        return format!("a whole image of {width}x{height} pixels");
    }
    format!("the {width}x{height} pixels from column {x}, row {y} on of an image of {}x{}", whole[0], whole[1])
}

/// Compares as [`compare`] does, and linear values in addition: for files that store light, such as exr and hdr
/// ([`Range::Light`](crate::Range::Light)). Measures are relative to the reference.
///
/// ```
/// use lightmesh_image::{Frame, compare, compare_linear};
///
/// let [two, four] = [2.0, 4.0].map(|value| Frame::new(8, 8, vec![[value; 3]; 64]).expect("8 x 8 pixels"));
/// assert_eq!(compare(&two, &four)?.mean_flip, 0.0); // both are white on a screen
/// let linear = compare_linear(&two, &four)?.linear.expect("it is asked for");
/// assert_eq!(linear.relative_rmse, 1.0);
/// assert!(linear.mean_hdr_flip > 0.05);
/// # Ok::<(), lightmesh_image::CompareError>(())
/// ```
///
/// # Errors
/// [`CompareError`] if the sizes differ, or a value is NaN.
pub fn compare_linear(reference: &Frame, test: &Frame) -> Result<Comparison, CompareError> {
    let comparison = compare(reference, test)?;
    let (relative_rmse, max_linear_difference) = linear_difference(reference, test);
    let exposures = Exposures::of(reference.color());
    let errors = hdr_flip(reference.color(), test.color(), reference.width() as usize, exposures);
    let linear = LinearDifference {
        relative_rmse,
        max_linear_difference,
        mean_hdr_flip: mean(&errors),
        hdr_exposures: (exposures.first, exposures.last, exposures.count),
    };
    Ok(Comparison { linear: Some(linear), difference: map(reference, &errors), ..comparison })
}

fn check_numbers(which: &'static str, frame: &Frame) -> Result<(), CompareError> {
    let Some(index) = frame.color().iter().position(|color| color.iter().any(|value| value.is_nan())) else {
        return Ok(());
    };
    let width = frame.width() as usize;
    Err(CompareError::NotANumber { which, x: index % width, y: index / width })
}

/// RMSE and maximum difference of display values.
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

/// Relative RMSE and maximum difference of linear values.
fn linear_difference(reference: &Frame, test: &Frame) -> (f64, f64) {
    let (reference, test) = (reference.color().as_flattened(), test.color().as_flattened());
    let (mut sum, mut square, mut largest) = (0.0, 0.0, 0.0_f64);
    for (&a, &b) in reference.iter().zip(test) {
        let a = f64::from(a);
        square += a * a;
        // Infinities may be equal.
        if a != f64::from(b) {
            let difference = (a - f64::from(b)).abs();
            sum += difference * difference;
            largest = largest.max(difference);
        }
    }
    let relative = match (sum, square) {
        (0.0, _) => 0.0,
        (sum, square) if sum.is_finite() => (sum / square).sqrt(),
        _ => f64::INFINITY,
    };
    (relative, largest)
}

/// In single precision, like the colours: the curve's decimal constants then give exactly 1 for white.
fn display(linear: f32) -> f64 {
    f64::from(linear_to_srgb(f64::from(linear.clamp(0.0, 1.0))) as f32)
}

/// Mean FLIP, and the error map.
fn flip_difference(reference: &Frame, test: &Frame) -> (f64, Frame) {
    let [first, second] = [reference, test].map(codes);
    let errors = flip(first.as_chunks().0, second.as_chunks().0, reference.width() as usize);
    (mean(&errors), map(reference, &errors))
}

/// The HDR-FLIP error of each pixel; rows of `width` linear colours.
pub fn hdr_flip_errors(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize) -> Vec<f32> {
    hdr_flip(reference, test, width, Exposures::of(reference))
}

fn mean(errors: &[f32]) -> f64 {
    errors.iter().copied().map(f64::from).sum::<f64>() / errors.len() as f64
}

/// Errors as colours.
fn map(reference: &Frame, errors: &[f32]) -> Frame {
    reference.recolored(|pixel| {
        let [_, red, green, blue] = MAGMA[(errors[pixel] * 255.0 + 0.5) as usize].to_be_bytes();
        [red, green, blue].map(|code| Transfer::Srgb.decode(code))
    })
}

/// Three sRGB codes for each pixel.
fn codes(frame: &Frame) -> Vec<u8> {
    let mut codes = Vec::with_capacity(3 * frame.color().len());
    Transfer::Srgb.encode_into(frame.color(), &mut codes);
    codes
}

/// JSON has no infinity; other formats get the same value for consistency.
fn null_where_infinite<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(value).serialize(serializer)
}
