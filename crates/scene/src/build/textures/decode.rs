//! Decodes image files to [`Texture`]s: PNG, JPEG, BMP and TGA, through the `image` crate.
//!
//! Files are untrusted: sizes are checked before memory is allocated for them. Grey, palettes and 16 bits per channel all
//! become RGBA8. Limitation: colour profiles and EXIF orientation are ignored, as glTF requires.

use std::io::Cursor;
use std::path::Path;

use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, guess_format};

use lightmesh_memory::{Budget, OverBudget};

use crate::Texture;

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
pub enum Undecodable {
    /// Something is wrong with it, worded to be put in brackets.
    Odd(String),
    /// Its texels do not fit into memory.
    TooLarge {
        /// Columns and rows.
        size: [u32; 2],
        /// What there is.
        short: OverBudget,
    },
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
pub fn decode(name: &str, bytes: &[u8], budget: Budget) -> Result<Texture, Undecodable> {
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
