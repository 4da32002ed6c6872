//! OBJ files and their material libraries.

use crate::input::Expected::{self, Either, Opens, Refused};
use crate::input::{Input, cut, lengths, utf_16};

const SQUARE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/1/1 4/2/1\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const LIBRARY: &str =
    "newmtl red\nKa 0.1 0.1 0.1\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 10\nd 0.5\nmap_Kd -s 2 2 1 -clamp on none.png\n";

/// Replacements for a triangle's face, and the expected outcome.
const FACES: [(&str, Expected); 20] = [
    ("f 1 2 3", Opens),
    ("f 0 2 3", Refused),
    ("f 1 0 3", Refused),
    ("f 1 2 0", Refused),
    ("f 1 2 4", Refused),
    ("f -4 -2 -1", Refused),
    ("f -1 -2 -3", Opens),
    ("f 1/1 2/1 3/1", Opens),
    ("f 1//1 2//1 3//1", Opens),
    ("f 1/1/1/1 2 3", Refused),
    ("f 4294967295 2 3", Refused),
    ("f 4294967297 2 3", Refused),
    ("f 18446744073709551617 2 3", Refused),
    ("f -9223372036854775808 2 3", Refused),
    ("f nan 2 3", Refused),
    ("f 1.5 2 3", Refused),
    ("f 1", Opens),
    ("f", Opens),
    ("f 1 1 1", Opens),
    ("f 1 2 3\nf 1 2 3 1 2 3 1 2 3", Opens),
];

/// Replacements for a coordinate.
const COORDINATES: [(&str, Expected); 12] = [
    ("nan", Opens),
    ("inf", Opens),
    ("-inf", Opens),
    ("1e18", Opens),
    ("1e308", Opens),
    ("1e999", Opens),
    ("1e-308", Opens),
    ("1.0f", Opens),
    ("-nan(ind)", Opens),
    ("1,5", Refused),
    ("x", Refused),
    ("", Refused),
];

/// Replacements for the name of a library; the geometry loads without it.
const LIBRARIES: [&str; 10] = [
    "none.mtl",
    "../a.mtl",
    "/etc/passwd",
    "https://example.org/a.mtl",
    "file:///etc/passwd",
    "a\0b.mtl",
    ".",
    "input.obj",
    "con",
    "\u{1b}[31mred.mtl",
];

const LIBRARY_LINES: [(&str, Expected); 15] = [
    ("newmtl", Opens),
    ("newmtl a\nKd nan 0 0", Refused),
    ("newmtl a\nKd 1 2", Refused),
    ("newmtl a\nKd 1e308 0 0", Refused),
    ("newmtl a\nNs inf", Refused),
    ("newmtl a\nNs -5", Opens),
    ("newmtl red\nmap_Kd", Opens),
    ("newmtl red\nmap_Kd ../a.png", Opens),
    ("newmtl red\nmap_Kd http://example.org/a.png", Opens),
    ("newmtl red\nmap_Kd a\0.png", Opens),
    ("newmtl red\nmap_Kd a.mtl", Opens),
    ("newmtl red\nmap_d", Opens),
    ("newmtl red\nmap_d -imfchan", Opens),
    ("newmtl red\nmap_d -imfchan q -clamp on none.png", Opens),
    ("newmtl red\nmap_Kd -s nan inf 1e308 -o -t -mm", Opens),
];

pub(crate) fn inputs() -> Vec<Input> {
    let mut all = cut("obj", "square", SQUARE.as_bytes());
    all.extend(FACES.map(|(face, expected)| {
        Input::new("obj", format!("face `{}`", face.escape_debug()), format!("{TRIANGLE}{face}\n"), expected)
    }));
    all.extend(each_index());
    all.extend(COORDINATES.map(|(word, expected)| {
        let text = format!("v 0 0 {word}\n{TRIANGLE}f 2 3 4\nf 1 2 3\n");
        Input::new("obj", format!("coordinate `{word}`"), text, expected)
    }));
    all.extend(libraries());
    all.extend(texts());
    all
}

