//! Textures. A scene is rendered without textures that cannot be read, so all of these open.

use crate::input::Expected::Opens;
use crate::input::{Input, lengths, patched};

const SCENE: &str = "[[material]]\nname = \"a\"\ntexture = \"picture\"\n\
                     [[triangle]]\na = [0, 0, 0]\nb = [1, 0, 0]\nc = [0, 1, 0]\nmaterial = \"a\"\n";

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Offset of the data of the chunk that holds the size.
const HEADER: usize = 16;

/// Two by two texels of 24 bits.
const BMP: &[u8] = b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0\0\0\0\0\x10\0\0\0\
    \0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xff\0\0\xff\xff\xff\0\0\0\0\xff\0\xff\0\0\0";
/// Offsets of width, height, bits and compression in a BMP file.
const BMP_WORDS: [(&str, usize); 4] = [("width", 18), ("height", 22), ("bits", 28), ("compression", 30)];
/// Two by two grey texels.
const TGA: &[u8] = &[0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 8, 0x20, 10, 20, 30, 40];

pub(crate) fn inputs() -> Vec<Input> {
    let png = png(2, 2, 8);
    let mut all = vec![shown("PNG as it should be", "a.png", &png)];
    for (what, name, whole) in [("PNG", "a.png", &png[..]), ("BMP", "a.bmp", BMP), ("TGA", "a.tga", TGA)] {
        all.extend(lengths(whole).map(|length| shown(format!("{what} cut after {length}"), name, &whole[..length])));
    }
    for (width, height, depth) in
        [(0, 2, 8), (2, u32::MAX, 8), (i32::MAX as u32, i32::MAX as u32, 8), (16_384, 16_384, 16), (2, 2, 3), (3, 3, 8)]
    {
        all.push(shown(
            format!("PNG of {width} x {height} of {depth} bits"),
            "a.png",
            &self::png(width, height, depth),
        ));
    }
    for (what, at) in BMP_WORDS {
        all.extend([0, u32::MAX, i32::MIN as u32, 1 << 20].map(|value| {
            shown(format!("BMP whose {what} is {value}"), "a.bmp", &patched(BMP, at, &value.to_le_bytes()))
        }));
    }
    all.extend([
        shown("a wrong check sum", "a.png", &patched(&png, HEADER, &[1])),
        shown("TGA of 65535 x 65535", "a.tga", &patched(TGA, 12, &[0xff; 4])),
        shown("TGA of an unknown kind", "a.tga", &patched(TGA, 2, &[99])),
        shown("JPEG of three markers", "a.jpg", b"\xff\xd8\xff\xe0\0\x02\xff\xd9"),
        shown("GIF", "a.png", b"GIF89a\x01\0\x01\0"),
        shown("a page", "a.png", b"<html>"),
        shown("empty", "a.png", b""),
        shown("zeros", "a.tga", &[0; 4096]),
        shown("noise", "a.jpg", &[0xff; 4096]),
    ]);
    all
}

/// A triangle with this texture.
fn shown(oddity: impl ToString, name: &str, bytes: &[u8]) -> Input {
    let scene = SCENE.replace("picture", name);
    let mut input = Input::new("toml", oddity, scene, Opens).beside(name, bytes);
    input.name = input.name.replacen("toml", "texture", 1);
    input
}

/// A PNG file of 2 x 2 grey texels, whose header may claim another size.
fn png(width: u32, height: u32, depth: u8) -> Vec<u8> {
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes(), &[depth, 0, 0, 0, 0]].concat();
    // Zlib around one stored block: two rows of a filter byte and two texels.
    let rows = [0, 10, 20, 0, 30, 40];
    let (sum, sums) = rows.iter().fold((1_u32, 0_u32), |(sum, sums), &byte| (sum + byte, sums + sum + byte));
    let stored =
        [&[0x78, 0x01, 1, 6, 0, 0xf9, 0xff][..], &rows.map(|byte| byte as u8), &(sums << 16 | sum).to_be_bytes()];
    [SIGNATURE, &chunk(b"IHDR", &header), &chunk(b"IDAT", &stored.concat()), &chunk(b"IEND", &[])].concat()
}

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let content = [&kind[..], data].concat();
    [&(data.len() as u32).to_be_bytes()[..], &content, &crc_32(&content).to_be_bytes()].concat()
}

fn crc_32(bytes: &[u8]) -> u32 {
    const REVERSED_POLYNOMIAL: u32 = 0xedb8_8320;
    let bit = |crc: u32, _| crc >> 1 ^ if crc & 1 == 1 { REVERSED_POLYNOMIAL } else { 0 };
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), bit))
}
