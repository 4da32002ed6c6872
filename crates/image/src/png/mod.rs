//! PNG: 8 or 16 bits per channel, with straight alpha if the frame has it, marked with its transfer function.

mod strips;

use std::collections::HashMap;
use std::io::{self, Cursor, Write};

use png::{BitDepth, ColorType, Decoder, Encoder, EncodingError, ScaledFloat, SrgbRenderingIntent, Transformations};

use crate::sizes::{check_fits, checked_pixels};
use crate::{DecodeError, Display, EncodeError, Format, Frame, Transfer};
use strips::Rows;

/// Writes `frame` as RGB or RGBA with an sRGB chunk, or a gAMA chunk of 1.0 if it is linear.
pub fn write(frame: &Frame, display: &Display, output: impl Write) -> Result<(), EncodeError> {
    check_fits(Format::Png, frame)?;
    let mut encoder = Encoder::new(output, frame.width(), frame.height());
    encoder.set_color(if frame.alpha().is_some() { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(match display.bit_depth {
        crate::BitDepth::Eight => BitDepth::Eight,
        crate::BitDepth::Sixteen => BitDepth::Sixteen,
    });
    match display.transfer {
        Transfer::Srgb => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
        Transfer::Linear => encoder.set_source_gamma(ScaledFloat::new(1.0)),
    }
    let mut writer = encoder.write_header().map_err(io_error)?;
    let pixel = display.pixel_bytes(frame);
    let rows = Rows { count: frame.height() as usize, bytes: pixel * frame.width() as usize, pixel };
    strips::write(&mut writer, rows, |y, bytes| display.encode_row(frame, y, bytes)).map_err(io_error)?;
    writer.finish().map_err(io_error)?;
    Ok(())
}

/// Writes `frame` with the sRGB curve and a palette; returns `false` without writing if it has more than 256 colours.
pub fn write_indexed(frame: &Frame, output: impl Write) -> Result<bool, EncodeError> {
    check_fits(Format::Png, frame)?;
    let mut places = HashMap::new();
    let (mut palette, mut indices, mut bytes) = (Vec::new(), Vec::with_capacity(frame.color().len()), Vec::new());
    for row in frame.rows() {
        bytes.clear();
        Transfer::Srgb.encode_into(row, &mut bytes);
        for color in bytes.chunks_exact(3) {
            let next = places.len();
            let place = *places.entry([color[0], color[1], color[2]]).or_insert(next);
            let Ok(index) = u8::try_from(place) else { return Ok(false) };
            if place == next {
                palette.extend_from_slice(color);
            }
            indices.push(index);
        }
    }
    let mut encoder = Encoder::new(output, frame.width(), frame.height());
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(palette);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(io_error)?;
    writer.write_image_data(&indices).map_err(io_error)?;
    writer.finish().map_err(io_error)?;
    Ok(true)
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// Maximum expansion: deflate reaches 1032, and a pixel of one bit becomes red, green, blue and alpha.
const MAX_EXPANSION: usize = 1032 * 32;

/// Reads any PNG into linear colours, which are multiplied by alpha if there is one; grey is copied to all channels.
pub fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    let malformed = |error: png::DecodingError| DecodeError::malformed(Format::Png, error);
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let mut reader = decoder.read_info().map_err(malformed)?;
    let (width, height) = (reader.info().width, reader.info().height);
    checked_pixels(Format::Png, width, height)?;
    let transfer = source_transfer(reader.info());

    let size = reader.output_buffer_size().ok_or(DecodeError::TooLarge { format: Format::Png, width, height })?;
    if size / MAX_EXPANSION > bytes.len() {
        let problem = format!("{width}x{height} pixels cannot be stored in {} bytes", bytes.len());
        return Err(DecodeError::malformed(Format::Png, problem));
    }
    let mut samples = vec![0; size];
    let info = reader.next_frame(&mut samples).map_err(malformed)?;
    reader.finish().map_err(malformed)?;
    let channels = info.color_type.samples();
    let (codes, most): (Vec<u16>, f32) = match info.bit_depth {
        // PNG stores 16-bit samples with the high byte first.
        BitDepth::Sixteen => (samples.as_chunks().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect(), 65535.0),
        _ => (samples.iter().map(|&code| u16::from(code)).collect(), 255.0),
    };
    drop(samples);
    let decode = |code: u16| if most == 255.0 { transfer.decode(code as u8) } else { transfer.decode16(code) };
    let color = |pixel: &[u16]| if channels < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] }.map(decode);
    let pixels = codes.chunks_exact(channels);
    let frame = if channels % 2 == 0 {
        let alpha: Vec<f32> = pixels.clone().map(|pixel| f32::from(pixel[channels - 1]) / most).collect();
        let color = pixels.zip(&alpha).map(|(pixel, alpha)| color(pixel).map(|channel| channel * alpha)).collect();
        Frame::new(width, height, color).and_then(|frame| frame.with_alpha(alpha))
    } else {
        Frame::new(width, height, pixels.map(color).collect())
    };
    frame.map_err(|error| DecodeError::malformed(Format::Png, error))
}

/// Linear only if the file is marked so; most files are not marked and mean sRGB.
fn source_transfer(info: &png::Info<'_>) -> Transfer {
    let linear = info.srgb.is_none() && info.gama_chunk.is_some_and(|gamma| gamma.into_value() == 1.0);
    if linear { Transfer::Linear } else { Transfer::Srgb }
}