/// Each index of each corner out of range, in turn.
fn each_index() -> impl Iterator<Item = Input> {
    let corners = SQUARE.match_indices("/1").map(|(at, _)| at).chain(SQUARE.match_indices(" 1/").map(|(at, _)| at));
    corners.map(|at| {
        let text = format!("{} 99{}", &SQUARE[..at + 1], &SQUARE[at + 2..]).replace("/ 99", "/99");
        Input::new("obj", format!("index at byte {at} beyond the end"), text, Refused)
    })
}

fn libraries() -> Vec<Input> {
    let named = |name: &str| {
        let text = SQUARE.replace("a.mtl", name);
        Input::new("obj", format!("library `{}`", name.escape_debug()), text, Opens)
    };
    let mut all: Vec<Input> = LIBRARIES.map(named).into();
    let with = |oddity: String, library: &[u8], expected| {
        Input::new("obj", oddity, SQUARE, expected).beside("a.mtl", library).blaming("a.mtl")
    };
    let library = LIBRARY.as_bytes();
    all.extend(lengths(library).map(|length| with(format!("library cut after {length}"), &library[..length], Either)));
    all.extend(
        LIBRARY_LINES
            .map(|(lines, expected)| with(format!("library `{}`", lines.escape_debug()), lines.as_bytes(), expected)),
    );
    all.push(with("library of noise".to_owned(), &[0x93; 4096], Opens));
    all
}

/// Whole files.
fn texts() -> [Input; 17] {
    let triangle = format!("{TRIANGLE}f 1 2 3\n");
    let many = |count: usize, word: &str| word.repeat(count);
    [
        Input::new("obj", "empty", "", Opens),
        Input::new("obj", "one line feed", "\n", Opens),
        Input::new("obj", "a comment alone", "# nothing", Opens),
        Input::new("obj", "byte order mark", format!("\u{feff}{triangle}"), Opens),
        Input::new("obj", "UTF-16", utf_16(&triangle), Either),
        Input::new("obj", "carriage returns", triangle.replace('\n', "\r"), Opens),
        Input::new("obj", "NUL bytes between the lines", triangle.replace('\n', "\n\0\n"), Either),
        Input::new("obj", "NUL bytes in names", format!("o a\0b\nusemtl c\0d\n{triangle}"), Opens),
        Input::new("obj", "a comment of a megabyte", format!("# {}\n{triangle}", many(1 << 20, "x")), Opens),
        Input::new("obj", "a number of a megabyte", format!("v {} 0 0\n{triangle}", many(1 << 20, "1")), Opens),
        Input::new("obj", "a keyword of a megabyte", format!("{} 1\n{triangle}", many(1 << 20, "v")), Opens),
        Input::new("obj", "a polygon of many corners", format!("{TRIANGLE}f{}\n", many(100_000, " 1 2 3")), Opens),
        Input::new("obj", "continued for ever", format!("{triangle}f {}", many(100_000, "\\\n")), Opens),
        Input::new("obj", "a gear of many teeth", gear(90_000), Opens),
        Input::new("obj", "many libraries", format!("{}{triangle}", numbered(50_000, "mtllib #.mtl\n")), Opens),
        Input::new(
            "obj",
            "many materials",
            format!("mtllib a.mtl\n{TRIANGLE}{}", numbered(50_000, "usemtl m#\nf 1 2 3\n")),
            Opens,
        )
        .beside("a.mtl", numbered(200_000, "newmtl m#\nKd 1 0 0\n")),
        Input::new("obj", "many groups", format!("{triangle}{}", many(100_000, "g a\nusemtl b\n")), Opens),
    ]
}

/// The text many times, with the number in place of `#`.
fn numbered(count: usize, text: &str) -> String {
    (0..count).map(|number| text.replace('#', &number.to_string())).collect()
}

/// A polygon of which every other corner is not convex.
fn gear(corners: usize) -> String {
    let corner = |index: usize| {
        let (angle, radius) = (std::f64::consts::TAU * index as f64 / corners as f64, 1.0 + 0.1 * (index % 2) as f64);
        format!("v {} {} 0\n", radius * angle.cos(), radius * angle.sin())
    };
    let face: String = (1..=corners).map(|index| format!(" {index}")).collect();
    format!("{}f{face}\n", (0..corners).map(corner).collect::<String>())
}
