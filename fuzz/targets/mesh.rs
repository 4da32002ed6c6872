//! Saved light points, both raw and forged: the input as the content of a file that belongs to the scene, with a hash that is right.
#![no_main]

use std::io::Write;
use std::path::Path;
use std::sync::LazyLock;

use flate2::Compression;
use flate2::write::DeflateEncoder;
use libfuzzer_sys::fuzz_target;
use lightmesh::render::{PreparedScene, Unobserved};
use lightmesh::{Device, Lookup, MeshCache, Renderer, Scene, Settings, Step};
use lightmesh_fuzz::Folder;
use xxhash_rust::xxh3::xxh3_64;

/// Bytes before the content; the last eight are the hash of the geometry.
const HEADER: usize = 24;
/// Where the hash of the geometry is in the content.
const GEOMETRY: std::ops::Range<usize> = 4..12;

static RENDERER: LazyLock<Renderer> = LazyLock::new(|| Renderer::with_threads(Device::Cpu, Some(1)).expect("a thread"));
static SETTINGS: LazyLock<Settings> = LazyLock::new(|| {
    Settings::default().with_size([6, 4]).with_lookup(Lookup::HalfBall).with_step(Step::Fixed(0.5)).with_samples(4)
});
static SCENE: LazyLock<PreparedScene> = LazyLock::new(|| {
    let scene = Scene::open("builtin:gazebo").expect("a built-in scene");
    RENDERER.prepare(&scene, &SETTINGS, &Unobserved).expect("a small scene")
});
/// The header of a valid file.
static TRUE_HEADER: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = Folder::new();
    let path = folder.write("true.mesh", &[]);
    let mut cache = MeshCache::new();
    RENDERER.render_with(&mut cache, &SCENE, &SETTINGS, &Unobserved).expect("a small image");
    cache.save(&path, &SCENE).expect("space for a small file").expect("light points");
    std::fs::read(&path).expect("what was saved")[..HEADER].to_vec()
});

fuzz_target!(|bytes: &[u8]| {
    let folder = Folder::new();
    try_out(&folder.write("input.mesh", bytes));
    try_out(&folder.write("forged.mesh", &forged(bytes)));
});

/// A file with the input as its content, and valid geometry, length and hash.
fn forged(content: &[u8]) -> Vec<u8> {
    let mut content = content.to_vec();
    if let Some(geometry) = content.get_mut(GEOMETRY) {
        geometry.copy_from_slice(&TRUE_HEADER[HEADER - GEOMETRY.len()..]);
    }
    let forged = TRUE_HEADER.clone();
    let mut packed = DeflateEncoder::new(forged, Compression::fast());
    packed.write_all(&content).expect("memory for a small file");
    let mut forged = packed.finish().expect("memory for a small file");
    forged.extend((content.len() as u64).to_le_bytes());
    forged.extend(xxh3_64(&forged).to_le_bytes());
    forged
}

/// Reads a mesh, renders with it, and saves it again.
fn try_out(path: &Path) {
    let mut cache = match MeshCache::load(path, &SCENE, Default::default()) {
        Ok(cache) => cache,
        Err(error) => {
            assert!(error.to_string().starts_with(&*path.to_string_lossy()), "the file is not named: {error}");
            return;
        }
    };
    RENDERER.render_with(&mut cache, &SCENE, &SETTINGS, &Unobserved).expect("wrong shadows, but an image");
    cache.save(path, &SCENE).expect("space for a small file");
    MeshCache::load(path, &SCENE, Default::default()).expect("what was saved");
}
