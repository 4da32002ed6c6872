//! Decodes image files to [`Texture`]s: PNG, JPEG, BMP and TGA, through the `image` crate.
//!
//! Files are untrusted: sizes are checked before memory is allocated for them. Grey, palettes and 16 bits per channel all
//! become RGBA8. Limitation: colour profiles and EXIF orientation are ignored, as glTF requires.

use std::io::Cursor;
use std::path::Path;

use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, guess_format};

use lightmesh_memory::{Budget, Short};

use super::Texture;

/// The longest side, in texels.
const MAX_SIDE: u32 = 16384;
/// No format packs more texels into a byte than PNG: deflate repeats 1032-fold, and a byte may contain eight texels.
const MAX_TEXELS_PER_BYTE: u64 = 8 * 1032;
/// Bytes of a texel with 16 bits per channel.
const MAX_BYTES_PER_TEXEL: u64 = 8;
/// Memory that a decoder may use whatever the image's size: tables, and unused metadata.
const DECODER_BYTES: u64 = 16 << 20;

const START_OF_SCAN: [u8; 2] = [0xff, 0xda];
const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];

/// Why an image cannot be used.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Undecodable {
    /// Something is wrong with it, worded to be put in brackets.
    Odd(String),
    /// Its texels do not fit into memory.
    TooLarge { size: [u32; 2], short: Short },
}

impl From<String> for Undecodable {
    fn from(reason: String) -> Undecodable {
        Undecodable::Odd(reason)
    }
}

/// The image in `bytes`. Its first bytes determine the format; a TGA file, which has no signature, is recognised by the
/// extension of `name`.
///
/// # Errors
///
/// [`Undecodable`]: the reason why it cannot be used.
pub(crate) fn decode(name: &str, bytes: &[u8], budget: Budget) -> Result<Texture, Undecodable> {
    let format = format(name, bytes)?;
    // The decoder fills missing data with grey and reports success.
    if format == ImageFormat::Jpeg && is_cut_off(bytes) {
        return Err("the JPEG data is truncated".to_owned().into());
    }
    let malformed = |error: ImageError| match error {
        ImageError::Unsupported(_) | ImageError::Limits(_) => error.to_string(),
        error => format!("its {} data is damaged or incomplete: {error}", word(format)),
    };
    let mut decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder().map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    let texels = checked_texels([width, height], MAX_SIDE, MAX_TEXELS_PER_BYTE, bytes)?;
    // As stored in the file, and as they will be kept.
    let kept = if decoder.color_type() == ColorType::Rgba8 { 0 } else { size_of::<[u8; 4]>() as u64 * texels };
    let needed = decoder.total_bytes() + kept;
    budget.check(needed).map_err(|short| Undecodable::TooLarge { size: [width, height], short })?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(2 * MAX_BYTES_PER_TEXEL * texels + DECODER_BYTES);
    decoder.set_limits(limits).map_err(malformed)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(malformed)?.into_rgba8();
    Ok(Texture { name: name.to_owned(), size: [width, height], texels: texels_of(picture.into_raw()) })
}

/// The number of texels that the header of an image says; an error if a side has none or too many, or if the file is too short for them.
pub(crate) fn checked_texels(
    [width, height]: [u32; 2],
    most_per_side: u32,
    most_per_byte: u64,
    bytes: &[u8],
) -> Result<u64, String> {
    let texels = u64::from(width) * u64::from(height);
    if texels == 0 || width.max(height) > most_per_side {
        return Err(format!("it has {width} x {height} texels, but only 1 to {most_per_side} per side are supported"));
    }
    if texels > most_per_byte * bytes.len() as u64 {
        return Err(format!("its header says {width} x {height} texels, too many for {} bytes", bytes.len()));
    }
    Ok(texels)
}

/// The same bytes as texels; nothing is copied unless their capacity is no multiple of a texel.
fn texels_of(bytes: Vec<u8>) -> Vec<[u8; 4]> {
    bytemuck::try_cast_vec(bytes).unwrap_or_else(|(_, bytes)| bytes.as_chunks().0.to_vec())
}

fn format(name: &str, bytes: &[u8]) -> Result<ImageFormat, String> {
    let by_name = || Path::new(name).extension().filter(|ending| ending.eq_ignore_ascii_case("tga"));
    match guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Bmp)) => Ok(format),
        _ if by_name().is_some() => Ok(ImageFormat::Tga),
        Ok(other) => Err(format!("it is a {} image; supported: PNG, JPEG, BMP and TGA", word(other))),
        Err(_) => Err("it is not a PNG, JPEG, BMP or TGA image".to_owned()),
    }
}

/// The format's name for display.
fn word(format: ImageFormat) -> String {
    format!("{format:?}").to_uppercase()
}

