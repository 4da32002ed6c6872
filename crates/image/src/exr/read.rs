//! Reading EXR: the full-resolution level of the first part, with any number type and compression.

use std::io::Cursor;

use ::exr::compression::Compression;
use ::exr::image::FlatSamples;
use ::exr::image::read::read as reader;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers};

use super::{ALPHA, COLOR, DEPTH, LUMINANCE, NORMAL, POSITION, USED, visibility_name};
use crate::load::{DecodeError, checked_pixels};
use crate::{Format, Frame, Layers};

/// Maximum decompressed size of the channels of a file, in bytes.
const MAX_BYTES: u64 = 1 << 36;

/// Maximum expansion of any compression method: deflate reaches 1032, times 4/3 for 24-bit floats.
const MAX_EXPANSION: u64 = 1376;

/// Reads colours from the channels `R G B`, or from `Y` as grey, alpha if there is `A`, and the layers if all of their channels are present. The image
/// is the file's data window.
pub(crate) fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    let chunks = ::exr::block::read(Cursor::new(bytes), false).map_err(malformed)?;
    for header in chunks.headers() {
        check_header(header, bytes.len() as u64)?;
    }
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_chunks(chunks)
        .map_err(malformed)?;

    let size = image.layer_data.size;
    let planes =
        Planes(image.layer_data.channel_data.list.into_iter().map(|c| (c.name.to_string(), c.sample_data)).collect());
    let frame = Frame::new(size.0 as u32, size.1 as u32, planes.color()?).map_err(malformed)?;
    let frame = match planes.get(ALPHA) {
        Some(alpha) => frame.with_alpha(alpha).map_err(malformed)?,
        None => frame,
    };
    match planes.layers() {
        Some(layers) => frame.with_layers(layers).map_err(malformed),
        None => Ok(frame),
    }
}

fn malformed(message: impl ToString) -> DecodeError {
    DecodeError::malformed(Format::Exr, message)
}

/// Rejects files that would take too much memory, or more than `length` bytes can contain, and unsupported ones: DWA compression,
/// and channels of reduced resolution.
fn check_header(header: &Header, length: u64) -> Result<(), DecodeError> {
    if matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return Err(malformed("DWA compression is not supported; use ZIP or another method"));
    }
    let [width, height] =
        [header.layer_size.0, header.layer_size.1].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let pixels = checked_pixels(Format::Exr, width, height)? as u64;
    let needed = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
    if needed > MAX_BYTES.min(length.saturating_mul(MAX_EXPANSION)) {
        return Err(malformed(format_args!("channels of {needed} bytes cannot be stored in {length} bytes")));
    }
    if header.channels.list.iter().any(|channel| (channel.sampling.0, channel.sampling.1) != (1, 1)) {
        return Err(malformed("it has channels of reduced resolution"));
    }
    Ok(())
}

/// The channels of a file by name.
struct Planes(Vec<(String, FlatSamples)>);

impl Planes {
    fn get(&self, name: &str) -> Option<Vec<f32>> {
        let (_, samples) = self.0.iter().find(|(known, _)| known == name)?;
        Some(samples.values_as_f32().collect())
    }

    fn vectors(&self, names: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let [x, y, z] = [self.get(names[0])?, self.get(names[1])?, self.get(names[2])?];
        Some(x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect())
    }

    fn color(&self) -> Result<Vec<[f32; 3]>, DecodeError> {
        let grey = || Some(self.get(LUMINANCE)?.into_iter().map(|value| [value; 3]).collect());
        let names = || self.0.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
        self.vectors(COLOR).or_else(grey).ok_or_else(|| DecodeError::Channels { found: names() })
    }

    fn layers(&self) -> Option<Layers> {
        Some(Layers {
            depth: self.get(DEPTH)?,
            normal: self.vectors(NORMAL)?,
            position: self.vectors(POSITION)?,
            visibility: (0..).map_while(|light| self.get(&visibility_name(light))).collect(),
            used: self.get(USED)?.into_iter().map(|count| count as u32).collect(),
        })
    }
}
