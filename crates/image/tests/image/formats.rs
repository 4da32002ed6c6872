//! Round trips in every format; damaged files are rejected.

use std::fs;

use crate::pictures::{coded, layered, ramp};
use lightmesh_image::{DecodeError, Format, Frame, LoadError, Transfer, compare};
use tempfile::tempdir;

/// Sizes that need every kind of row padding, and more rows than an exr block.
const SIZES: [(u32, u32); 7] = [(1, 1), (2, 3), (3, 2), (5, 7), (7, 5), (16, 40), (33, 17)];

fn saved(frame: &Frame, name: &str) -> Vec<u8> {
    let folder = tempdir().unwrap();
    let path = folder.path().join(name);
    frame.save(&path).unwrap();
    fs::read(&path).unwrap()
}

#[test]
fn lossless_formats_return_every_code() {
    for (width, height) in SIZES {
        let frame = coded(width, height);
        for name in ["a.bmp", "a.png", "a.exr"] {
            assert_eq!(Frame::decode(&saved(&frame, name)).unwrap(), frame, "{name} {width}x{height}");
        }
    }
}

/// Every code, in no order that compresses.
fn noise(width: u32, height: u32) -> Frame {
    let code = |index: u32| Transfer::Srgb.decode((index.wrapping_mul(2_654_435_761) >> 24) as u8);
    let color = (0..width * height).map(|pixel| [0, 1, 2].map(|channel| code(3 * pixel + channel))).collect();
    Frame::new(width, height, color).unwrap()
}

/// Some are compressed in more parts than are held in memory at once.
#[test]
fn large_pictures_are_joined_from_their_parts() {
    for (name, width, height) in [("a.png", 1000, 6000), ("a.png", 100_000, 3), ("a.exr", 40, 1100)] {
        for frame in [noise(width, height), ramp(width, height)] {
            let loaded = Frame::decode(&saved(&frame, name)).unwrap();
            let codes =
                |frame: &Frame| frame.color().iter().map(|c| c.map(|v| Transfer::Srgb.encode(v))).collect::<Vec<_>>();
            assert!(codes(&loaded) == codes(&frame), "{name} {width}x{height}");
        }
    }
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let frame = layered(700, 900);
    let written = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let folder = tempdir().unwrap();
            let path = folder.path().join("layers.exr");
            frame.save_layers(&path).unwrap();
            [fs::read(&path).unwrap(), saved(&frame, "a.png"), saved(&frame, "a.exr")]
        })
    };
    let alone = written(1);
    assert!([2, 5].into_iter().all(|threads| written(threads) == alone));
}

#[test]
fn exr_returns_every_float() {
    let color = [[-1.5, 1e30, f32::INFINITY], [f32::MIN_POSITIVE, 0.1, -0.0], [1e-42, 65_505.0, 3.0]];
    let frame = Frame::new(3, 1, color.to_vec()).unwrap();
    assert_eq!(Frame::decode(&saved(&frame, "a.exr")).unwrap(), frame);
}

#[test]
fn jpg_returns_nearly_the_same() {
    for (width, height) in [(16, 40), (33, 17)] {
        let frame = ramp(width, height);
        let loaded = Frame::decode(&saved(&frame, "a.jpg")).unwrap();
        let comparison = compare(&frame, &loaded).unwrap();
        assert!(comparison.rmse < 0.02, "{comparison:?}");
        assert!(comparison.rmse > 0.0, "a lossy format must lose something");
    }
}

#[test]
fn linear_codes_are_proportional_to_the_values() {
    let folder = tempdir().unwrap();
    let frame = Frame::new(1, 1, vec![[0.2, 0.4, 1.0]]).unwrap();
    let path = folder.path().join("linear.bmp");
    frame.save_with(&path, Transfer::Linear).unwrap();
    assert_eq!(fs::read(&path).unwrap()[54..57], [255, 102, 51]);

    let path = folder.path().join("linear.png");
    frame.save_with(&path, Transfer::Linear).unwrap();
    assert_eq!(Frame::load(&path).unwrap().color(), [[0.2, 0.4, 1.0]]);
}

