//! GLB files: a container around the JSON of glTF.

use crate::gltf::{CORNERS, bytes, square, text};
use crate::input::Expected::{Opens, Refused};
use crate::input::{Input, cut, patched};

/// Offset of the container's content type.
const VERSION: usize = 4;
const LENGTH: usize = 8;
const JSON_LENGTH: usize = 12;
const JSON_KIND: usize = 16;

pub(crate) fn inputs() -> Vec<Input> {
    let json = text(&square(false));
    let whole = glb(json.as_bytes(), Some(&bytes()));
    let bin = JSON_LENGTH + 8 + json.len().next_multiple_of(4);
    let word = |at: usize, value: u32| patched(&whole, at, &value.to_le_bytes());
    let mut all = cut("glb", "square", &whole);
    all.extend([
        Input::new("glb", "a square as it should be", &whole, Opens),
        Input::new("glb", "empty", "", Refused),
        Input::new("glb", "JSON as in a glTF file", text(&square(true)), Opens),
        Input::new("glb", "version 1", word(VERSION, 1), Refused),
        Input::new("glb", "version 2^32 - 1", word(VERSION, u32::MAX), Refused),
        Input::new("glb", "length in the other byte order", word(LENGTH, (whole.len() as u32).swap_bytes()), Refused),
        Input::new("glb", "JSON chunk of another kind", patched(&whole, JSON_KIND, b"NOSJ"), Refused),
        Input::new("glb", "second chunk of another kind", patched(&whole, bin + 4, b"NIB\0"), Refused),
        Input::new("glb", "no second chunk", glb(json.as_bytes(), None), Refused),
        Input::new("glb", "an empty second chunk", glb(json.as_bytes(), Some(&[])), Refused),
        Input::new("glb", "a JSON chunk of zeros", glb(&[0; 64], Some(&bytes())), Refused),
        Input::new("glb", "an empty JSON chunk", glb(b"", Some(&bytes())), Refused),
        Input::new("glb", "bytes behind the last chunk", [&whole[..], &[0xff; 5]].concat(), Opens),
        Input::new("glb", "an index beyond the end", patched(&whole, bin + 8 + CORNERS, &[4, 0]), Refused),
        Input::new("glb", "a NaN coordinate", patched(&whole, bin + 8, &f32::NAN.to_le_bytes()), Opens),
        Input::new("glb", "an infinite coordinate", patched(&whole, bin + 8, &f32::INFINITY.to_le_bytes()), Opens),
        Input::new("glb", "a huge coordinate", patched(&whole, bin + 8, &f32::MAX.to_le_bytes()), Opens),
    ]);
    for (what, at) in [("file", LENGTH), ("JSON chunk", JSON_LENGTH), ("second chunk", bin)] {
        all.extend(
            [0, 1, 11, 12, 1 << 31, u32::MAX]
                .map(|length| Input::new("glb", format!("a {what} of {length} bytes"), word(at, length), Refused)),
        );
    }
    all
}

/// A GLB file with these chunks.
fn glb(json: &[u8], bin: Option<&[u8]>) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], data: &[u8], padding: u8| {
        let data = [data, &vec![padding; data.len().wrapping_neg() % 4]].concat();
        [&(data.len() as u32).to_le_bytes(), &kind[..], &data].concat()
    };
    let chunks = [chunk(b"JSON", json, b' '), bin.map_or(Vec::new(), |bin| chunk(b"BIN\0", bin, 0))].concat();
    [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes(), &chunks].concat()
}
