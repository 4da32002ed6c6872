use std::io::Cursor;

use image::{DynamicImage, GrayImage, ImageBuffer, ImageFormat, Luma, Rgb, Rgba};
use lightmesh_memory::Budget;
use lightmesh_scene::Texture;
use lightmesh_scene::internals::texture::{self, Undecodable};

fn decode(name: &str, bytes: &[u8]) -> Result<Texture, String> {
    texture::decode(name, bytes, Budget::default()).map_err(|error| match error {
        Undecodable::Odd(reason) => reason,
        Undecodable::TooLarge { size, short } => format!("{size:?}: {short}"),
    })
}

/// Two by two texels that JPEG preserves well, each a different grey.
fn grey() -> DynamicImage {
    GrayImage::from_fn(2, 2, |x, y| Luma([(40 + 50 * x + 100 * y) as u8])).into()
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

const FORMATS: [(ImageFormat, &str); 4] = [
    (ImageFormat::Png, "a.png"),
    (ImageFormat::Jpeg, "a.jpg"),
    (ImageFormat::Bmp, "a.bmp"),
    (ImageFormat::Tga, "a.TGA"),
];

#[test]
fn every_format_is_read_with_its_first_row_at_the_top() {
    for (format, name) in FORMATS {
        let texture = decode(name, &encoded(&grey(), format)).unwrap();
        assert_eq!((texture.name.as_str(), texture.size), (name, [2, 2]));
        for (texel, wanted) in texture.texels.iter().zip([40u8, 90, 140, 190]) {
            let near = texel[..3].iter().all(|&value| value.abs_diff(wanted) < 4);
            assert!(near && texel[3] == 255, "{format:?}: {:?}", texture.texels);
        }
    }
}

#[test]
fn sixteen_bits_and_coverage_become_eight() {
    let deep: DynamicImage = ImageBuffer::from_pixel(1, 1, Rgb([0u16, 0x8000, 0xffff])).into();
    assert_eq!(decode("", &encoded(&deep, ImageFormat::Png)).unwrap().texels, [[0, 128, 255, 255]]);
    let clear: DynamicImage = ImageBuffer::from_pixel(1, 1, Rgba([1u8, 2, 3, 4])).into();
    assert_eq!(decode("", &encoded(&clear, ImageFormat::Png)).unwrap().texels, [[1, 2, 3, 4]]);
}

#[test]
fn palettes_are_resolved() {
    // A BMP file of one texel with one bit, and two colours: blue-green-red-0 each.
    let mut bytes = b"BM\x42\0\0\0\0\0\0\0\x3e\0\0\0\x28\0\0\0\x01\0\0\0\x01\0\0\0\x01\0\x01\0".to_vec();
    bytes.extend([0; 16]);
    bytes.extend([2, 0, 0, 0, 0, 0, 0, 0]);
    bytes.extend([9, 9, 9, 0, 30, 20, 10, 0, 0x80, 0, 0, 0]);
    assert_eq!(decode("", &bytes).unwrap().texels, [[10, 20, 30, 255]]);
}

#[test]
fn a_truncated_picture_is_an_error_wherever_it_ends() {
    for (format, name) in FORMATS {
        let whole = encoded(&grey(), format);
        // After the last texel there may be a footer that is not needed.
        let needed = match format {
            ImageFormat::Png => whole.len() - 16,
            ImageFormat::Tga => 18 + 4,
            _ => whole.len(),
        };
        for length in 0..needed {
            let answer = decode(name, &whole[..length]);
            assert!(answer.is_err(), "{format:?}, {length} of {} bytes: {answer:?}", whole.len());
        }
    }
}

#[test]
fn what_is_no_picture_or_no_known_one_is_said() {
    assert_eq!(decode("oak.png", b"<html>").unwrap_err(), "it is not a PNG, JPEG, BMP or TGA image");
    assert_eq!(decode("oak.png", b"GIF89a").unwrap_err(), "it is a GIF image; supported: PNG, JPEG, BMP and TGA");
}

#[test]
fn a_header_alone_takes_no_memory() {
    let mut bytes = encoded(&grey(), ImageFormat::Tga);
    bytes[12..16].copy_from_slice(&[0, 64, 0, 64]);
    let reason = decode("a.tga", &bytes).unwrap_err();
    assert!(reason.starts_with("its header says 16384 x 16384 texels, too many for"), "{reason}");
    bytes[12..16].copy_from_slice(&[1, 64, 1, 0]);
    assert!(decode("a.tga", &bytes).unwrap_err().starts_with("it has 16385 x 1 texels"));
    bytes[12..16].copy_from_slice(&[0, 0, 1, 0]);
    assert!(decode("a.tga", &bytes).is_err());
}

/// A few kilobytes that would be a gigabyte in memory.
#[test]
fn texels_that_do_not_fit_are_refused_before_they_are_decoded() {
    let plain: DynamicImage = GrayImage::new(16384, 4096).into();
    let bytes = encoded(&plain, ImageFormat::Png);
    assert!(bytes.len() < 1 << 20);
    let limit = Budget::new(Some(lightmesh_memory::held() + (128 << 20)));
    match texture::decode("a.png", &bytes, limit) {
        Err(Undecodable::TooLarge { size: [16384, 4096], short }) => assert_eq!(short.needed, 5 << 26),
        other => panic!("{:?}", other.map(|texture| texture.size)),
    }
}
