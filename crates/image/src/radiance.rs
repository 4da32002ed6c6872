//! Reading Radiance pictures (`.hdr`, `.pic`): three bytes and a common exponent for each pixel (RGBE), with or without run lengths.
//!
//! G. Ward: *Real Pixels*, Graphics Gems II, 1991; the format is that of the Radiance file formats document. Values are divided by the exposures of
//! the header, as that asks for.

use crate::format::MAX_PIXELS;
use crate::{DecodeError, Frame};

/// What the files begin with; programs follow it with RADIANCE, RGBE or their name.
pub(crate) const SIGNATURE: &[u8] = b"#?";
/// Rows of other widths have no run lengths.
const RUN_LENGTHS: std::ops::RangeInclusive<usize> = 8..=0x7fff;
/// Of an exponent 0 bits: a mantissa is 8 bits below the point.
const BIAS: i32 = 128 + 8;

fn malformed(message: impl ToString) -> DecodeError {
    DecodeError::Radiance { message: message.to_string() }
}

/// Reads the colours.
pub(crate) fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    let mut rest = bytes;
    let exposure = header(&mut rest)?;
    let [width, height] = size(line(&mut rest)?)?;
    let mut color = Vec::new();
    for _ in 0..height {
        let row = scan_line(&mut rest, width)?;
        color.extend(row.into_iter().map(|rgbe| decoded(rgbe).map(|value| value / exposure)));
    }
    Frame::new(width as u32, height as u32, color).map_err(malformed)
}

/// A line of text, without its end.
fn line<'a>(rest: &mut &'a [u8]) -> Result<&'a str, DecodeError> {
    let end = rest.iter().position(|&byte| byte == b'\n').ok_or_else(|| malformed("its header does not end"))?;
    let (text, after) = rest.split_at(end);
    *rest = &after[1..];
    std::str::from_utf8(text).map(|text| text.trim_end_matches('\r')).map_err(|_| malformed("its header is no text"))
}

/// Reads up to the empty line, and returns the product of all exposures.
fn header(rest: &mut &[u8]) -> Result<f32, DecodeError> {
    let mut exposure = 1.0;
    loop {
        let text = line(rest)?;
        if text.is_empty() {
            return Ok(exposure);
        }
        match text.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
            Some(("FORMAT", format)) if format != "32-bit_rle_rgbe" => {
                return Err(malformed(format_args!(
                    "its format is `{}`, not 32-bit_rle_rgbe",
                    format.escape_default()
                )));
            }
            Some(("EXPOSURE", value)) => {
                let usual = value.parse::<f32>().ok().filter(|value| *value > 0.0 && value.is_finite());
                exposure *= usual.ok_or_else(|| malformed("it has an EXPOSURE that is no number above 0"))?;
            }
            _ => {}
        }
    }
}

/// Width and height from a line such as `-Y 512 +X 1024`.
fn size(text: &str) -> Result<[usize; 2], DecodeError> {
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    let ["-Y", height, "+X", width] = words[..] else {
        return Err(malformed(format_args!("its rows lie as `{}` says, not as -Y +X", text.escape_default())));
    };
    let number = |word: &str| word.parse::<usize>().ok().filter(|number| (1..=MAX_PIXELS).contains(number));
    let both = number(width).zip(number(height)).filter(|(width, height)| width.saturating_mul(*height) <= MAX_PIXELS);
    let (width, height) = both.ok_or_else(|| malformed(format_args!("its size is not 1 to {MAX_PIXELS} pixels")))?;
    Ok([width, height])
}

fn take<'a>(rest: &mut &'a [u8], count: usize) -> Result<&'a [u8], DecodeError> {
    let (taken, after) = rest.split_at_checked(count).ok_or_else(|| malformed("it is truncated"))?;
    *rest = after;
    Ok(taken)
}

fn scan_line(rest: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, DecodeError> {
    let begins =
        |rest: &[u8]| matches!(rest, [2, 2, high, low, ..] if usize::from(*high) << 8 | usize::from(*low) == width);
    if RUN_LENGTHS.contains(&width) && begins(rest) {
        take(rest, 4)?;
        return by_channel(rest, width);
    }
    by_pixel(rest, width)
}

/// One channel after the other: a count above 128 is a run of one value, else of so many values.
fn by_channel(rest: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, DecodeError> {
    let mut row = vec![[0; 4]; width];
    for channel in 0..4 {
        let mut x = 0;
        while x < width {
            let code = usize::from(take(rest, 1)?[0]);
            let (count, is_run) = if code > 128 { (code - 128, true) } else { (code, false) };
            let end = x + count;
            if count == 0 || end > width {
                return Err(malformed("a row is longer than the picture"));
            }
            let values = take(rest, if is_run { 1 } else { count })?;
            for (pixel, value) in row[x..end].iter_mut().zip(values.iter().cycle()) {
                pixel[channel] = *value;
            }
            x = end;
        }
    }
    Ok(row)
}

/// Pixel by pixel: mantissas of 1 stand for so many of the last pixel, with 8 bits more for each of them in a row.
fn by_pixel(rest: &mut &[u8], width: usize) -> Result<Vec<[u8; 4]>, DecodeError> {
    let (mut row, mut shift) = (Vec::new(), 0);
    while row.len() < width {
        let next = take(rest, 4)?;
        let [r, g, b, e] = [next[0], next[1], next[2], next[3]];
        if [r, g, b] != [1; 3] {
            row.push([r, g, b, e]);
            shift = 0;
            continue;
        }
        let count = usize::from(e).checked_shl(shift).unwrap_or(usize::MAX);
        let last = *row.last().ok_or_else(|| malformed("it begins with a repetition"))?;
        if count > width - row.len() {
            return Err(malformed("a row is longer than the picture"));
        }
        row.resize(row.len() + count, last);
        shift += 8;
    }
    Ok(row)
}

fn decoded([r, g, b, e]: [u8; 4]) -> [f32; 3] {
    // In double precision, since the smallest powers are no normal numbers in single.
    let scale = if e == 0 { 0.0 } else { f64::from(i32::from(e) - BIAS).exp2() };
    [r, g, b].map(|mantissa| (f64::from(mantissa) * scale) as f32)
}