/// Whether no end marker follows the last scan of a JPEG file. Neither marker can occur within the coded data of a scan.
fn is_cut_off(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|window| window == marker);
    last(END_OF_IMAGE) <= last(START_OF_SCAN)
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, ImageBuffer, Luma, Rgb, Rgba};

    use super::*;

    fn decode(name: &str, bytes: &[u8]) -> Result<Texture, String> {
        super::decode(name, bytes, Budget::default()).map_err(|error| match error {
            Undecodable::Odd(reason) => reason,
            Undecodable::TooLarge { size, short } => format!("{size:?}: {short}"),
        })
    }

    /// Two by two texels that JPEG preserves well, each a different grey.
    fn grey() -> DynamicImage {
        GrayImage::from_fn(2, 2, |x, y| Luma([(40 + 50 * x + 100 * y) as u8])).into()
    }

    fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    const FORMATS: [(ImageFormat, &str); 4] = [
        (ImageFormat::Png, "a.png"),
        (ImageFormat::Jpeg, "a.jpg"),
        (ImageFormat::Bmp, "a.bmp"),
        (ImageFormat::Tga, "a.TGA"),
    ];

    #[test]
    fn every_format_is_read_with_its_first_row_at_the_top() {
        for (format, name) in FORMATS {
            let texture = decode(name, &encoded(&grey(), format)).unwrap();
            assert_eq!((texture.name.as_str(), texture.size), (name, [2, 2]));
            for (texel, wanted) in texture.texels.iter().zip([40u8, 90, 140, 190]) {
                let near = texel[..3].iter().all(|&value| value.abs_diff(wanted) < 4);
                assert!(near && texel[3] == 255, "{format:?}: {:?}", texture.texels);
            }
        }
    }

    #[test]
    fn sixteen_bits_and_coverage_become_eight() {
        let deep: DynamicImage = ImageBuffer::from_pixel(1, 1, Rgb([0u16, 0x8000, 0xffff])).into();
        assert_eq!(decode("", &encoded(&deep, ImageFormat::Png)).unwrap().texels, [[0, 128, 255, 255]]);
        let clear: DynamicImage = ImageBuffer::from_pixel(1, 1, Rgba([1u8, 2, 3, 4])).into();
        assert_eq!(decode("", &encoded(&clear, ImageFormat::Png)).unwrap().texels, [[1, 2, 3, 4]]);
    }

    #[test]
    fn palettes_are_resolved() {
        // A BMP file of one texel with one bit, and two colours: blue-green-red-0 each.
        let mut bytes = b"BM\x42\0\0\0\0\0\0\0\x3e\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x01\0".to_vec();
        bytes.extend([0; 16]);
        bytes.extend([2, 0, 0, 0, 0, 0, 0, 0]);
        bytes.extend([9, 9, 9, 0, 30, 20, 10, 0, 0x80, 0, 0, 0]);
        assert_eq!(decode("", &bytes).unwrap().texels, [[10, 20, 30, 255]]);
    }

    #[test]
    fn a_truncated_picture_is_an_error_wherever_it_ends() {
        for (format, name) in FORMATS {
            let whole = encoded(&grey(), format);
            // After the last texel there may be a footer that is not needed.
            let needed = match format {
                ImageFormat::Png => whole.len() - 16,
                ImageFormat::Tga => 18 + 4,
                _ => whole.len(),
            };
            for length in 0..needed {
                let answer = decode(name, &whole[..length]);
                assert!(answer.is_err(), "{format:?}, {length} of {} bytes: {answer:?}", whole.len());
            }
        }
    }

    #[test]
    fn what_is_no_picture_or_no_known_one_is_said() {
        assert_eq!(decode("oak.png", b"<html>").unwrap_err(), "it is not a PNG, JPEG, BMP or TGA image");
        assert_eq!(decode("oak.png", b"GIF89a").unwrap_err(), "it is a GIF image; supported: PNG, JPEG, BMP and TGA");
    }

    #[test]
    fn a_header_alone_takes_no_memory() {
        let mut bytes = encoded(&grey(), ImageFormat::Tga);
        bytes[12..16].copy_from_slice(&[0, 64, 0, 64]);
        let reason = decode("a.tga", &bytes).unwrap_err();
        assert!(reason.starts_with("its header says 16384 x 16384 texels, too many for"), "{reason}");
        bytes[12..16].copy_from_slice(&[1, 64, 1, 0]);
        assert!(decode("a.tga", &bytes).unwrap_err().starts_with("it has 16385 x 1 texels"));
        bytes[12..16].copy_from_slice(&[0, 0, 1, 0]);
        assert!(decode("a.tga", &bytes).is_err());
    }

    /// A few kilobytes that would be a gigabyte in memory.
    #[test]
    fn texels_that_do_not_fit_are_refused_before_they_are_decoded() {
        let plain: DynamicImage = GrayImage::new(16384, 4096).into();
        let bytes = encoded(&plain, ImageFormat::Png);
        assert!(bytes.len() < 1 << 20);
        let limit = Budget::new(Some(lightmesh_memory::held() + (128 << 20)));
        match super::decode("a.png", &bytes, limit) {
            Err(Undecodable::TooLarge { size: [16384, 4096], short }) => assert_eq!(short.needed, 5 << 26),
            other => panic!("{:?}", other.map(|texture| texture.size)),
        }
    }
}
