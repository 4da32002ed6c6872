use std::cell::Cell;
use std::io::{self, Write};

use lightmesh_image::internals::exr::{Sorted, sort};

fn attribute(name: &str, value: &[u8]) -> Vec<u8> {
    let length = (value.len() as u32).to_le_bytes();
    [name.as_bytes(), b"\0string\0", &length, value].concat()
}

#[test]
fn attributes_of_each_header_are_sorted() {
    let [a, b, c] = [attribute("a", b"1\0\0"), attribute("b/2", b""), attribute("b", b"longer value")];
    let file = |parts: [&[u8]; 5]| [b"\x76\x2f\x31\x01\x02\0\0\0".as_slice(), &parts.concat(), b"chunks"].concat();
    let mut bytes = file([&b, &c, &[0], &[&*c, &*a].concat(), &[0]]);
    sort(&mut bytes, 2).unwrap();
    assert_eq!(bytes, file([&c, &b, &[0], &[&*a, &*c].concat(), &[0]]));
    assert_eq!(sort(&mut bytes[..20], 1), None);
}

#[test]
fn nothing_is_written_before_the_headers_are_complete() {
    let complete = Cell::new(false);
    let mut written = io::Cursor::new(Vec::new());
    let mut output = Sorted::new(&mut written, 1, &complete);
    let [a, b] = [attribute("a", b"x"), attribute("b", b"y")];
    for bytes in [b"\x76\x2f\x31\x01\x02\0\0\0".as_slice(), &b, &a, &[0], b"table"] {
        output.write_all(bytes).unwrap();
    }
    output.flush().unwrap();
    assert!(output.output.get_ref().is_empty());
    complete.set(true);
    output.write_all(b"chunk").unwrap();
    let expected = [b"\x76\x2f\x31\x01\x02\0\0\0".as_slice(), &a, &b, &[0], b"table", b"chunk"].concat();
    assert_eq!(*written.get_ref(), expected);
}
