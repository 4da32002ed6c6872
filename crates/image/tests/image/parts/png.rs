use lightmesh_image::internals::png::{read, write, write_indexed};
use lightmesh_image::internals::transfer::decode16;
use lightmesh_image::{Display, Frame, Transfer};
use png::{BitDepth, ColorType, Encoder};

fn encode(color: ColorType, depth: BitDepth, samples: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    bytes
}

/// A few bytes do not take gigabytes.
#[test]
fn a_header_that_promises_too_much_is_refused() {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, 16_384, 16_384);
    encoder.set_color(ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer.write_chunk(png::chunk::IDAT, &[0x78, 1]).unwrap();
    drop(writer);
    let refused = read(&bytes).unwrap_err().to_string();
    assert!(refused.contains("16384x16384 pixels cannot be stored in "), "{refused}");
}

#[test]
fn the_transfer_function_is_marked() {
    let frame = Frame::new(1, 1, vec![[0.2; 3]]).unwrap();
    for (transfer, chunk) in [(Transfer::Srgb, &b"sRGB\0"[..]), (Transfer::Linear, b"gAMA\0\x01\x86\xa0")] {
        let mut bytes = Vec::new();
        write(&frame, &Display::default().with_transfer(transfer), &mut bytes).unwrap();
        assert!(bytes.windows(chunk.len()).any(|window| window == chunk), "{transfer:?}");
        let expected = transfer.decode(transfer.encode(0.2));
        assert_eq!(read(&bytes).unwrap().color(), [[expected; 3]], "{transfer:?}");
    }
}

#[test]
fn a_palette_holds_256_colours_and_no_more() {
    for (colors, is_indexed) in [(256, true), (257, false)] {
        // Each colour twice.
        let code = |index: usize| (index % colors % 256) as u8;
        let color = |index| [code(index), 7, (index % colors / 256) as u8].map(|code| Transfer::Srgb.decode(code));
        let frame = Frame::new(2, colors as u32, (0..2 * colors).map(color).collect()).unwrap();
        let mut bytes = Vec::new();
        assert_eq!(write_indexed(&frame, &mut bytes).unwrap(), is_indexed);
        assert_eq!(bytes.is_empty(), !is_indexed);
        assert_eq!(read(&frame.to_small_png().unwrap()).unwrap().color(), frame.color(), "{colors}");
    }
}

#[test]
fn grey_alpha_and_sixteen_bits_are_read() {
    let decode = |code| Transfer::Srgb.decode(code);
    let grey = read(&encode(ColorType::Grayscale, BitDepth::Eight, &[50, 200])).unwrap();
    assert_eq!(grey.color(), [[decode(50); 3], [decode(200); 3]]);

    let rgba = read(&encode(ColorType::Rgba, BitDepth::Eight, &[1, 2, 3, 4, 5, 6, 7, 8])).unwrap();
    let share = |code: u8| f32::from(code) / 255.0;
    let expected = [[1, 2, 3].map(|code| decode(code) * share(4)), [5, 6, 7].map(|code| decode(code) * share(8))];
    assert_eq!((rgba.color(), rgba.alpha()), (&expected[..], Some(&[share(4), share(8)][..])));

    let wide = read(&encode(ColorType::Grayscale, BitDepth::Sixteen, &[0x80, 0x00, 0xff, 0xff])).unwrap();
    assert_eq!(wide.color(), [[decode16(Transfer::Srgb, 0x8000); 3], [1.0; 3]]);
}
