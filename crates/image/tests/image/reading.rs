//! Files of other programs: Radiance pictures, and EXR files whose image is not in the channels `R G B`.

use std::fs;
use std::io::Cursor;

use lightmesh_image::internals::exr::write_values;
use lightmesh_image::{DecodeError, Frame, Range, SaveOptions};

const HEADER: &str = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";

/// An EXR file with these channels of two pixels.
fn exr(channels: &[(&str, [f32; 2])]) -> Vec<u8> {
    let frame = Frame::new(2, 1, vec![[0.0; 3]; 2]).unwrap();
    let channels: Vec<(&str, &[f32])> = channels.iter().map(|(name, values)| (*name, &values[..])).collect();
    let mut bytes = Cursor::new(Vec::new());
    write_values(&frame, &channels, &SaveOptions::default(), &mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn pixels_of_radiance_pictures_have_a_common_exponent() {
    let bytes = [HEADER.as_bytes(), b"-Y 1 +X 3\n", &[128, 64, 32, 129, 255, 0, 0, 136, 9, 9, 9, 0]].concat();
    let frame = Frame::decode(&bytes).unwrap();
    assert_eq!((frame.width(), frame.height()), (3, 1));
    assert_eq!(frame.color(), [[1.0, 0.5, 0.25], [255.0, 0.0, 0.0], [0.0; 3]]);
}

#[test]
fn runs_of_radiance_pictures_are_unfolded() {
    // By channel: 8 times 128; 3 times 0 and 5 numbers; 8 numbers; 8 times 129.
    let row = [&[2, 2, 0, 8, 136, 128, 131, 0, 5, 1, 2, 3, 4, 5, 8, 8, 7, 6, 5, 4, 3, 2, 1][..], &[136, 129]].concat();
    let bytes = [HEADER.as_bytes(), b"-Y 2 +X 8\n", &row, &row].concat();
    let frame = Frame::decode(&bytes).unwrap();
    let color = |g: f32, b: f32| [1.0, g / 128.0, b / 128.0];
    assert_eq!(frame.color()[..4], [color(0.0, 8.0), color(0.0, 7.0), color(0.0, 6.0), color(1.0, 5.0)]);
    assert_eq!(frame.color()[8..], frame.color()[..8]);
    // The older way: the last pixel 2 and 256 times more.
    let old = [&[128, 128, 128, 129, 1, 1, 1, 2, 1, 1, 1, 1][..]].concat();
    let bytes = [HEADER.as_bytes(), b"-Y 1 +X 259\n", &old].concat();
    assert_eq!(Frame::decode(&bytes).unwrap().color(), [[1.0; 3]; 259]);
}

#[test]
fn exposures_of_radiance_pictures_are_taken_back() {
    let text = "#?RGBE\nEXPOSURE=4\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 0.5\n\n-Y 1 +X 1\n";
    assert_eq!(Frame::decode(&[text.as_bytes(), &[128, 128, 128, 130]].concat()).unwrap().color(), [[1.0; 3]]);
}

#[test]
fn damaged_radiance_pictures_are_refused() {
    let size = "-Y 1 +X 8\n";
    let cases: [(&str, &[u8], &str); 9] = [
        ("#?RADIANCE\n", b"", "header does not end"),
        ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", b"", "32-bit_rle_xyze"),
        ("#?RADIANCE\nEXPOSURE=0\n\n", b"", "EXPOSURE"),
        ("#?RADIANCE\n\n+Y 1 +X 8\n", b"", "+Y 1 +X 8"),
        ("#?RADIANCE\n\n-Y 99999999 +X 99999999\n", b"", "its size is not"),
        ("#?RADIANCE\n\n-Y 99999 +X 2000\n", b"abcd", "truncated"),
        ("", &[2, 2, 0, 8, 137, 1], "longer than the picture"),
        ("", &[2, 2, 0, 8, 0], "longer than the picture"),
        ("", &[1, 1, 1, 9], "repetition"),
    ];
    for (header, data, message) in cases {
        let header = if header.is_empty() { format!("{HEADER}{size}") } else { header.to_owned() };
        let error = Frame::decode(&[header.as_bytes(), data].concat()).unwrap_err();
        assert!(matches!(error, DecodeError::Radiance { .. }), "{error}");
        assert!(error.to_string().contains(message), "{error}");
    }
}

#[test]
fn blenders_layers_are_read() {
    let name = |layer: &str, channel: &str| format!("{layer}.{channel}");
    let mut channels = Vec::new();
    for (layer, first) in [("ViewLayer.Combined", 2.0), ("ViewLayer.DiffDir", 7.0)] {
        channels.extend([("R", 0.0), ("G", 1.0), ("B", 2.0)].map(|(it, more)| (name(layer, it), [first + more, 0.0])));
    }
    channels.extend([(name("ViewLayer.Combined", "A"), [0.5, 1.0]), (name("ViewLayer.Depth", "Z"), [1.0, 2.0])]);
    let borrowed: Vec<_> = channels.iter().map(|(name, values)| (&**name, *values)).collect();
    let frame = Frame::decode(&exr(&borrowed)).unwrap();
    assert_eq!(frame.color(), [[2.0, 3.0, 4.0], [0.0; 3]]);
    assert_eq!(frame.alpha(), Some(&[0.5, 1.0][..]));
    // One layer of any name will do, but not one of several.
    let one = [("beauty.R", [1.0, 2.0]), ("beauty.G", [3.0, 4.0]), ("beauty.B", [5.0, 6.0])];
    assert_eq!(Frame::decode(&exr(&one)).unwrap().color(), [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
    let other = [("a.R", [1.0; 2]), ("a.G", [1.0; 2]), ("a.B", [1.0; 2])];
    let error = Frame::decode(&exr(&[&one[..], &other].concat())).unwrap_err().to_string();
    assert!(error.contains("a.B, a.G, a.R, beauty.B"), "{error}");
}

#[test]
fn a_single_channel_is_grey() {
    let frame = Frame::decode(&exr(&[("hours", [7.5, 0.25]), ("A", [1.0, 0.0])])).unwrap();
    assert_eq!(frame.color(), [[7.5; 3], [0.25; 3]]);
    assert_eq!(frame.alpha(), Some(&[1.0, 0.0][..]));
    assert!(Frame::decode(&exr(&[("u", [7.5, 0.25]), ("v", [1.0, 0.0])])).is_err());
}

#[test]
fn files_say_whether_their_values_have_a_limit() {
    let folder = tempfile::tempdir().unwrap();
    let frame = Frame::new(1, 1, vec![[0.5; 3]]).unwrap();
    for (name, range) in [("a.png", Range::Display), ("a.jpg", Range::Display), ("a.exr", Range::Light)] {
        frame.save(folder.path().join(name)).unwrap();
        assert_eq!(Frame::load_with_range(folder.path().join(name)).unwrap().1, range, "{name}");
    }
    let hdr = folder.path().join("a.hdr");
    fs::write(&hdr, [HEADER.as_bytes(), b"-Y 1 +X 1\n", &[128, 128, 128, 130]].concat()).unwrap();
    let (frame, range) = Frame::load_with_range(&hdr).unwrap();
    assert_eq!((frame.color(), range), (&[[2.0; 3]][..], Range::Light));
}
