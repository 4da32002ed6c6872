//! BMP: 24 bits per pixel, uncompressed, the format of the method's first implementation.
//!
//! The writer of the crate `image` leaves the resolution 0, so that its files differ in 8 bytes, and takes the whole picture at once.

pub(crate) mod layout;

use std::io::{Cursor, Write};

use image::codecs::bmp::BmpDecoder;

use self::layout::{LIMIT, Layout};
use crate::decoder::read_with;
use crate::{DecodeError, Display, EncodeError, Format, Frame};

/// Writes `frame` with 8 bits per channel; the format cannot record the transfer function.
pub fn write(frame: &Frame, display: &Display, mut output: impl Write) -> Result<(), EncodeError> {
    let layout = Layout::new(frame.width(), frame.height());
    let layout = layout.ok_or(EncodeError::TooLarge { limit: LIMIT })?;
    output.write_all(&layout.headers())?;
    let mut bytes = Vec::with_capacity(layout.row);
    for y in (0..frame.height() as usize).rev() {
        bytes.clear();
        display.encode_row(frame, y, &mut bytes);
        bytes.chunks_exact_mut(3).for_each(|pixel| pixel.swap(0, 2));
        bytes.resize(layout.row, 0);
        output.write_all(&bytes)?;
    }
    Ok(())
}

/// Reads any BMP of 1 to 32 bits per pixel, as sRGB.
pub(crate) fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    read_with(Format::Bmp, BmpDecoder::new(Cursor::new(bytes)))
}
