//! URIs of buffers and images: embedded data, or the name of a file next to it.

use std::borrow::Cow;

use base64::{
    Engine, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use percent_encoding::percent_decode_str;

/// The target of a URI.
#[derive(Debug, PartialEq, Eq)]
pub enum Uri<'a> {
    /// What follows `data:`.
    Data(&'a str),
    /// A file's name, decoded.
    File(Cow<'a, str>),
}

impl<'a> Uri<'a> {
    /// By its scheme.
    pub fn new(uri: &'a str) -> Uri<'a> {
        match uri.split_at_checked("data:".len()) {
            Some((scheme, data)) if scheme.eq_ignore_ascii_case("data:") => Uri::Data(data),
            _ => Uri::File(percent_decode_str(uri).decode_utf8_lossy()),
        }
    }
}

/// The bytes of `mediatype;base64,DATA` or `mediatype,DATA`; `None` if the data is invalid.
pub fn decode(data: &str) -> Option<Vec<u8>> {
    let (header, data) = data.split_once(',')?;
    let base64 = header.rsplit(';').next().is_some_and(|word| word.trim().eq_ignore_ascii_case("base64"));
    if !base64 {
        return Some(percent_decode_str(data).collect());
    }
    let config = GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true);
    let engine = GeneralPurpose::new(&alphabet::STANDARD, config);
    match engine.decode(data) {
        Ok(bytes) => Some(bytes),
        // Percent signs and line breaks are rare enough to try without handling them first.
        Err(_) => {
            let plain: Vec<u8> = percent_decode_str(data).filter(|byte| !byte.is_ascii_whitespace()).collect();
            engine.decode(plain).ok()
        }
    }
}
