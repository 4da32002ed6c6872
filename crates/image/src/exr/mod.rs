//! OpenEXR: linear 32-bit floats in one part, with lossless compression (ZIP, 16 rows per block).
//!
//! Channels of a multilayer file, one plane each: `R G B`, `Z`, `N.X N.Y N.Z`, `P.X P.Y P.Z`, `V.0 V.1 …`, `M`. They are in one
//! part with their full names because this is what readers of single-part files support.

mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::{write, write_layers};

const COLOR: [&str; 3] = ["R", "G", "B"];
const LUMINANCE: &str = "Y";
const DEPTH: &str = "Z";
const NORMAL: [&str; 3] = ["N.X", "N.Y", "N.Z"];
const POSITION: [&str; 3] = ["P.X", "P.Y", "P.Z"];
const USED: &str = "M";

/// Name of the plane with the visibility of light `light`.
fn visibility_name(light: usize) -> String {
    format!("V.{light}")
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::{DecodeError, Frame, Layers};

    fn layered(lights: usize) -> Frame {
        let value = |pixel: usize, plane: usize| (pixel * 100 + plane) as f32 / 7.0;
        let vectors =
            |plane| (0..6).map(|pixel| [0_usize, 1, 2].map(|axis| -value(pixel, plane + axis))).collect::<Vec<_>>();
        let layers = Layers {
            depth: vec![1.5, 2.5, f32::INFINITY, 3.5, 1e30, 0.0],
            normal: vectors(10),
            position: vectors(20),
            visibility: (0..lights).map(|light| (0..6).map(|pixel| value(pixel, 30 + light)).collect()).collect(),
            used: vec![0, 1, 2, 3, 1 << 24, 5],
        };
        Frame::new(3, 2, vectors(0)).unwrap().with_layers(layers).unwrap()
    }

    fn encoded(frame: &Frame) -> Vec<u8> {
        let mut output = Cursor::new(Vec::new());
        write_layers(frame, frame.layers().unwrap(), &mut output).unwrap();
        output.into_inner()
    }

    #[test]
    fn layers_come_back_bit_for_bit() {
        for lights in [0, 1, 2, 12] {
            let frame = layered(lights);
            assert_eq!(read(&encoded(&frame)).unwrap(), frame, "{lights} lights");
        }
    }

    #[test]
    fn channels_have_their_names_in_one_part_of_floats() {
        use ::exr::compression::Compression;
        use ::exr::meta::attribute::SampleType;
        use ::exr::meta::{BlockDescription, MetaData};

        let bytes = encoded(&layered(11));
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).unwrap();
        assert_eq!(meta.headers.len(), 1);
        let header = &meta.headers[0];
        assert_eq!((header.blocks, header.compression), (BlockDescription::ScanLines, Compression::ZIP16));
        let channels = &header.channels.list;
        let mut expected: Vec<_> = "R G B Z N.X N.Y N.Z P.X P.Y P.Z M"
            .split(' ')
            .map(str::to_owned)
            .chain((0..11).map(visibility_name))
            .collect();
        expected.sort();
        assert_eq!(channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>(), expected);
        assert!(channels.iter().all(|channel| channel.sample_type == SampleType::F32));
    }

    #[test]
    fn a_file_without_colour_is_refused_by_its_channels() {
        use ::exr::prelude::{AnyChannel, AnyChannels};
        use ::exr::prelude::{FlatSamples, Image, WritableImage};

        let grey = |name: &str| {
            let channel = AnyChannel::new(name, FlatSamples::F32(vec![0.25; 6]));
            let mut output = Cursor::new(Vec::new());
            let channels = AnyChannels::sort([channel].into_iter().collect());
            Image::from_channels((3, 2), channels).write().to_buffered(&mut output).unwrap();
            output.into_inner()
        };
        assert_eq!(read(&grey("Y")).unwrap().color(), [[0.25; 3]; 6]);
        assert_eq!(read(&grey("depth")), Err(DecodeError::Channels { found: "depth".to_owned() }));
    }
}
