//! Tells the tests whether the shared scenes are available next to the repository: without them their tests are ignored.

use std::path::Path;

fn main() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../../shared/scenes");
    println!("cargo::rustc-check-cfg=cfg(shared_scenes)");
    println!("cargo::rerun-if-changed=build.rs");
    if shared.is_dir() {
        // Only named if it exists: a missing path would cause a rebuild every time.
        println!("cargo::rerun-if-changed={}", shared.display());
        println!("cargo::rustc-cfg=shared_scenes");
    }
}
