//! Writing EXR directly from a frame's planes, in blocks of rows that all threads compress.
//!
//! ZIP blocks are compressed here rather than by the `exr` crate, which takes three times as long: level 1 of zlib-rs instead of level 4
//! of miniz_oxide, for a tenth to a fifth more bytes (`cargo bench -p lightmesh --bench write`). Before that, ZIP splits the bytes of
//! a block in two halves, those at even and those at odd places, and replaces each byte by its difference from the one before, plus 128
//! (OpenEXR, `ImfZip.cpp`). Other methods are the crate's.

use std::cell::Cell;
use std::io::{self, Seek, Write};
use std::ops::Range;

use ::exr::block::chunk::{Chunk, CompressedBlock, CompressedScanLineBlock};
use ::exr::block::writer::ChunksWriter;
use ::exr::block::{BlockIndex, UncompressedBlock};
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{ChannelDescription, IntegerBounds, LineOrder, SampleType, Text};
use ::exr::meta::header::Header;
use ::exr::prelude::{Compression, Vec2, f16};
use rayon::prelude::*;

use super::cryptomatte::{MATERIALS, Naming, OBJECTS, identifiers};
use super::order::Sorted;
use super::{ALPHA, COLOR, DEPTH, NORMAL, POSITION, REST, USED, attributes, light_names, visibility_name};
use crate::matte::MAX_RANKS;
use crate::options::{ExrCompression, ExrParts, ExrSamples, SaveOptions};
use crate::sizes::check_fits;
use crate::{EncodeError, Format, Frame, Layers, Matte, Window, deflate};

/// Blocks that are held in memory at once.
const AT_ONCE: usize = 32;
/// Level of ZIP.
const LEVEL: i32 = 1;

/// One channel of a frame: its values in row-major order.
#[derive(Clone, Copy)]
enum Plane<'a> {
    Value(&'a [f32]),
    Count(&'a [u32]),
    Component(&'a [[f32; 3]], usize),
    Number(&'a [u32]),
    /// Numbers of things, and the identifier of each as bits of a float.
    Identifier(&'a [u32], &'a [u32]),
    Nothing,
}

/// A plane with the name and the numbers of its channel.
struct Channel<'a> {
    name: Text,
    kind: SampleType,
    plane: Plane<'a>,
}

/// Channels that belong together, with texts that describe them.
struct Part<'a> {
    /// What compositors call it.
    name: &'static str,
    channels: Vec<Channel<'a>>,
    texts: Vec<(String, String)>,
}

impl<'a> Part<'a> {
    fn new(name: &'static str, channels: impl IntoIterator<Item = Channel<'a>>) -> Part<'a> {
        Part { name, channels: channels.into_iter().collect(), texts: Vec::new() }
    }
}

/// Writes the colours of `frame`, and its alpha if it has it; OpenEXR's colours are premultiplied, as the frame's.
pub fn write(frame: &Frame, options: &SaveOptions, output: impl Write + Seek) -> Result<(), EncodeError> {
    write_parts(frame, vec![color(frame, options)], options, output)
}

/// Writes the colours of `frame` and all of its `layers`, in one part or in one for each kind of layer.
pub fn write_layers(
    frame: &Frame,
    layers: &Layers,
    options: &SaveOptions,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    let kind = sample_type(options);
    let values = |name: String, plane| Channel { name: Text::from(&*name), kind, plane: Plane::Value(plane) };
    let visibility = layers.visibility.iter().enumerate().map(|(light, plane)| values(visibility_name(light), plane));
    let used = exact(USED, Plane::Count(&layers.used));
    let names = (0..layers.lights.len()).map(light_names).chain([REST.map(str::to_owned)]);
    let groups = layers.lights.iter().chain(Some(&layers.rest).filter(|rest| !rest.is_empty()));
    let mut parts = vec![
        color(frame, options),
        Part::new("depth", [exact(DEPTH, Plane::Value(&layers.depth))]),
        Part::new("normal", components(NORMAL, &layers.normal, kind)),
        Part::new("position", components(POSITION, &layers.position, SampleType::F32)),
        Part::new("visibility", visibility.chain([used])),
        Part::new(
            "lights",
            groups.zip(names).flat_map(|(plane, names)| components(names.each_ref().map(|name| &**name), plane, kind)),
        ),
    ];
    let mattes = [(&layers.object, OBJECTS), (&layers.material, MATERIALS)];
    let mattes: Vec<(&Matte, Naming, Vec<u32>)> = mattes
        .into_iter()
        .filter(|(matte, _)| !matte.is_empty())
        .map(|(matte, naming)| (matte, naming, identifiers(&matte.names)))
        .collect();
    let numbers = mattes.iter().map(|(matte, naming, _)| Channel {
        name: Text::from(naming.nearest),
        kind: SampleType::U32,
        plane: Plane::Number(&matte.nearest),
    });
    parts.push(Part::new("ids", numbers));
    parts.extend(mattes.iter().map(|(matte, naming, identifiers)| Part {
        texts: naming.attributes(matte).to_vec(),
        ..Part::new(naming.layer, (0..MAX_RANKS).flat_map(|rank| ranks(matte, *naming, identifiers, rank)))
    }));
    parts.retain(|part| !part.channels.is_empty());
    if options.exr.parts == ExrParts::Single {
        let mut all = Part::new("", []);
        for part in parts {
            all.channels.extend(part.channels);
            all.texts.extend(part.texts);
        }
        parts = vec![all];
    }
    write_parts(frame, parts, options, output)
}

