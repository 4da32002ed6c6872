//! PLY files: as text, and binary in both byte orders.

use crate::input::Expected::{self, Either, Opens, Refused};
use crate::input::{Input, cut, utf_16};

const VERTICES: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const BODY: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 1\nproperty list uchar int vertex_indices\n";
const ROWS: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const LITTLE: &str = "binary_little_endian";
const BIG: &str = "binary_big_endian";

/// Lines of the header, their replacements, and the expected outcome.
const HEADERS: [(&str, &str, Expected); 25] = [
    ("vertex 4", "vertex 4294967295", Refused),
    ("vertex 4", "vertex 18446744073709551615", Refused),
    ("vertex 4", "vertex 99999999999999999999", Refused),
    ("vertex 4", "vertex -1", Refused),
    ("vertex 4", "vertex 3", Either),
    ("vertex 4", "vertex", Refused),
    ("face 1", "face 4294967295", Refused),
    ("face 1", "face 18446744073709551615", Refused),
    ("face 1", "face 0", Opens),
    ("element face 1\n", "element empty 18446744073709551615\nelement face 1\n", Opens),
    ("property float x", "property real x", Refused),
    ("property float x", "property float a", Refused),
    ("property float x", "property list uchar float x", Refused),
    ("property list uchar int vertex_indices", "property int vertex_indices", Either),
    ("property list uchar int vertex_indices", "property list float int vertex_indices", Either),
    ("property list uchar int vertex_indices", "property list uchar int other", Refused),
    ("element vertex 4\n", "", Refused),
    ("end_header\n", "", Refused),
    ("ascii 1.0", "ascii 9.9", Either),
    ("ascii 1.0", "morse 1.0", Refused),
    ("format ascii 1.0\n", "", Refused),
    ("ply\n", "PLY\n", Either),
    ("element vertex", "made by hand\nelement vertex", Opens),
    ("element vertex", "\u{1b}[31m\nelement vertex", Opens),
    ("vertex 4", "vertex 4 or so", Opens),
];

/// Faces, and the expected outcome.
const FACES: [(&str, Expected); 19] = [
    ("4 0 1 2 3", Opens),
    ("4 4 1 2 3", Refused),
    ("4 0 4 2 3", Refused),
    ("4 0 1 4 3", Refused),
    ("4 0 1 2 4", Refused),
    ("4 -1 1 2 3", Refused),
    ("4 4294967295 1 2 3", Refused),
    ("4 nan 1 2 3", Refused),
    ("4 0.5 1 2 3", Refused),
    ("4 x 1 2 3", Refused),
    ("3 0 1 2", Opens),
    ("4 0 1 2 3 255 0 0", Opens),
    ("4 0 1 2 3 x", Opens),
    ("4 0 1 2", Refused),
    ("2 0 1", Opens),
    ("0", Opens),
    ("-1", Refused),
    ("4294967295 0 1 2", Refused),
    ("1e308 0 1 2", Refused),
];

/// Textures named in a comment; the geometry loads without them.
const PICTURES: [&str; 6] = ["none.png", "../a.png", "/etc/passwd", "http://example.org/a.png", "a\0.png", "."];

pub(crate) fn inputs() -> Vec<Input> {
    let text = ascii("4 0 1 2 3");
    let mut all = cut("ply", "text", text.as_bytes());
    for (what, order) in [("little-endian", LITTLE), ("big-endian", BIG)] {
        all.extend(cut("ply", what, &binary(order, order, 3)));
    }
    all.extend(HEADERS.map(|(line, odd, expected)| {
        assert!(text.contains(line), "{line}");
        let oddity = format!("`{}` for `{}`", odd.escape_debug(), line.escape_debug());
        Input::new("ply", oddity, text.replacen(line, odd, 1), expected)
    }));
    all.extend(FACES.map(|(face, expected)| Input::new("ply", format!("face `{face}`"), ascii(face), expected)));
    all.extend(["nan", "inf", "1e308", "1e999", "1e18"].map(|word| {
        Input::new("ply", format!("coordinate `{word}`"), text.replacen("1 1 0", &format!("1 {word} 0"), 1), Opens)
    }));
    all.extend(PICTURES.map(|name| {
        let comment = format!("ply\ncomment TextureFile {name}\n");
        let text =
            text.replacen("ply\n", &comment, 1).replace("float x", "float x\nproperty float u\nproperty float v");
        let text = ROWS.lines().fold(text, |text, row| text.replacen(row, &format!("0 0 {row}"), 1));
        Input::new("ply", format!("image `{}`", name.escape_debug()), text, Opens)
    }));
    all.extend(binaries());
    all.extend(texts(&text));
    all
}

fn header(format: &str) -> String {
    format!("ply\nformat {format} 1.0\n{BODY}end_header\n")
}

/// A square as text.
fn ascii(face: &str) -> String {
    format!("{}{ROWS}{face}\n", header("ascii"))
}

/// A square whose header names one byte order and whose numbers may have another.
fn binary(named: &str, order: &str, last: i32) -> Vec<u8> {
    let ordered = |bytes: [u8; 4]| if order == LITTLE { bytes } else { [bytes[3], bytes[2], bytes[1], bytes[0]] };
    let mut bytes = header(named).into_bytes();
    bytes.extend(VERTICES.as_flattened().iter().flat_map(|number| ordered(number.to_le_bytes())));
    bytes.push(4);
    bytes.extend([0, 1, 2, last].into_iter().flat_map(|index: i32| ordered(index.to_le_bytes())));
    bytes
}

fn binaries() -> [Input; 8] {
    let many = |count: &str| {
        let header = header(LITTLE).replace("list uchar int", &format!("list {count} int"));
        let mut bytes = header.into_bytes();
        bytes.extend(VERTICES.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0xff; 24]);
        bytes
    };
    let carriage_returns = [&header(LITTLE).replace('\n', "\r\n").into_bytes()[..], &[0; 65]].concat();
    [
        Input::new("ply", "little-endian called big", binary(BIG, LITTLE, 3), Refused),
        Input::new("ply", "big-endian called little", binary(LITTLE, BIG, 3), Refused),
        Input::new("ply", "binary index beyond the end", binary(LITTLE, LITTLE, 4), Refused),
        Input::new("ply", "binary index below 0", binary(BIG, BIG, i32::MIN), Refused),
        Input::new("ply", "a list of 2^32 - 1", many("uint"), Refused),
        Input::new("ply", "a list of -1", many("int"), Refused),
        Input::new("ply", "a list with a NaN count", many("float"), Refused),
        Input::new("ply", "carriage returns before binary numbers", carriage_returns, Either),
    ]
}

fn texts(square: &str) -> [Input; 8] {
    let long = "x".repeat(1 << 20);
    [
        Input::new("ply", "empty", "", Refused),
        Input::new("ply", "a header alone", "ply\nformat ascii 1.0\nend_header\n", Refused),
        Input::new("ply", "byte order mark", format!("\u{feff}{square}"), Either),
        Input::new("ply", "UTF-16", utf_16(square), Refused),
        Input::new(
            "ply",
            "a comment of a megabyte",
            square.replacen("ply\n", &format!("ply\ncomment {long}\n"), 1),
            Opens,
        ),
        Input::new("ply", "a name of a megabyte", square.replacen("face 1", &format!("{long} 1"), 1), Opens),
        Input::new("ply", "control characters", square.replacen("float x", "\u{1b}[31m\r\u{7} x", 1), Refused),
        Input::new(
            "ply",
            "many elements",
            square.replacen("element vertex", &format!("{}element vertex", "element a 0\n".repeat(100_000)), 1),
            Opens,
        ),
    ]
}
