//! Tells the tests whether the shared scenes lie beside the repository: without them their tests report "ignored".

use std::path::Path;

fn main() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    println!("cargo::rustc-check-cfg=cfg(shared_scenes)");
    println!("cargo::rerun-if-changed=build.rs");
    if shared.is_dir() {
        // Named only where it is there: a missing path would mean a new build every time.
        println!("cargo::rerun-if-changed={}", shared.display());
        println!("cargo::rustc-cfg=shared_scenes");
    }
}
