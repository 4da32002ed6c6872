//! Reading by the decoders of the `image` crate.

use image::{DynamicImage, ImageDecoder, ImageResult};

use crate::sizes::checked_pixels;
use crate::{DecodeError, Format, Frame, Transfer};

/// Reads an 8-bit image with a decoder of the `image` crate, after checking its size.
pub(crate) fn read_with(format: Format, decoder: ImageResult<impl ImageDecoder>) -> Result<Frame, DecodeError> {
    let decoder = decoder.map_err(|error| DecodeError::malformed(format, error))?;
    let (width, height) = decoder.dimensions();
    checked_pixels(format, width, height)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| DecodeError::malformed(format, error))?;
    let color = picture.into_rgb8().pixels().map(|pixel| pixel.0.map(|code| Transfer::Srgb.decode(code))).collect();
    Frame::new(width, height, color).map_err(|error| DecodeError::malformed(format, error))
}
