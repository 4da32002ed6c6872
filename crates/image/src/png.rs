//! PNG: 8 bits per channel, marked with its transfer function.

use std::collections::HashMap;
use std::io::{self, Cursor, Write};

use png::{BitDepth, ColorType, Decoder, Encoder, EncodingError, ScaledFloat, SrgbRenderingIntent, Transformations};

use crate::frame::Frame;
use crate::load::{DecodeError, checked_pixels};
use crate::save::{EncodeError, check_fits};
use crate::{Format, Transfer};

/// Writes `frame` as 8-bit RGB with an sRGB chunk, or a gAMA chunk of 1.0 if it is linear.
pub(crate) fn write(frame: &Frame, transfer: Transfer, output: impl Write) -> Result<(), EncodeError> {
    check_fits(Format::Png, frame)?;
    let mut encoder = Encoder::new(output, frame.width(), frame.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    match transfer {
        Transfer::Srgb => encoder.set_source_srgb(SrgbRenderingIntent::Perceptual),
        Transfer::Linear => encoder.set_source_gamma(ScaledFloat::new(1.0)),
    }
    let mut writer = encoder.write_header().map_err(io_error)?;
    let mut rows = writer.stream_writer().map_err(io_error)?;
    let mut bytes = Vec::new();
    for row in frame.rows() {
        bytes.clear();
        transfer.encode_into(row, &mut bytes);
        rows.write_all(&bytes)?;
    }
    rows.finish().map_err(io_error)?;
    writer.finish().map_err(io_error)?;
    Ok(())
}

/// Writes `frame` with the sRGB curve and a palette; returns `false` without writing if it has more than 256 colours.
pub(crate) fn write_indexed(frame: &Frame, output: impl Write) -> Result<bool, EncodeError> {
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

/// Reads any PNG into linear colours: grey is copied to all channels, alpha is dropped.
pub(crate) fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
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
    let mut samples = vec![0; size];
    let info = reader.next_frame(&mut samples).map_err(malformed)?;
    reader.finish().map_err(malformed)?;
    let values = match info.bit_depth {
        BitDepth::Sixteen => decode_wide(&samples, transfer),
        _ => samples.iter().map(|&code| transfer.decode(code)).collect(),
    };
    let color = spread(&values, info.color_type.samples());
    Frame::new(width, height, color).map_err(|error| DecodeError::malformed(Format::Png, error))
}

/// Linear only if the file is marked so; most files are not marked and mean sRGB.
fn source_transfer(info: &png::Info<'_>) -> Transfer {
    let linear = info.srgb.is_none() && info.gama_chunk.is_some_and(|gamma| gamma.into_value() == 1.0);
    if linear { Transfer::Linear } else { Transfer::Srgb }
}

/// PNG stores 16-bit samples with the high byte first.
fn decode_wide(samples: &[u8], transfer: Transfer) -> Vec<f32> {
    samples.chunks_exact(2).map(|pair| transfer.decode16(u16::from_be_bytes([pair[0], pair[1]]))).collect()
}

/// Colours from pixels of 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGB, alpha) values.
fn spread(values: &[f32], channels: usize) -> Vec<[f32; 3]> {
    let pixels = values.chunks_exact(channels);
    if channels < 3 { pixels.map(|p| [p[0]; 3]).collect() } else { pixels.map(|p| [p[0], p[1], p[2]]).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encode(color: ColorType, depth: BitDepth, samples: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        encoder.write_header().unwrap().write_image_data(samples).unwrap();
        bytes
    }

    #[test]
    fn the_transfer_function_is_marked() {
        let frame = Frame::new(1, 1, vec![[0.2; 3]]).unwrap();
        for (transfer, chunk) in [(Transfer::Srgb, &b"sRGB\0"[..]), (Transfer::Linear, b"gAMA\0\x01\x86\xa0")] {
            let mut bytes = Vec::new();
            write(&frame, transfer, &mut bytes).unwrap();
            assert!(bytes.windows(chunk.len()).any(|window| window == chunk), "{transfer:?}");
            let expected = transfer.decode(transfer.encode(0.2));
            assert_eq!(read(&bytes).unwrap().color(), [[expected; 3]], "{transfer:?}");
        }
    }

    #[test]
    fn a_palette_holds_256_colours_and_no_more() {
        for (colors, is_indexed) in [(256, true), (257, false)] {
            // Each colour twice.
            let code = |index: usize| (index % colors % 256) as u8;
            let color = |index| [code(index), 7, (index % colors / 256) as u8].map(|code| Transfer::Srgb.decode(code));
            let frame = Frame::new(2, colors as u32, (0..2 * colors).map(color).collect()).unwrap();
            let mut bytes = Vec::new();
            assert_eq!(write_indexed(&frame, &mut bytes).unwrap(), is_indexed);
            assert_eq!(bytes.is_empty(), !is_indexed);
            assert_eq!(read(&frame.to_small_png().unwrap()).unwrap().color(), frame.color(), "{colors}");
        }
    }

    #[test]
    fn grey_alpha_and_sixteen_bits_are_read() {
        let decode = |code| Transfer::Srgb.decode(code);
        let grey = read(&encode(ColorType::Grayscale, BitDepth::Eight, &[50, 200])).unwrap();
        assert_eq!(grey.color(), [[decode(50); 3], [decode(200); 3]]);

        let rgba = read(&encode(ColorType::Rgba, BitDepth::Eight, &[1, 2, 3, 4, 5, 6, 7, 8])).unwrap();
        assert_eq!(rgba.color(), [[1, 2, 3].map(decode), [5, 6, 7].map(decode)]);

        let wide = read(&encode(ColorType::Grayscale, BitDepth::Sixteen, &[0x80, 0x00, 0xff, 0xff])).unwrap();
        assert_eq!(wide.color(), [[Transfer::Srgb.decode16(0x8000); 3], [1.0; 3]]);
    }
}
