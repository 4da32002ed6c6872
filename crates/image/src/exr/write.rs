//! Writing EXR directly from a frame's planes, without copying them.

use std::io::{self, Seek, Write};

use ::exr::block::lines::LineRefMut;
use ::exr::image::write::samples::{SamplesWriter, WritableSamples};
use ::exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, Image, Layer};
use ::exr::math::RoundingMode;
use ::exr::meta::attribute::{LevelMode, LineOrder, SampleType};
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::prelude::{Compression, WritableImage};

use super::{COLOR, DEPTH, NORMAL, POSITION, USED, visibility_name};
use crate::save::{EncodeError, check_fits};
use crate::{Format, Frame, Layers};

/// Scan lines in a fixed order, so that every reader supports the file and its bytes do not depend on threads.
const ENCODING: Encoding =
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

/// One channel of a frame: its values in row-major order.
#[derive(Clone, Copy)]
enum Plane<'a> {
    Value(&'a [f32]),
    Count(&'a [u32]),
    Component(&'a [[f32; 3]], usize),
}

/// Writes the colours of `frame`.
pub(crate) fn write(frame: &Frame, output: impl Write + Seek) -> Result<(), EncodeError> {
    write_channels(frame, color(frame), output)
}

/// Writes the colours of `frame` and all of its `layers`.
pub(crate) fn write_layers(frame: &Frame, layers: &Layers, output: impl Write + Seek) -> Result<(), EncodeError> {
    let mut channels = color(frame);
    channels.push(AnyChannel::new(DEPTH, Plane::Value(&layers.depth)));
    channels.extend(components(NORMAL, &layers.normal));
    channels.extend(components(POSITION, &layers.position));
    channels.extend(
        layers
            .visibility
            .iter()
            .enumerate()
            .map(|(light, plane)| AnyChannel::new(visibility_name(light).as_str(), Plane::Value(plane))),
    );
    channels.push(AnyChannel::new(USED, Plane::Count(&layers.used)));
    write_channels(frame, channels, output)
}

fn color(frame: &Frame) -> Vec<AnyChannel<Plane<'_>>> {
    components(COLOR, frame.color()).collect()
}

fn components<'a>(names: [&'static str; 3], vectors: &'a [[f32; 3]]) -> impl Iterator<Item = AnyChannel<Plane<'a>>> {
    names.into_iter().enumerate().map(|(axis, name)| AnyChannel::new(name, Plane::Component(vectors, axis)))
}

fn write_channels(
    frame: &Frame,
    channels: Vec<AnyChannel<Plane<'_>>>,
    output: impl Write + Seek,
) -> Result<(), EncodeError> {
    check_fits(Format::Exr, frame)?;
    let size = (frame.width() as usize, frame.height() as usize);
    let channels = AnyChannels::sort(channels.into_iter().collect());
    let image = Image::from_layer(Layer::new(size, LayerAttributes::default(), ENCODING, channels));
    image.write().to_buffered(output).map_err(|error| EncodeError::Io(io_error(error)))
}

fn io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    }
}

impl<'a> WritableSamples<'a> for Plane<'_> {
    type Writer = PlaneWriter<'a>;

    fn sample_type(&self) -> SampleType {
        SampleType::F32
    }

    fn infer_level_modes(&self) -> (LevelMode, RoundingMode) {
        (LevelMode::Singular, RoundingMode::Down)
    }

    fn create_samples_writer(&'a self, header: &Header) -> Self::Writer {
        PlaneWriter { plane: *self, width: header.layer_size.width() }
    }
}

/// Passes rows of a plane to the encoder, on any of its threads.
struct PlaneWriter<'a> {
    plane: Plane<'a>,
    width: usize,
}

impl SamplesWriter for PlaneWriter<'_> {
    fn extract_line(&self, line: LineRefMut<'_>) {
        let start = line.location.position.y() * self.width + line.location.position.x();
        let written = match self.plane {
            Plane::Value(values) => line.write_samples(|x| values[start + x]),
            Plane::Count(counts) => line.write_samples(|x| counts[start + x] as f32),
            Plane::Component(vectors, axis) => line.write_samples(|x| vectors[start + x][axis]),
        };
        // The line is a slice that the encoder sized for exactly these samples.
        written.expect("a line of samples fits the block made for it");
    }
}
