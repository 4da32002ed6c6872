//! How long it takes to unpack the kernels' PTX, module by module and all: `cargo run --release -p lightmesh-render-examples --bin unpack`.
//!
//! What a driver does with it afterwards takes longer by far: a second or more to compile, milliseconds to find what it has compiled before.
#![allow(clippy::print_stdout, reason = "a program for the terminal")]

use std::time::Instant;

use lightmesh_render::internals::cuda::{MODULES, Module};

/// The median of so many is told.
const REPETITIONS: usize = 21;

fn main() {
    println!("{:24} {:>9} {:>9} {:>9}", "module", "bytes", "packed", "ms");
    let all = MODULES.iter().map(|module| {
        let seconds = seconds(module);
        println!("{:24} {:9} {:9} {:9.2}", module.name, module.bytes, module.packed.len(), 1e3 * seconds);
        (module.bytes, module.packed.len(), seconds)
    });
    let (bytes, packed, seconds) = all.fold((0, 0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1, sum.2 + own.2));
    println!("{:24} {bytes:9} {packed:9} {:9.2}", "all", 1e3 * seconds);
}

/// The median time to unpack it into new memory.
fn seconds(module: &Module) -> f64 {
    let mut times = [0.0; REPETITIONS].map(|_: f64| {
        let start = Instant::now();
        let text = module.unpacked();
        let seconds = start.elapsed().as_secs_f64();
        assert!(text.is_ok(), "{text:?}");
        seconds
    });
    times.sort_by(f64::total_cmp);
    times[REPETITIONS / 2]
}