#[test]
fn layers_return_with_the_colours() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("layers.exr");
    let frame = layered(33, 17);
    frame.save_layers(&path).unwrap();
    assert_eq!(Frame::load(&path).unwrap(), frame);
}

#[test]
fn the_contents_count_and_not_the_name() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("is-a-bitmap.png");
    fs::write(&path, saved(&coded(3, 2), "a.bmp")).unwrap();
    assert_eq!(Frame::load(&path).unwrap(), coded(3, 2));
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    for name in ["a.bmp", "a.png", "a.exr", "a.jpg"] {
        let bytes = saved(&coded(19, 18), name);
        assert!(Frame::decode(&bytes).is_ok(), "{name}");
        let powers = (0..).map(|power| 1 << power).take_while(|&length| length < bytes.len());
        let ends = (1..bytes.len()).step_by(7);
        for length in powers.chain(ends).chain([0, bytes.len() - 1]) {
            assert!(Frame::decode(&bytes[..length]).is_err(), "{name} of {} bytes, cut at {length}", bytes.len());
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    for name in ["a.bmp", "a.png", "a.exr", "a.jpg"] {
        let bytes = saved(&coded(5, 4), name);
        for position in 0..bytes.len().min(400) {
            for value in [0x00, 0x7f, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[position] = value;
                // Some damage goes unnoticed, such as a changed colour; here it only matters that nothing panics.
                if let Ok(frame) = Frame::decode(&damaged) {
                    assert_eq!(frame.color().len(), frame.width() as usize * frame.height() as usize);
                }
            }
        }
    }
}

#[test]
fn absurd_sizes_are_refused_by_the_header() {
    let mut bmp = saved(&coded(2, 2), "a.bmp");
    bmp[18..22].copy_from_slice(&40_000_i32.to_le_bytes());
    bmp[22..26].copy_from_slice(&30_000_i32.to_le_bytes());
    let error = Frame::decode(&bmp).unwrap_err();
    assert_eq!(error, DecodeError::TooLarge { format: Format::Bmp, width: 40_000, height: 30_000 });

    let sized = |side: i32, chunks: i32| {
        let mut exr = saved(&coded(2, 2), "a.exr");
        let mut put = |name: &[u8], skip: usize, value: i32| {
            let at = exr.windows(name.len()).position(|window| window == name).unwrap() + name.len() + skip;
            exr[at..at + 4].copy_from_slice(&value.to_le_bytes());
        };
        put(b"dataWindow\0box2i\0\x10\0\0\0", 8, side - 1);
        put(b"dataWindow\0box2i\0\x10\0\0\0", 12, side - 1);
        put(b"chunkCount\0int\0\x04\0\0\0", 0, chunks);
        Frame::decode(&exr).unwrap_err()
    };
    assert_eq!(sized(40_000, 2_500), DecodeError::TooLarge { format: Format::Exr, width: 40_000, height: 40_000 });
    let error = sized(10_000, 625);
    assert!(error.to_string().contains("channels of 1200000000 bytes cannot be stored in"), "{error}");
}

#[test]
fn what_is_no_picture_is_named() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("notes.png");
    fs::write(&path, "no picture").unwrap();
    let error = Frame::load(&path).unwrap_err();
    assert!(matches!(&error, LoadError::Decode { reason: DecodeError::UnknownFormat, .. }), "{error}");
    assert!(error.to_string().contains("notes.png") && error.to_string().contains("bmp, png"), "{error}");

    let missing = Frame::load(folder.path().join("missing.png")).unwrap_err();
    assert!(matches!(&missing, LoadError::Read { .. }), "{missing}");
    assert!(matches!(Frame::load(folder.path()).unwrap_err(), LoadError::Read { .. }));
}
