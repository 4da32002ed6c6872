//! Scene files, with the model `one.obj` next to them.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightmesh_fuzz::{Folder, read};

fuzz_target!(|bytes: &[u8]| {
    let folder = Folder::new();
    folder.write("one.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    read(&folder.write("input.toml", bytes));
});
