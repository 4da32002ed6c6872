mod cryptomatte;
mod order;

use std::io::Cursor;

use lightmesh_image::internals::exr::{
    MATERIALS, OBJECTS, REST, light_names, read, visibility_name, write, write_layers, write_values,
};
use lightmesh_image::{
    DecodeError, Description, ExrCompression, ExrOptions, ExrParts, ExrSamples, Frame, Layers, MAX_RANKS, Matte, Rank,
    SaveOptions,
};

/// Six ranks, in which pixels see up to two things.
fn matte(names: [&str; 3]) -> Matte {
    let mut matte = Matte::nothing(names.map(str::to_owned).to_vec(), MAX_RANKS, 6);
    matte.nearest = vec![0, 1, 2, 3, 1, 2];
    matte.ranks[0] = Rank { number: vec![0, 2, 2, 3, 1, 2], share: vec![0.0, 0.75, 1.0, 0.5, 0.3, 0.6] };
    matte.ranks[1] = Rank { number: vec![0, 1, 0, 1, 0, 3], share: vec![0.0, 0.25, 0.0, 0.5, 0.0, 0.4] };
    matte
}

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
        lights: (0..lights).map(|light| vectors(40 + 3 * light)).collect(),
        rest: vectors(90),
        object: matte(["floor", "ball \"1\"", "ß"]),
        material: matte(["grey", "", "红"]),
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

/// The file in parts, with these options.
fn in_parts(frame: &Frame, exr: ExrOptions) -> Vec<u8> {
    let mut output = Cursor::new(Vec::new());
    let options = SaveOptions::default().with_exr(exr.with_parts(ExrParts::Multi));
    write_layers(frame, frame.layers().unwrap(), &options, &mut output).unwrap();
    output.into_inner()
}

#[test]
fn layers_come_back_from_parts() {
    use ::exr::meta::MetaData;

    for &compression in ExrCompression::ALL {
        for lights in [0, 3] {
            let frame = layered(lights);
            let bytes = in_parts(&frame, ExrOptions::default().with_compression(compression));
            assert_eq!(read(&bytes).unwrap(), frame, "{compression} {lights}");
            let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).unwrap();
            let names: Vec<String> =
                meta.headers.iter().map(|it| it.own_attributes.layer_name.as_ref().unwrap().to_string()).collect();
            let expected = "rgba depth normal position visibility lights ids CryptoObject CryptoMaterial";
            assert_eq!(names.join(" "), expected);
        }
    }
}

#[test]
fn equal_images_are_equal_files() {
    let frame = layered(3);
    let description = Description::default().with_scene("scene").with_software("software").with_settings("{}");
    let options = SaveOptions::default().with_description(description);
    let written = || {
        let mut output = Cursor::new(Vec::new());
        write_layers(&frame, frame.layers().unwrap(), &options, &mut output).unwrap();
        output.into_inner()
    };
    let (first, parts) = (written(), in_parts(&frame, ExrOptions::default()));
    for _ in 0..8 {
        assert!(written() == first && in_parts(&frame, ExrOptions::default()) == parts);
    }
}

#[test]
fn mattes_are_floats_and_described() {
    use ::exr::meta::MetaData;
    use ::exr::meta::attribute::{AttributeValue, SampleType};

    let frame = layered(1);
    let exr = ExrOptions::default().with_samples(ExrSamples::Half);
    let mut output = Cursor::new(Vec::new());
    write_layers(&frame, frame.layers().unwrap(), &SaveOptions::default().with_exr(exr), &mut output).unwrap();
    output.set_position(0);
    let meta = MetaData::read_from_buffered(&mut output, true).unwrap();
    let header = &meta.headers[0];
    for channel in header.channels.list.iter().filter(|channel| channel.name.to_string().starts_with("Crypto")) {
        assert_eq!(channel.sample_type, SampleType::F32, "{}", channel.name);
    }
    let texts: Vec<(String, String)> = header
        .own_attributes
        .other
        .iter()
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
            _ => None,
        })
        .collect();
    assert_eq!(texts.iter().filter(|(name, _)| name.starts_with("cryptomatte/")).count(), 8);
    assert!(texts.iter().any(|(name, text)| name.ends_with("/name") && text == "CryptoObject"));
    let back = read(&output.into_inner()).unwrap();
    let (found, expected) = (back.layers().unwrap(), frame.layers().unwrap());
    assert_eq!((&found.object, &found.material), (&expected.object, &expected.material));
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
        .chain((0..11).flat_map(light_names))
        .chain(REST.map(str::to_owned))
        .chain(["id.object", "id.material"].map(str::to_owned))
        .chain(
            [OBJECTS, MATERIALS]
                .into_iter()
                .flat_map(|naming| (0..MAX_RANKS).flat_map(move |rank| naming.channels(rank))),
        )
        .collect();
    expected.sort();
    assert_eq!(channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>(), expected);
    let (ids, others): (Vec<_>, Vec<_>) =
        channels.iter().partition(|channel| channel.name.to_string().starts_with("id."));
    assert!(others.iter().all(|channel| channel.sample_type == SampleType::F32));
    assert!(ids.iter().all(|channel| channel.sample_type == SampleType::U32) && ids.len() == 2);
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

