//! Images as `lightmesh compare` reads them: PNG, EXR, HDR and BMP, recognised by their first bytes. (JPEG is the decoder of `texture`.)
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightmesh::image::{Frame, Transfer, compare};
use lightmesh_fuzz::check_message;

/// Larger images take too long.
const MAX_PIXELS: u64 = 1 << 20;
/// FLIP takes longer than reading.
const COMPARED: usize = 1 << 10;

fuzz_target!(|bytes: &[u8]| {
    if bytes.starts_with(b"\xff\xd8") || stated_pixels(bytes).is_some_and(|pixels| pixels > MAX_PIXELS) {
        return;
    }
    match Frame::decode(bytes) {
        Ok(frame) => check(&frame),
        Err(error) => check_message(&error.to_string()),
    }
});

/// The number of pixels in the header of a PNG, an HDR or a BMP: a few bytes can truly be a large image in one colour. An EXR cannot.
fn stated_pixels(bytes: &[u8]) -> Option<u64> {
    let number = |at: usize| bytes.get(at..at + 4)?.first_chunk().copied();
    let [width, height] = if bytes.starts_with(b"BM") {
        [number(18)?, number(22)?].map(|side| i32::from_le_bytes(side).unsigned_abs())
    } else if bytes.starts_with(b"\x89PNG") {
        [number(16)?, number(20)?].map(u32::from_be_bytes)
    } else if bytes.starts_with(b"#?") {
        let text = String::from_utf8_lossy(bytes);
        let size = text.split("\n-Y ").nth(1)?.lines().next()?.replace("+X", "");
        let mut sides = size.split_ascii_whitespace().map(|side| side.parse().unwrap_or(0));
        [sides.next()?, sides.next()?]
    } else {
        return None;
    };
    Some(u64::from(width) * u64::from(height))
}

fn check(frame: &Frame) {
    let pixels = frame.color().len();
    assert!(pixels > 0 && pixels as u64 == u64::from(frame.width()) * u64::from(frame.height()));
    if let Some(layers) = frame.layers() {
        assert!([layers.depth.len(), layers.used.len(), layers.normal.len(), layers.position.len()] == [pixels; 4]);
        assert!(layers.visibility.iter().all(|light| light.len() == pixels));
    }
    if pixels > COMPARED {
        return;
    }
    match compare(frame, frame) {
        Ok(same) => assert!(same.rmse == 0.0 && same.mean_flip == 0.0 && same.max_difference == 0.0, "{same:?}"),
        Err(error) => check_message(&error.to_string()),
    }
    let shown = Frame::decode(&frame.to_png().expect("a small image fits")).expect("what was written can be read");
    // Codes of colours are those that files store: not multiplied by alpha, which has eight bits, too.
    if let (Some(kept), Some(alpha)) = (shown.alpha(), frame.alpha()) {
        let near = |(kept, alpha): (&f32, &f32)| (kept - alpha.clamp(0.0, 1.0)).abs() < 0.51 / 255.0 || alpha.is_nan();
        assert!(kept.iter().zip(alpha).all(near), "{alpha:?}, not {kept:?}");
        return;
    }
    let codes =
        |frame: &Frame| frame.color().iter().map(|color| color.map(|value| Transfer::Srgb.encode(value))).collect();
    let codes: [Vec<_>; 2] = [codes(&shown), codes(frame)];
    assert_eq!(codes[0], codes[1]);
}