/// Writes `channels` of floats by name, with as many values as `frame` has pixels.
pub fn write_values(
    frame: &Frame,
    channels: &[(&str, &[f32])],
    options: &SaveOptions,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    let channels = channels.iter().map(|&(name, values)| exact(name, Plane::Value(values)));
    write_parts(frame, vec![Part::new("", channels)], options, output)
}

fn color<'a>(frame: &'a Frame, options: &SaveOptions) -> Part<'a> {
    let kind = sample_type(options);
    let alpha = frame.alpha().map(|alpha| Channel { name: Text::from(ALPHA), kind, plane: Plane::Value(alpha) });
    Part::new("rgba", components(COLOR, frame.color(), kind).into_iter().chain(alpha))
}

/// A channel that halves are too coarse for.
fn exact<'a>(name: &str, plane: Plane<'a>) -> Channel<'a> {
    Channel { name: Text::from(name), kind: SampleType::F32, plane }
}

fn components<'a>(names: [&str; 3], vectors: &'a [[f32; 3]], kind: SampleType) -> [Channel<'a>; 3] {
    [0, 1, 2].map(|axis| Channel { name: Text::from(names[axis]), kind, plane: Plane::Component(vectors, axis) })
}

/// The channels of a rank; empty ones if the matte has fewer.
fn ranks<'a>(matte: &'a Matte, naming: Naming, identifiers: &'a [u32], rank: usize) -> [Channel<'a>; 2] {
    let [identifier, share] = naming.channels(rank);
    let planes = match matte.ranks.get(rank) {
        Some(rank) => [Plane::Identifier(&rank.number, identifiers), Plane::Value(&rank.share)],
        None => [Plane::Nothing; 2],
    };
    [exact(&identifier, planes[0]), exact(&share, planes[1])]
}

fn sample_type(options: &SaveOptions) -> SampleType {
    match options.exr.samples {
        ExrSamples::Float => SampleType::F32,
        ExrSamples::Half => SampleType::F16,
    }
}

fn write_parts(
    frame: &Frame,
    mut parts: Vec<Part<'_>>,
    options: &SaveOptions,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    check_fits(Format::Exr, frame)?;
    // The format requires this order.
    parts.iter_mut().for_each(|part| part.channels.sort_by(|a, b| a.name.cmp(&b.name)));
    let several = parts.len() > 1;
    let headers = parts.iter().map(|part| header(frame, part, several, options)).collect();
    let complete = Cell::new(false);
    let output = Sorted::new(output, parts.len(), &complete);
    let written = ::exr::block::write(output, headers, true, |meta, writer| {
        complete.set(true);
        let (headers, height) = (&meta.headers[..], frame.height() as usize);
        for (number, part) in parts.iter().enumerate() {
            let rows = headers[number].compression.scan_lines_per_block();
            let starts: Vec<usize> = (0..height).step_by(rows).collect();
            for (batch, starts) in starts.chunks(AT_ONCE).enumerate() {
                let chunk = |&start: &usize| chunk(&part.channels, headers, number, start..height.min(start + rows));
                let chunks = starts.par_iter().map(chunk).collect::<Result<Vec<Chunk>, _>>()?;
                for (index, chunk) in chunks.into_iter().enumerate() {
                    writer.write_chunk(batch * AT_ONCE + index, chunk)?;
                }
            }
        }
        Ok(())
    });
    written.map_err(|error| EncodeError::Io(io_error(error)))
}

