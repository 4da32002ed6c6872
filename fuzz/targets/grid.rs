//! Saved grids, both raw and forged: forging corrects counts and hashes, so that the numbers behind them are read.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use glam::Vec3;
use libfuzzer_sys::fuzz_target;
use lightmesh::Scene;
use lightmesh::render::accel::{Accelerator, Grid, GridOptions, Hit, Ray, Triangle};
use lightmesh_fuzz::Folder;
use xxhash_rust::xxh3::xxh3_64;

/// Bytes before the numbers; the last three groups of eight are the hash of the triangles and two counts.
const HEADER: usize = 40;
/// Bytes of the hash at the end.
const TRAILER: usize = 8;
const GEOMETRY: usize = 16;
const CELLS: usize = 24;
const REFERENCES: usize = 32;

static TRIANGLES: LazyLock<Vec<Triangle>> = LazyLock::new(|| {
    let mesh = Scene::open("builtin:gazebo").expect("a built-in scene").geometry.mesh.clone();
    (0..mesh.triangles.len()).map(|index| Triangle::new(mesh.corners(index), index as u32)).collect()
});

/// The header of a valid file.
static TRUE_HEADER: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = Folder::new();
    let path = folder.write("true.grid", &[]);
    let grid = Grid::new(&TRIANGLES, &GridOptions::default()).expect("a grid");
    grid.save(&path).expect("space for a small file");
    std::fs::read(&path).expect("what was saved")[..HEADER].to_vec()
});

fuzz_target!(|bytes: &[u8]| {
    let folder = Folder::new();
    try_out(&folder.write("input.grid", bytes));
    if let Some(forged) = forged(bytes) {
        try_out(&folder.write("forged.grid", &forged));
    }
});

/// The input with valid triangles, length and hash.
fn forged(bytes: &[u8]) -> Option<Vec<u8>> {
    let (header, numbers) = bytes.split_at_checked(HEADER)?;
    let all = numbers.len().checked_sub(TRAILER)? / 4;
    let cells = u64::from_le_bytes(*header[CELLS..].first_chunk()?).min(all as u64);
    let mut forged = TRUE_HEADER[..GEOMETRY + 8].to_vec();
    forged.extend(cells.to_le_bytes());
    debug_assert_eq!(forged.len(), REFERENCES);
    forged.extend((all as u64 - cells).to_le_bytes());
    forged.extend(&numbers[..4 * all]);
    forged.extend(xxh3_64(&forged).to_le_bytes());
    Some(forged)
}

/// Reads a grid and traces rays through it.
fn try_out(path: &Path) {
    let grid = match Grid::load(path, &TRIANGLES) {
        Ok(grid) => grid,
        Err(error) => {
            assert!(error.to_string().starts_with(&*path.to_string_lossy()), "the file is not named: {error}");
            return;
        }
    };
    let direction =
        |index: u32| Vec3::new((1.3 * index as f32).sin(), (0.7 * index as f32).cos(), (2.1 * index as f32).sin());
    let rays: Vec<Ray> = (0..16)
        .map(|index| Ray { origin: 100.0 * direction(index), direction: -direction(index + 1), t_max: f32::INFINITY })
        .collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    grid.closest_hits(&rays, &mut hits);
    assert!(hits.iter().all(|hit| !hit.is_some() || (hit.triangle as usize) < TRIANGLES.len()));
    grid.occluded(&rays, &mut vec![false; rays.len()]);
}
