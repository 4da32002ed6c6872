//! Saved grids.

use std::process::Command;

use crate::input::Expected::{Opens, Refused};
use crate::input::{Input, lengths, patched};

const ROOM: &str = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nsegments = 8\n";

/// Offsets of the version, and of the numbers of triangles, integers and references.
const WORDS: [(&str, usize); 4] = [("version", 8), ("triangles", 12), ("integers", 24), ("references", 32)];
/// Bytes of the header.
const HEADER: usize = 40;

pub(crate) fn inputs() -> Vec<Input> {
    let whole = saved();
    let grid =
        |oddity: String, bytes: &[u8], expected| Input::new("grid", oddity, bytes, expected).beside("room.toml", ROOM);
    let refused = |oddity: &str, bytes: &[u8]| grid(oddity.to_owned(), bytes, Refused);
    let mut all = vec![
        grid("as it should be".to_owned(), &whole, Opens),
        refused("empty", b""),
        refused("zeros", &[0; 4096]),
        refused("noise", &[0xff; 4096]),
        refused("a scene", ROOM.as_bytes()),
        refused("bytes behind the end", &[&whole[..], &[0]].concat()),
        grid("of another scene".to_owned(), &whole, Refused).beside("room.toml", ROOM.replace('8', "9")),
    ];
    all.extend(lengths(&whole).map(|length| grid(format!("cut after {length}"), &whole[..length], Refused)));
    for (what, at) in WORDS {
        all.extend([0, 1, u32::MAX, 1 << 31].map(|value| {
            let odd = patched(&whole, at, &value.to_le_bytes());
            let expected = if odd == whole { Opens } else { Refused };
            grid(format!("{value} for its number of {what}"), &odd, expected)
        }));
    }
    for at in [HEADER, HEADER + 4, whole.len() / 2, whole.len() - 1] {
        all.push(grid(format!("byte {at} changed"), &patched(&whole, at, &[!whole[at]]), Refused));
    }
    all
}

/// A grid of the room as the program saves it.
fn saved() -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let [scene, file] = ["room.toml", "room.grid"].map(|name| folder.path().join(name));
    std::fs::write(&scene, ROOM).unwrap();
    let flags = ["--grid", "2x2x2", "--quiet", "-o"];
    let status = Command::new(env!("CARGO_BIN_EXE_lightmesh")).arg("grid").arg(&scene).args(flags).arg(&file).status();
    assert!(status.unwrap().success());
    std::fs::read(file).unwrap()
}
