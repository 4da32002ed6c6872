use lightmesh_image::internals::bmp::{Layout, write};
use lightmesh_image::{Display, Frame, Transfer};

fn encode(width: u32, height: u32, color: Vec<[f32; 3]>) -> Vec<u8> {
    let mut bytes = Vec::new();
    let display = Display::default().with_transfer(Transfer::Linear);
    write(&Frame::new(width, height, color).unwrap(), &display, &mut bytes).unwrap();
    bytes
}

#[test]
fn every_byte_of_a_small_picture() {
    let color = (0..6).map(|pixel| [1, 2, 3].map(|channel| (pixel * 10 + channel) as f32 / 255.0)).collect();
    #[rustfmt::skip]
    let expected = [
        b'B', b'M', 78, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0,
        40, 0, 0, 0, 3, 0, 0, 0, 2, 0, 0, 0, 1, 0, 24, 0, 0, 0, 0, 0, 24, 0, 0, 0,
        0x13, 0x0b, 0, 0, 0x13, 0x0b, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
        33, 32, 31, 43, 42, 41, 53, 52, 51, 0, 0, 0,
        3, 2, 1, 13, 12, 11, 23, 22, 21, 0, 0, 0,
    ];
    assert_eq!(encode(3, 2, color), expected);
}

#[test]
fn rows_are_padded_to_four_bytes() {
    for (width, row) in [(1, 4), (2, 8), (3, 12), (4, 12), (5, 16), (6, 20), (7, 24), (8, 24)] {
        let bytes = encode(width, 3, vec![[1.0; 3]; 3 * width as usize]);
        assert_eq!(bytes.len(), 54 + 3 * row, "width {width}");
        let padding = &bytes[54 + 3 * width as usize..54 + row];
        assert!(padding.iter().all(|&byte| byte == 0), "width {width}");
    }
}

#[test]
fn sizes_beyond_32_bits_are_refused() {
    assert!(Layout::new(37_837, 37_837).is_some_and(|layout| layout.file > 4_000_000_000));
    assert!(Layout::new(37_838, 37_838).is_none());
    assert!(Layout::new(u32::MAX, 1).is_none());
    assert!(Layout::new(1, u32::MAX).is_none());
    assert!(Layout::new(u32::MAX, u32::MAX).is_none());
}
