//! Writing EXR directly from a frame's planes, in blocks of rows that all threads compress.
//!
//! ZIP blocks are compressed here rather than by the `exr` crate, which takes three times as long: level 1 of zlib-rs instead of level 4
//! of miniz_oxide, for a tenth to a fifth more bytes (`cargo bench -p lightmesh --bench write`). Before that, ZIP splits the bytes of
//! a block in two halves, those at even and those at odd places, and replaces each byte by its difference from the one before, plus 128
//! (OpenEXR, `ImfZip.cpp`). Other methods are the crate's.

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

use super::{ALPHA, COLOR, DEPTH, NORMAL, POSITION, USED, attributes, visibility_name};
use crate::options::{ExrCompression, ExrSamples, SaveOptions};
use crate::save::{EncodeError, check_fits};
use crate::{Format, Frame, Layers, Window, deflate};

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
}

/// A plane with the name and the numbers of its channel.
struct Channel<'a> {
    name: Text,
    samples: ExrSamples,
    plane: Plane<'a>,
}

/// Writes the colours of `frame`, and its alpha if it has it; OpenEXR's colours are premultiplied, as the frame's.
pub(crate) fn write(frame: &Frame, options: &SaveOptions, output: impl Write + Seek) -> Result<(), EncodeError> {
    write_channels(frame, color(frame, options), options, output)
}

/// Writes the colours of `frame` and all of its `layers`.
pub(crate) fn write_layers(
    frame: &Frame,
    layers: &Layers,
    options: &SaveOptions,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    let samples = options.exr.samples;
    let exact = |name: &str, plane| Channel { name: Text::from(name), samples: ExrSamples::Float, plane };
    let mut channels = color(frame, options);
    channels.push(exact(DEPTH, Plane::Value(&layers.depth)));
    channels.extend(components(NORMAL, &layers.normal, samples));
    channels.extend(components(POSITION, &layers.position, ExrSamples::Float));
    channels.extend(layers.visibility.iter().enumerate().map(|(light, plane)| {
        let name = Text::from(&*visibility_name(light));
        Channel { name, samples, plane: Plane::Value(plane) }
    }));
    channels.push(exact(USED, Plane::Count(&layers.used)));
    write_channels(frame, channels, options, output)
}

fn color<'a>(frame: &'a Frame, options: &SaveOptions) -> Vec<Channel<'a>> {
    let samples = options.exr.samples;
    let alpha = frame.alpha().map(|alpha| Channel { name: Text::from(ALPHA), samples, plane: Plane::Value(alpha) });
    components(COLOR, frame.color(), samples).chain(alpha).collect()
}

fn components<'a>(
    names: [&'static str; 3],
    vectors: &'a [[f32; 3]],
    samples: ExrSamples,
) -> impl Iterator<Item = Channel<'a>> {
    let channel =
        move |(axis, name)| Channel { name: Text::from(name), samples, plane: Plane::Component(vectors, axis) };
    names.into_iter().enumerate().map(channel)
}

fn write_channels(
    frame: &Frame,
    mut channels: Vec<Channel<'_>>,
    options: &SaveOptions,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    check_fits(Format::Exr, frame)?;
    // The format requires this order.
    channels.sort_by(|a, b| a.name.cmp(&b.name));
    let header = header(frame, &channels, options);
    let (height, rows) = (frame.height() as usize, header.compression.scan_lines_per_block());
    let starts: Vec<usize> = (0..height).step_by(rows).collect();
    let written = ::exr::block::write(output, [header].into_iter().collect(), true, |meta, writer| {
        let header = &meta.headers[0];
        for (batch, starts) in starts.chunks(AT_ONCE).enumerate() {
            let chunk = |&start: &usize| chunk(&channels, header, start..height.min(start + rows));
            let chunks = starts.par_iter().map(chunk).collect::<Result<Vec<Chunk>, _>>()?;
            for (index, chunk) in chunks.into_iter().enumerate() {
                writer.write_chunk(batch * AT_ONCE + index, chunk)?;
            }
        }
        Ok(())
    });
    written.map_err(|error| EncodeError::Io(io_error(error)))
}

/// Scan lines in a fixed order, so that every reader supports the file and its bytes do not depend on threads.
fn header(frame: &Frame, channels: &[Channel<'_>], options: &SaveOptions) -> Header {
    let compression = match options.exr.compression {
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::Zips => Compression::ZIP1,
        ExrCompression::Piz => Compression::PIZ,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::None => Compression::Uncompressed,
    };
    let described = |channel: &Channel<'_>| {
        let samples = match channel.samples {
            ExrSamples::Float => SampleType::F32,
            ExrSamples::Half => SampleType::F16,
        };
        ChannelDescription::named(channel.name.clone(), samples)
    };
    let size = (frame.width() as usize, frame.height() as usize);
    let header = Header::new(Text::default(), size, channels.iter().map(described).collect()).with_encoding(
        compression,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    let mut header = attributes::described(header, &options.description);
    // The crate and the format number pixels in 31 bits; images are smaller.
    let Window { first, whole } = frame.window();
    header.own_attributes.layer_position = Vec2(first[0] as i32, first[1] as i32);
    header.shared_attributes.display_window = IntegerBounds::from_dimensions((whole[0] as usize, whole[1] as usize));
    header
}

fn io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// Some rows of all channels, compressed.
fn chunk(channels: &[Channel<'_>], header: &Header, rows: Range<usize>) -> ::exr::error::Result<Chunk> {
    let (width, start) = (header.layer_size.width(), rows.start);
    let mut bytes = Vec::with_capacity(header.channels.bytes_per_pixel * width * rows.len());
    for y in rows.clone() {
        channels.iter().for_each(|channel| channel.put(y * width..(y + 1) * width, &mut bytes));
    }
    if !matches!(header.compression, Compression::ZIP16 | Compression::ZIP1) {
        let index = BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, start),
            pixel_size: Vec2(width, rows.len()),
            level: Vec2(0, 0),
        };
        return UncompressedBlock { index, data: bytes }.compress_to_chunk(std::slice::from_ref(header));
    }
    let compressed = deflate::zlib(&differences(&bytes), LEVEL);
    // Blocks that are not shorter are stored as they are.
    let compressed_pixels_le = if compressed.len() < bytes.len() { compressed } else { bytes };
    let y_coordinate = header.own_attributes.layer_position.y() + start as i32;
    let block = CompressedScanLineBlock { y_coordinate, compressed_pixels_le };
    Ok(Chunk { layer_index: 0, compressed_block: CompressedBlock::ScanLine(block) })
}

impl Channel<'_> {
    /// Appends the samples of some pixels.
    fn put(&self, pixels: Range<usize>, bytes: &mut Vec<u8>) {
        match self.plane {
            Plane::Value(values) => self.put_all(values[pixels].iter().copied(), bytes),
            Plane::Count(counts) => self.put_all(counts[pixels].iter().map(|&count| count as f32), bytes),
            Plane::Component(vectors, axis) => self.put_all(vectors[pixels].iter().map(|vector| vector[axis]), bytes),
        }
    }

    fn put_all(&self, values: impl Iterator<Item = f32>, bytes: &mut Vec<u8>) {
        match self.samples {
            ExrSamples::Float => bytes.extend(values.flat_map(f32::to_le_bytes)),
            ExrSamples::Half => bytes.extend(values.flat_map(|value| half(value).to_le_bytes())),
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
