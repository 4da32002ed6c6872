//! JPEG at quality 92: for viewing, not for measurements.

use std::io::{self, Cursor, Write};

use image::ImageError;
use image::codecs::jpeg::{JpegDecoder, JpegEncoder};

use crate::decoder::read_with;
use crate::sizes::check_fits;
use crate::{DecodeError, Display, EncodeError, Format, Frame};

const QUALITY: u8 = 92;

const START_OF_SCAN: [u8; 2] = [0xff, 0xda];
const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];

/// Writes `frame` with 8 bits per channel; the format cannot record the transfer function.
pub fn write(frame: &Frame, display: &Display, output: impl Write) -> Result<(), EncodeError> {
    let (width, height) = (frame.width(), frame.height());
    check_fits(Format::Jpg, frame)?;
    let mut bytes = Vec::with_capacity(3 * frame.color().len());
    (0..height as usize).for_each(|y| display.encode_row(frame, y, &mut bytes));
    JpegEncoder::new_with_quality(output, QUALITY)
        .encode(&bytes, width, height, image::ExtendedColorType::Rgb8)
        .map_err(|error| EncodeError::Io(io_error(error)))
}

fn io_error(error: ImageError) -> io::Error {
    match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// Reads baseline and progressive JPEG, as sRGB.
pub(crate) fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    // The decoder fills missing data with grey and reports success.
    if is_cut_off(bytes) {
        return Err(DecodeError::malformed(Format::Jpg, "the file is truncated"));
    }
    read_with(Format::Jpg, JpegDecoder::new(Cursor::new(bytes)))
}

/// Whether no end marker follows the last scan. Neither marker can occur within the coded data of a scan.
pub fn is_cut_off(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|window| window == marker);
    last(END_OF_IMAGE) <= last(START_OF_SCAN)
}
