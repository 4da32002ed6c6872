//! Reading EXR: the full-resolution level of the first part, and of others of its size and place, with any number type and compression.

use std::collections::BTreeMap;
use std::io::Cursor;

use ::exr::compression::Compression;
use ::exr::image::FlatSamples;
use ::exr::image::read::read as reader;
use ::exr::math::Vec2;
use ::exr::meta::attribute::AttributeValue;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers};

use super::cryptomatte::{MATERIALS, Naming, OBJECTS};
use super::{ALPHA, COLOR, DEPTH, LUMINANCE, NORMAL, POSITION, REST, USED, light_names, visibility_name};
use crate::sizes::checked_pixels;
use crate::{DecodeError, Format, Frame, Layers, Matte};

/// What Blender calls the layer of the image.
const COMBINED: &str = "Combined";

/// Maximum decompressed size of the channels of a file, in bytes.
const MAX_BYTES: u64 = 1 << 36;

/// Maximum expansion of any compression method: deflate reaches 1032, times 4/3 for 24-bit floats.
const MAX_EXPANSION: u64 = 1376;

/// Reads colours from the channels `R G B`, from `Y` as grey, from those of a layer, or from the only channel as grey; alpha if there is `A`, and the
/// layers if all of their channels are present. The image is the file's data window, and knows its place in the display window.
pub fn read(bytes: &[u8]) -> Result<Frame, DecodeError> {
    let chunks = ::exr::block::read(Cursor::new(bytes), false).map_err(malformed)?;
    check_headers(chunks.headers(), bytes.len() as u64)?;
    let flat = chunks.headers().iter().all(|header| !header.deep);
    let channels = reader().no_deep_data().largest_resolution_level().all_channels();
    let (layers, shown) = if flat {
        let image = channels.all_layers().all_attributes().from_chunks(chunks).map_err(malformed)?;
        (image.layer_data.into_vec(), image.attributes.display_window)
    } else {
        let image = channels.first_valid_layer().all_attributes().from_chunks(chunks).map_err(malformed)?;
        (vec![image.layer_data], image.attributes.display_window)
    };

    let first = layers.first().ok_or_else(|| malformed("it has no parts"))?;
    let (size, position) = (first.size, first.attributes.layer_position);
    let mut planes = Planes::default();
    for layer in layers.into_iter().filter(|layer| (layer.size, layer.attributes.layer_position) == (size, position)) {
        planes.texts.extend(layer.attributes.other.into_iter().filter_map(|(name, value)| match value {
            // UTF-8, as which the crate does not show it.
            AttributeValue::Text(text) => Some((name.to_string(), String::from_utf8(text.as_slice().to_vec()).ok()?)),
            _ => None,
        }));
        for channel in layer.channel_data.list {
            // Of channels with the same name in several parts, such as those of two eyes, the first counts.
            planes.channels.entry(channel.name.to_string()).or_insert(channel.sample_data);
        }
    }
    let frame = Frame::new(size.0 as u32, size.1 as u32, planes.color()?).map_err(malformed)?;
    let place = |axis: fn(Vec2<i32>) -> i32| axis(position).saturating_sub(axis(shown.position));
    let whole = [shown.size.0, shown.size.1].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let frame = frame.with_window([place(|at| at.0), place(|at| at.1)], whole);
    let frame = match planes.alpha() {
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

/// Rejects files that would take too much memory, or more than `length` bytes can contain, and unsupported ones.
fn check_headers(headers: &[Header], length: u64) -> Result<(), DecodeError> {
    let needed = headers.iter().map(check_header).sum::<Result<u64, DecodeError>>()?;
    if needed > MAX_BYTES.min(length.saturating_mul(MAX_EXPANSION)) {
        return Err(malformed(format_args!("channels of {needed} bytes cannot be stored in {length} bytes")));
    }
    Ok(())
}

/// The bytes of a part's channels. Rejects DWA compression, and channels of reduced resolution.
fn check_header(header: &Header) -> Result<u64, DecodeError> {
    if matches!(header.compression, Compression::DWAA(_) | Compression::DWAB(_)) {
        return Err(malformed("DWA compression is not supported; use ZIP or another method"));
    }
    let [width, height] =
        [header.layer_size.0, header.layer_size.1].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let pixels = checked_pixels(Format::Exr, width, height)? as u64;
    if header.channels.list.iter().any(|channel| (channel.sampling.0, channel.sampling.1) != (1, 1)) {
        return Err(malformed("it has channels of reduced resolution"));
    }
    // The sum of those of all parts does not overflow.
    Ok(pixels.saturating_mul(header.channels.bytes_per_pixel as u64).min(MAX_BYTES + 1))
}

/// The channels and texts of a file by name.
#[derive(Default)]
struct Planes {
    channels: BTreeMap<String, FlatSamples>,
    texts: BTreeMap<String, String>,
}

impl Planes {
    fn get(&self, name: &str) -> Option<Vec<f32>> {
        Some(self.channels.get(name)?.values_as_f32().collect())
    }

    fn numbers(&self, name: &str) -> Option<Vec<u32>> {
        match self.channels.get(name)? {
            FlatSamples::U32(numbers) => Some(numbers.clone()),
            _ => None,
        }
    }

    fn matte(&self, naming: Naming) -> Matte {
        naming.read(|name| self.numbers(name), |name| self.get(name), |name| self.texts.get(name).cloned())
    }

    fn vectors(&self, names: [&str; 3]) -> Option<Vec<[f32; 3]>> {
        let [x, y, z] = [self.get(names[0])?, self.get(names[1])?, self.get(names[2])?];
        Some(x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect())
    }

    fn color(&self) -> Result<Vec<[f32; 3]>, DecodeError> {
        let grey = |name: &str| Some(self.get(name)?.into_iter().map(|value| [value; 3]).collect());
        let of_layer = || self.vectors(COLOR.map(|channel| self.layer_name(channel)).each_ref().map(String::as_str));
        let names = || self.channels.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let color = self.vectors(COLOR).or_else(|| grey(LUMINANCE)).or_else(of_layer).or_else(|| grey(self.single()?));
        color.ok_or_else(|| DecodeError::Channels { found: names() })
    }

    /// That of the colours.
    fn alpha(&self) -> Option<Vec<f32>> {
        let is_own =
            [COLOR[0], LUMINANCE].iter().any(|name| self.channels.contains_key(*name)) || self.single().is_some();
        self.get(&if is_own { ALPHA.to_owned() } else { self.layer_name(ALPHA) })
    }

    /// A channel of the layer that is the image: that of a renderer's final image (`ViewLayer.Combined` in Blender's files), or the only one.
    fn layer_name(&self, channel: &str) -> String {
        let last = format!(".{}", COLOR[0]);
        let mut layers: Vec<&str> = self.channels.keys().filter_map(|name| name.strip_suffix(&*last)).collect();
        layers.retain(|layer| COLOR.iter().all(|color| self.channels.contains_key(&format!("{layer}.{color}"))));
        let is_combined = |layer: &&&str| layer.rsplit('.').next() == Some(COMBINED);
        let layer = layers.iter().find(is_combined).or(layers.first().filter(|_| layers.len() == 1));
        format!("{}.{channel}", layer.unwrap_or(&""))
    }

    /// The only channel beside alpha.
    fn single(&self) -> Option<&str> {
        let mut others = self.channels.keys().filter(|name| *name != ALPHA);
        others.next().filter(|_| others.next().is_none()).map(String::as_str)
    }

    fn layers(&self) -> Option<Layers> {
        Some(Layers {
            depth: self.get(DEPTH)?,
            normal: self.vectors(NORMAL)?,
            position: self.vectors(POSITION)?,
            visibility: (0..).map_while(|light| self.get(&visibility_name(light))).collect(),
            used: self.get(USED)?.into_iter().map(|count| count as u32).collect(),
            lights: (0..).map_while(|light| self.vectors(light_names(light).each_ref().map(|name| &**name))).collect(),
            rest: self.vectors(REST).unwrap_or_default(),
            object: self.matte(OBJECTS),
            material: self.matte(MATERIALS),
        })
    }
}
