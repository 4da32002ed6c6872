//! glTF files; buffers and images can only be data URIs.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| lightmesh_fuzz::read_alone("input.gltf", bytes));
