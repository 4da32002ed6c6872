//! Sizes of images that files can have.

use crate::format::{Format, MAX_PIXELS};
use crate::frame::{Frame, pixel_count};
use crate::{DecodeError, EncodeError};

/// The number of pixels, if supported.
pub(crate) fn checked_pixels(format: Format, width: u32, height: u32) -> Result<usize, DecodeError> {
    let pixels = pixel_count(width, height).filter(|&pixels| pixels <= MAX_PIXELS);
    pixels.ok_or(DecodeError::TooLarge { format, width, height })
}

/// Fails if `format` does not support the size of `frame`.
pub(crate) fn check_fits(format: Format, frame: &Frame) -> Result<(), EncodeError> {
    match format.exceeded_limit(frame.width(), frame.height()) {
        Some(limit) => Err(EncodeError::TooLarge { limit }),
        None => Ok(()),
    }
}
