//! OpenEXR: linear floats, or halves on request, in one part, with lossless compression.
//!
//! Channels of a multilayer file, one plane each: `R G B`, `A` if there is alpha, `Z`, `N.X N.Y N.Z`, `P.X P.Y P.Z`, `V.0 V.1 …`, `M`. They are in one
//! part with their full names because this is what readers of single-part files support.

mod attributes;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::{write, write_layers};

const COLOR: [&str; 3] = ["R", "G", "B"];
const ALPHA: &str = "A";
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
    use crate::{DecodeError, Description, ExrCompression, ExrOptions, ExrSamples, Frame, Layers, SaveOptions};

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
        write_layers(frame, frame.layers().unwrap(), &SaveOptions::default(), &mut output).unwrap();
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
    fn a_part_of_an_image_says_where_it_lies() {
        use ::exr::meta::MetaData;

        let whole = layered(2);
        for &compression in ExrCompression::ALL {
            let part = whole.cropped([1, 1], [2, 1]).unwrap();
            let options = SaveOptions::default().with_exr(ExrOptions::default().with_compression(compression));
            let mut output = Cursor::new(Vec::new());
            write_layers(&part, part.layers().unwrap(), &options, &mut output).unwrap();
            let bytes = output.into_inner();
            let meta = MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
            let header = &meta.headers[0];
            let shown = header.shared_attributes.display_window;
            assert_eq!((shown.position.0, shown.position.1, shown.size.0, shown.size.1), (0, 0, 3, 2), "{compression}");
            let data = header.own_attributes.layer_position;
            assert_eq!((data.0, data.1), (1, 1), "{compression}");
            let back = read(&bytes).unwrap();
            assert_eq!((back.color(), back.layers()), (part.color(), part.layers()), "{compression}");
        }
    }

    #[test]
    fn every_compression_and_kind_of_number_comes_back() {
        let frame = layered(2).with_alpha(vec![0.5, 1.0, 0.0, 0.25, 1.0, 0.75]).unwrap();
        let exact = frame.layers().unwrap();
        for (&compression, &samples) in
            ExrCompression::ALL.iter().flat_map(|a| ExrSamples::ALL.iter().map(move |b| (a, b)))
        {
            let exr = ExrOptions::default().with_compression(compression).with_samples(samples);
            let mut output = Cursor::new(Vec::new());
            write_layers(&frame, exact, &SaveOptions::default().with_exr(exr), &mut output).unwrap();
            let back = read(&output.into_inner()).unwrap();
            if samples == ExrSamples::Float {
                assert_eq!(back, frame, "{compression}");
            }
            let layers = back.layers().unwrap();
            assert_eq!((&layers.depth, &layers.position), (&exact.depth, &exact.position), "{compression} {samples}");
            assert_eq!((&layers.used, back.alpha()), (&exact.used, frame.alpha()), "{compression} {samples}");
            let [found, expected] = [&back, &frame].map(|frame| frame.color()[5][2]);
            assert!((found - expected).abs() <= expected.abs() / 2048.0, "{compression} {samples}");
        }
    }

    #[test]
    fn halves_of_large_values_are_finite() {
        let color = vec![[1e9, -1e9, f32::INFINITY], [f32::NAN, 65504.0, 1e-9]];
        let frame = Frame::new(2, 1, color).unwrap();
        let exr = ExrOptions::default().with_samples(ExrSamples::Half);
        let mut output = Cursor::new(Vec::new());
        write(&frame, &SaveOptions::default().with_exr(exr), &mut output).unwrap();
        let back = read(&output.into_inner()).unwrap();
        assert_eq!(back.color()[0], [65504.0, -65504.0, f32::INFINITY]);
        assert!(back.color()[1][0].is_nan() && back.color()[1][1..] == [65504.0, 0.0]);
    }

    #[test]
    fn a_file_describes_itself() {
        use ::exr::meta::MetaData;

        let matrix = |first: f32| std::array::from_fn(|index| first + index as f32);
        let description = Description::default()
            .with_software("Lightmesh 0.1.0")
            .with_scene("häuser")
            .with_settings("{}")
            .with_camera(matrix(0.5), matrix(1.5));
        let mut output = Cursor::new(Vec::new());
        write(&layered(0), &SaveOptions::default().with_description(description), &mut output).unwrap();
        output.set_position(0);
        let meta = MetaData::read_from_buffered(output, true).unwrap();
        let (own, shared) = (&meta.headers[0].own_attributes, &meta.headers[0].shared_attributes);
        assert_eq!(own.software_name.as_ref().unwrap().to_string(), "Lightmesh 0.1.0");
        assert_eq!((own.world_to_camera, own.world_to_normalized_device), (Some(matrix(0.5)), Some(matrix(1.5))));
        assert_eq!(shared.chromaticities.unwrap().red, ::exr::prelude::Vec2(0.64, 0.33));
        assert!(own.owner.is_none() && own.other.len() == 1, "{own:?}");
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
