//! STL files, as text and binary.

use crate::input::Expected::{self, Either, Opens, Refused};
use crate::input::{Input, cut, patched, utf_16};

const TEXT: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

/// Offset of the number of facets in a binary file.
const COUNT: usize = 80;
/// Offset of the first corner of the first facet.
const CORNER: usize = 96;

/// Parts of the text, their replacements, and the expected outcome.
const WORDS: [(&str, &str, Expected); 16] = [
    ("vertex 1 0 0", "vertex nan 0 0", Opens),
    ("vertex 1 0 0", "vertex inf 0 0", Opens),
    ("vertex 1 0 0", "vertex 1e308 0 0", Opens),
    ("vertex 1 0 0", "vertex 1 0", Refused),
    ("vertex 1 0 0", "vertex x 0 0", Refused),
    ("vertex 1 0 0\n", "", Opens),
    ("normal 0 0 1", "normal nan inf x", Opens),
    ("normal 0 0 1", "", Opens),
    ("endfacet\n", "", Refused),
    ("endsolid a\n", "", Opens),
    ("facet normal", "facets normal", Refused),
    ("solid a", "solid a\0b", Opens),
    ("solid a", "solid \u{1b}[31m", Opens),
    ("solid a\n", "", Opens),
    ("solid a\n", "\u{1b}[31m\nsolid a\n", Opens),
    ("endfacet\n", "endfacet\ncolor 1 0 0\n", Opens),
];

pub(crate) fn inputs() -> Vec<Input> {
    let mut all = cut("stl", "text", TEXT.as_bytes());
    all.extend(cut("stl", "binary", &binary(2, 2)));
    all.extend(WORDS.map(|(part, odd, expected)| {
        let oddity = format!("`{}` for `{}`", odd.escape_debug(), part.escape_debug());
        Input::new("stl", oddity, TEXT.replacen(part, odd, 1), expected)
    }));
    all.extend(binaries());
    all.extend(texts());
    all
}

/// A number of facets, for which the header may claim another number.
fn binary(said: u32, facets: usize) -> Vec<u8> {
    let numbers: [f32; 12] = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut facet: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    facet.extend([0; 2]);
    [&[b'-'; COUNT][..], &said.to_le_bytes(), &facet.repeat(facets)].concat()
}

fn binaries() -> Vec<Input> {
    let one = binary(1, 1);
    let number = |value: f32| patched(&one, CORNER, &value.to_le_bytes());
    let beginning = |text: &[u8]| patched(&one, 0, text);
    vec![
        Input::new("stl", "one facet", &one, Opens),
        Input::new("stl", "no facets", binary(0, 0), Opens),
        Input::new("stl", "no facets in the header", binary(0, 2), Opens),
        Input::new("stl", "2^32 - 1 facets", binary(u32::MAX, 1), Refused),
        Input::new("stl", "2^31 facets", binary(1 << 31, 1), Refused),
        Input::new("stl", "one facet too few", binary(2, 1), Refused),
        Input::new("stl", "one facet too many", binary(1, 2), Opens),
        Input::new("stl", "bytes behind the facets", [&one[..], b"more"].concat(), Opens),
        Input::new("stl", "a big-endian count", binary(1_u32.swap_bytes(), 1), Refused),
        Input::new("stl", "a header alone", &one[..COUNT], Refused),
        Input::new("stl", "a NaN coordinate", number(f32::NAN), Opens),
        Input::new("stl", "an infinite coordinate", number(f32::NEG_INFINITY), Opens),
        Input::new("stl", "a huge coordinate", number(f32::MAX), Opens),
        Input::new("stl", "a tiny coordinate", number(f32::from_bits(1)), Opens),
        Input::new("stl", "binary that begins like text", beginning(b"solid a\nfacet normal"), Opens),
        Input::new("stl", "cut binary that begins like text", &beginning(b"solid a")[..100], Refused),
        Input::new("stl", "zeros", [0; 512], Either),
        Input::new("stl", "ones", [0xff; 512], Refused),
    ]
}

fn texts() -> [Input; 8] {
    let corners = TEXT.replacen("vertex 0 1 0\n", &"vertex 0 1 0\nvertex 1 1 0\n".repeat(50_000), 1);
    [
        Input::new("stl", "empty", "", Refused),
        Input::new("stl", "a solid without facets", "solid\nendsolid\n", Opens),
        Input::new("stl", "byte order mark", format!("\u{feff}{TEXT}"), Opens),
        Input::new("stl", "UTF-16", utf_16(TEXT), Refused),
        Input::new("stl", "carriage returns", TEXT.replace('\n', "\r"), Opens),
        Input::new("stl", "one line", TEXT.replace('\n', " "), Opens),
        Input::new(
            "stl",
            "a name of a megabyte",
            TEXT.replacen("solid a", &format!("solid {}", "x".repeat(1 << 20)), 1),
            Opens,
        ),
        Input::new("stl", "a facet of many corners", corners, Opens),
    ]
}