/// Scan lines in a fixed order, so that every reader supports the file and its bytes do not depend on threads.
fn header(frame: &Frame, part: &Part<'_>, several: bool, options: &SaveOptions) -> Header {
    let compression = match options.exr.compression {
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::Zips => Compression::ZIP1,
        ExrCompression::Piz => Compression::PIZ,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::None => Compression::Uncompressed,
    };
    let described = |channel: &Channel<'_>| ChannelDescription::named(channel.name.clone(), channel.kind);
    let size = (frame.width() as usize, frame.height() as usize);
    let header = Header::new(Text::default(), size, part.channels.iter().map(described).collect()).with_encoding(
        compression,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    let mut header = attributes::described(header, &options.description, &part.texts);
    header.own_attributes.layer_name = several.then(|| Text::from(part.name));
    // The crate and the format number pixels in 31 bits; images are smaller.
    let Window { first, whole } = frame.window();
    header.own_attributes.layer_position = Vec2(first[0], first[1]);
    header.shared_attributes.display_window = IntegerBounds::from_dimensions((whole[0] as usize, whole[1] as usize));
    header
}

fn io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// Some rows of all channels of a part, compressed.
fn chunk(channels: &[Channel<'_>], headers: &[Header], part: usize, rows: Range<usize>) -> ::exr::error::Result<Chunk> {
    let header = &headers[part];
    let (width, start) = (header.layer_size.width(), rows.start);
    let mut bytes = Vec::with_capacity(header.channels.bytes_per_pixel * width * rows.len());
    for y in rows.clone() {
        channels.iter().for_each(|channel| channel.put(y * width..(y + 1) * width, &mut bytes));
    }
    if !matches!(header.compression, Compression::ZIP16 | Compression::ZIP1) {
        let index = BlockIndex {
            layer: part,
            pixel_position: Vec2(0, start),
            pixel_size: Vec2(width, rows.len()),
            level: Vec2(0, 0),
        };
        return UncompressedBlock { index, data: bytes }.compress_to_chunk(headers);
    }
    let compressed = deflate::zlib(&differences(&bytes), LEVEL);
    // Blocks that are not shorter are stored as they are.
    let compressed_pixels_le = if compressed.len() < bytes.len() { compressed } else { bytes };
    let y_coordinate = header.own_attributes.layer_position.y() + start as i32;
    let block = CompressedScanLineBlock { y_coordinate, compressed_pixels_le };
    Ok(Chunk { layer_index: part, compressed_block: CompressedBlock::ScanLine(block) })
}

impl Channel<'_> {
    /// Appends the samples of some pixels.
    fn put(&self, pixels: Range<usize>, bytes: &mut Vec<u8>) {
        match self.plane {
            Plane::Value(values) => self.put_all(values[pixels].iter().copied(), bytes),
            Plane::Count(counts) => self.put_all(counts[pixels].iter().map(|&count| count as f32), bytes),
            Plane::Component(vectors, axis) => self.put_all(vectors[pixels].iter().map(|vector| vector[axis]), bytes),
            Plane::Number(numbers) => bytes.extend(numbers[pixels].iter().flat_map(|number| number.to_le_bytes())),
            Plane::Identifier(numbers, bits) => {
                let bits = |&number: &u32| bits.get(number as usize).copied().unwrap_or(0).to_le_bytes();
                bytes.extend(numbers[pixels].iter().flat_map(bits));
            }
            Plane::Nothing => self.put_all(pixels.map(|_| 0.0), bytes),
        }
    }

    fn put_all(&self, values: impl Iterator<Item = f32>, bytes: &mut Vec<u8>) {
        match self.kind {
            SampleType::F16 => bytes.extend(values.flat_map(|value| half(value).to_le_bytes())),
            SampleType::F32 | SampleType::U32 => bytes.extend(values.flat_map(f32::to_le_bytes)),
        }
    }
}

/// The nearest half; what is finite stays finite.
fn half(value: f32) -> f16 {
    let largest = f32::from(f16::MAX);
    f16::from_f32(if value.is_finite() { value.clamp(-largest, largest) } else { value })
}

/// The bytes at even places, then those at odd places, as differences.
fn differences(bytes: &[u8]) -> Vec<u8> {
    let mut halves: Vec<u8> = bytes.iter().step_by(2).chain(bytes.iter().skip(1).step_by(2)).copied().collect();
    for index in (1..halves.len()).rev() {
        halves[index] = halves[index].wrapping_sub(halves[index - 1]).wrapping_add(128);
    }
    halves
}
