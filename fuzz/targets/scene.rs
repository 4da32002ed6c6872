//! Scene files together with what they name: meshes of every format with their own files, and textures. One input holds all files,
//! the scene first, each of the others behind a line with its name.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightmesh_fuzz::{Folder, read};

/// Begins the line before a file.
const MARK: &[u8] = b"\n=== ";
/// Files that an input may hold. Other names are ignored: they might lead out of the folder.
const NAMES: [&str; 8] = ["a.obj", "a.mtl", "a.ply", "a.stl", "a.gltf", "a.glb", "a.bin", "a.png"];

fuzz_target!(|bytes: &[u8]| {
    let folder = Folder::new();
    let (scene, mut rest) = split(bytes);
    while let Some(part) = rest {
        let (file, next) = split(part);
        if let Some((name, content)) = named(file) {
            folder.write(name, content);
        }
        rest = next;
    }
    read(&folder.write("input.toml", scene));
});

/// What is before the next mark, and what is behind it.
fn split(bytes: &[u8]) -> (&[u8], Option<&[u8]>) {
    match bytes.windows(MARK.len()).position(|window| window == MARK) {
        Some(at) => (&bytes[..at], Some(&bytes[at + MARK.len()..])),
        None => (bytes, None),
    }
}

/// The name in the first line, if it is a known one, and the lines after it.
fn named(file: &[u8]) -> Option<(&'static str, &[u8])> {
    let end = file.iter().position(|&byte| byte == b'\n')?;
    let name = NAMES.into_iter().find(|name| name.as_bytes() == &file[..end])?;
    Some((name, &file[end + 1..]))
}
