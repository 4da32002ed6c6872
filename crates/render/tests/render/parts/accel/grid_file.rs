use std::path::{Path, PathBuf};

use glam::Vec3;
use lightmesh_render::accel::{Accelerator, Grid, GridFault, GridOptions, GridSaveError, Hit, Levels, Ray, Triangle};
use lightmesh_render::internals::accel::{HEADER, Header, TRAILER, decode};
use xxhash_rust::xxh3::xxh3_64;

fn triangles() -> Vec<Triangle> {
    let corner = |index: u32, turn: u32| {
        let at = (index * 7 + turn * 3) % 11;
        Vec3::new(at as f32, (index % 5) as f32 + 0.3 * turn as f32, (index * turn % 7) as f32)
    };
    (0..40).map(|index| Triangle::new([0, 1, 2].map(|turn| corner(index, turn)), index)).collect()
}

fn grid() -> Grid {
    Grid::new(&triangles(), &GridOptions { dims: Some([2, 1, 2]), levels: Levels::Two, ..GridOptions::default() })
        .unwrap()
}

/// The saved grid as bytes, and a folder to change it in.
fn saved() -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.grid");
    grid().save(&path).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    (folder, path, bytes)
}

fn load(path: &Path, bytes: &[u8]) -> Result<Grid, GridFault> {
    std::fs::write(path, bytes).unwrap();
    Grid::load(path, &triangles()).map_err(|error| error.fault)
}

/// Decodes the bytes without a file in between.
fn decoded(bytes: &[u8]) -> Result<Grid, GridFault> {
    let header = Header::parse(&bytes[..HEADER])?;
    if header.file_length() != bytes.len() as u128 {
        return Err(GridFault::Length { found: bytes.len() as u64, expected: header.file_length() });
    }
    decode(&header, bytes, &triangles())
}

/// Bytes with the hash corrected after a change.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    let content = bytes.len() - TRAILER;
    let hash = xxh3_64(&bytes[..content]).to_le_bytes();
    bytes[content..].copy_from_slice(&hash);
    bytes
}

fn hits(grid: &Grid) -> Vec<Hit> {
    let rays: Vec<Ray> = (0..100)
        .map(|index| {
            let (x, z) = ((index % 10) as f32 + 0.4, (index / 10) as f32 * 0.7 + 0.2);
            Ray { origin: Vec3::new(x, -3.0, z), direction: Vec3::new(0.1, 1.0, -0.05), t_max: f32::INFINITY }
        })
        .collect();
    let mut hits = vec![Hit::MISS; rays.len()];
    grid.closest_hits(&rays, &mut hits);
    hits
}

#[test]
fn a_loaded_grid_is_the_saved_one() {
    let (folder, path, _) = saved();
    let (built, loaded) = (grid(), Grid::load(&path, &triangles()).unwrap());
    assert_eq!((loaded.cells(), loaded.sources()), (built.cells(), built.sources()));
    assert_eq!((loaded.dims(), loaded.geometry()), (built.dims(), built.geometry()));
    assert_eq!(hits(&loaded), hits(&built));
    assert!(hits(&built).iter().filter(|hit| hit.is_some()).count() > 20);
    assert!(built.cells().len() > 100, "a second level");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left next to it");
}

#[test]
fn truncated_and_longer_files_are_refused() {
    let (_folder, path, bytes) = saved();
    for length in (0..HEADER + 20).chain([bytes.len() / 2, bytes.len() - 1]) {
        assert!(load(&path, &bytes[..length]).is_err(), "{length} bytes");
    }
    assert!(matches!(load(&path, &[&bytes[..], &[0]].concat()), Err(GridFault::Length { .. })));
}

#[test]
fn every_changed_byte_is_noticed() {
    let (_folder, _, bytes) = saved();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        assert!(decoded(&changed).is_err(), "byte {at}");
    }
}

#[test]
fn each_fault_has_its_name() {
    let (folder, path, bytes) = saved();
    assert!(matches!(load(&path, b"P6 640 480 255"), Err(GridFault::NotAGrid)));
    let mut newer = bytes.clone();
    newer[8] = 2;
    assert!(matches!(load(&path, &newer), Err(GridFault::Version { found: 2 })));
    std::fs::write(&path, &bytes).unwrap();
    let mut moved = triangles();
    moved[3] = Triangle::new([Vec3::ZERO, Vec3::X, Vec3::Y], 3);
    let error = Grid::load(&path, &moved).unwrap_err();
    assert!(matches!(error.fault, GridFault::OtherGeometry { found: 40, expected: 40 }));
    let message = error.to_string();
    assert!(message.contains("scene.grid") && message.contains("build the grid again"), "{message}");
    assert!(matches!(Grid::load(&path, &moved[..9]).unwrap_err().fault, GridFault::OtherGeometry { .. }));
    assert!(matches!(Grid::load(path.with_extension("no"), &moved).unwrap_err().fault, GridFault::Read(_)));
    assert!(Grid::load(folder.path(), &moved).unwrap_err().to_string().contains("not a regular file"));
    assert!(matches!(grid().save(path.join("below")).unwrap_err(), GridSaveError::Target(_)));
}

/// A grid holds one of identical triangles, unless they are cut out.
#[test]
fn a_grid_of_opaque_triangles_is_not_one_of_triangles_that_are_cut_out() {
    let (_folder, path, _) = saved();
    let mut leaves = triangles();
    leaves[7] = leaves[7].alpha_tested(1);
    assert!(matches!(Grid::load(&path, &leaves).unwrap_err().fault, GridFault::OtherGeometry { .. }));
    leaves[7] = leaves[7].alpha_tested(0);
    assert!(Grid::load(&path, &leaves).is_ok());
}

#[test]
fn a_length_beyond_the_file_allocates_nothing() {
    let (_folder, path, mut bytes) = saved();
    for (cells, references) in [(u64::MAX, 0), (1 << 60, 1 << 60), (0, u64::MAX)] {
        bytes[24..32].copy_from_slice(&u64::to_le_bytes(cells));
        bytes[32..40].copy_from_slice(&u64::to_le_bytes(references));
        assert!(matches!(load(&path, &signed(bytes.clone())), Err(GridFault::Length { .. })));
    }
}

#[test]
fn a_forged_file_is_refused_or_harmless() {
    let (_folder, _, bytes) = saved();
    let words = (bytes.len() - HEADER - TRAILER) / 4;
    let mut refused = 0;
    for word in 0..words {
        for value in [i32::MIN, -2, -1, 0, 1, 2, 3, 1000, i32::MAX] {
            let mut forged = bytes.clone();
            forged[HEADER + 4 * word..][..4].copy_from_slice(&value.to_le_bytes());
            match decoded(&signed(forged)) {
                Ok(grid) => drop(hits(&grid)),
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > words, "{refused} of {words}");
}
