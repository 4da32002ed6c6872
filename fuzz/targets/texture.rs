//! Images as textures. Data that begins like a PNG, JPEG or BMP file is read as such; because of its name anything else is TGA.
#![no_main]

use libfuzzer_sys::fuzz_target;
use lightmesh_fuzz::{Folder, read};

const SCENE: &str = r#"
[[material]]
name = "a"
texture = "input.tga"
[[sphere]]
center = [0, 0, 0]
radius = 1
segments = 4
material = "a"
"#;

fuzz_target!(|bytes: &[u8]| {
    let folder = Folder::new();
    folder.write("input.tga", bytes);
    read(&folder.write("scene.toml", SCENE.as_bytes()));
});
