//! OBJ files with a material library: an input is the OBJ file, a line `%mtl`, and the library, which is named `a.mtl`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightmesh_fuzz::{Folder, read};

const MARK: &[u8] = b"%mtl\n";

fuzz_target!(|bytes: &[u8]| {
    let at = bytes.windows(MARK.len()).position(|window| window == MARK);
    let folder = Folder::new();
    if let Some(at) = at {
        folder.write("a.mtl", &bytes[at + MARK.len()..]);
    }
    read(&folder.write("input.obj", &bytes[..at.unwrap_or(bytes.len())]));
});
