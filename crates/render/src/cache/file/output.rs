//! Numbers as content of a mesh file has them.

use std::io::{self, Write};

/// Writes the difference between two keys that ascend.
pub(super) fn write_difference(output: &mut impl Write, mut value: u64) -> io::Result<()> {
    let mut bytes = [0; 10];
    let mut count = 0;
    loop {
        let rest = value >> 7;
        bytes[count] = (value & 0x7f) as u8 | if rest == 0 { 0 } else { 0x80 };
        count += 1;
        value = rest;
        if rest == 0 {
            return output.write_all(&bytes[..count]);
        }
    }
}
