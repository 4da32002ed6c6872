//! GLB files.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| lightmesh_fuzz::read_alone("input.glb", bytes));
