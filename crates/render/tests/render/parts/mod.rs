//! Parts of the renderer by themselves.

mod accel;
mod antialiasing;
mod bands;
mod cache;
mod counters;
mod cuda;
mod data;
mod device;
mod footprint;
mod irradiance_cache;
mod light_mesh;
mod material_ids;
mod passes;
mod prepared;
mod probes;
mod progress;
mod sampling;
mod settings;
mod shading;
mod shadow;
mod stage;
mod stages;
mod surface;
mod textures;
mod view;

use std::path::{Path, PathBuf};

use lightmesh_render::{BytesPerRay, Glass, LightGroups, Plan};

/// Libraries without a test harness, so that each is compiled once: a test beside their code would never run.
const WITHOUT_TESTS: [&str; 3] = ["render", "scene", "image"];

#[test]
fn no_test_is_beside_the_code() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut folders: Vec<PathBuf> = WITHOUT_TESTS.iter().map(|name| crates.join(name).join("src")).collect();
    let (mut files, mut skipped) = (0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files += 1;
                let text = std::fs::read_to_string(&path).unwrap();
                if text.contains("#[test]") || text.contains("cfg(test)") {
                    skipped.push(path);
                }
            }
        }
    }
    assert!(files > 300, "{files}");
    assert!(skipped.is_empty(), "move these tests to tests/CRATE/parts: {skipped:?}");
}

/// A plan of an image without anything that was not asked for, with `left` bytes.
fn plain(size: [u32; 2], lights: LightGroups, left: Option<u64>) -> Plan {
    Plan {
        size,
        antialiasing: None,
        bounces: 0,
        is_transmissive: false,
        glass: Glass::Tinted,
        directions: 1,
        coverage: false,
        caught: false,
        layers: None,
        compositing: false,
        gathering: None,
        lights,
        most_rows: None,
        memory_limit: left,
        left,
        kept: 0,
        reserved: 0,
        bytes_per_ray: BytesPerRay::default(),
    }
}