/// Overscan: what is in the file begins before what is shown.
#[test]
fn what_is_around_an_image_says_where_it_lies() {
    use ::exr::meta::MetaData;

    // Around all of an image of one pixel; beside one of which it has none.
    for (first, whole) in [([-1, -1], [1, 1]), ([-70, 5], [640, 480])] {
        let around = layered(2).with_window(first, whole);
        for &compression in ExrCompression::ALL {
            let options = SaveOptions::default().with_exr(ExrOptions::default().with_compression(compression));
            let mut output = Cursor::new(Vec::new());
            write_layers(&around, around.layers().unwrap(), &options, &mut output).unwrap();
            let bytes = output.into_inner();
            let meta = MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
            let header = &meta.headers[0];
            let shown = header.shared_attributes.display_window;
            let size = [shown.size.0, shown.size.1].map(|side| side as u32);
            assert_eq!(([shown.position.0, shown.position.1], size), ([0, 0], whole), "{compression}");
            let data = header.own_attributes.layer_position;
            assert_eq!(
                ([data.0, data.1], (header.layer_size.0, header.layer_size.1)),
                (first, (3, 2)),
                "{compression}"
            );
            let back = read(&bytes).unwrap();
            assert_eq!((back.color(), back.layers()), (around.color(), around.layers()), "{compression}");
            assert_eq!(back.window(), around.window(), "{compression}");
        }
    }
}

#[test]
fn every_compression_and_kind_of_number_comes_back() {
    let frame = layered(2).with_alpha(vec![0.5, 1.0, 0.0, 0.25, 1.0, 0.75]).unwrap();
    let exact = frame.layers().unwrap();
    for (&compression, &samples) in ExrCompression::ALL.iter().flat_map(|a| ExrSamples::ALL.iter().map(move |b| (a, b)))
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
fn values_have_channels_of_their_own() {
    use ::exr::prelude::{ReadChannels, ReadLayers, read};

    let (hours, seen) = ([0.0, 1.5, 2.25, 1e-3, 12.0, 7.0], [1.0f32; 6]);
    let mut output = Cursor::new(Vec::new());
    let channels = [("hours", &hours[..]), ("A", &seen)];
    write_values(&layered(0), &channels, &SaveOptions::default(), &mut output).unwrap();
    output.set_position(0);
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let image = image.from_buffered(output).unwrap();
    let found = image.layer_data.channel_data.list.iter().map(|channel| {
        let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
        (channel.name.to_string(), values)
    });
    let expected = [("A".to_owned(), seen.to_vec()), ("hours".to_owned(), hours.to_vec())];
    assert_eq!(found.collect::<Vec<_>>(), expected);
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

    let grey = |names: &[&str]| {
        let channel = |&name: &&str| AnyChannel::new(name, FlatSamples::F32(vec![0.25; 6]));
        let mut output = Cursor::new(Vec::new());
        let channels = AnyChannels::sort(names.iter().map(channel).collect());
        Image::from_channels((3, 2), channels).write().to_buffered(&mut output).unwrap();
        output.into_inner()
    };
    assert_eq!(read(&grey(&["Y"])).unwrap().color(), [[0.25; 3]; 6]);
    assert_eq!(read(&grey(&["depth", "other"])), Err(DecodeError::Channels { found: "depth, other".to_owned() }));
}
