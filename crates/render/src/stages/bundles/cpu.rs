//! Bundles on the CPU, a task per tile.

use glam::{IVec3, Vec3};
use lightmesh_layout::constants::{
    CELL_PIXELS, F32_EXPONENT_STEP, F32_INFINITY_BITS, GOLDEN_RATIO, LAST_HASH, TILE, WARP,
};
use rayon::prelude::*;

use crate::data::bundles::Bundles;
use crate::data::wave::HostWave;

pub(crate) fn bundles(wave: &HostWave) -> Bundles {
    let rays = wave.hits.len();
    let tiles: Vec<Bundles> = (0..rays.div_ceil(TILE as usize))
        .into_par_iter()
        .map(|tile| {
            let first = tile * TILE as usize;
            let count = (rays - first).min(TILE as usize);
            wave.context.piece(count, || bundles_of_tile(wave, first, count))
        })
        .collect();
    let mut bundles = Bundles::default();
    tiles.iter().for_each(|tile| bundles.append(tile));
    bundles
}

/// The bundles of `count` rays, at most [`TILE`], from number `first` on.
fn bundles_of_tile(wave: &HostWave, first: usize, count: usize) -> Bundles {
    // 1. The cell of each surface point, and its place there.
    let seen = (0..count).filter(|&place| wave.sees(first + place));
    let mut words: Vec<u32> = seen.map(|place| sort_word(wave, first + place, place as u32)).collect();

    // 2. Sort by cell, within a cell along the curve.
    words.sort_unstable();

    // 3. Every cell begins a bundle, and so does every 32nd point after its first.
    let mut bundles = Bundles::default();
    for cell in words.chunk_by(|a, b| a >> 16 == b >> 16) {
        for bundle in cell.chunks(WARP as usize) {
            bundles.push(bundle.iter().map(|word| first as u32 + word % TILE));
        }
    }
    bundles
}

/// 16 bits of a hash of a surface point's cell, 6 bits of its place in the cell, 10 bits of its place in the tile. Cells with equal hashes
/// share bundles.
fn sort_word(wave: &HostWave, ray: usize, place: u32) -> u32 {
    let point = wave.surface_point(ray).position;
    let width = CELL_PIXELS * wave.rays.width_at(point);
    // A power of two, so that neighbours at different distances have the same cells.
    let step = f32::from_bits((width.to_bits() & F32_INFINITY_BITS) + F32_EXPONENT_STEP);
    if width < f32::MIN_POSITIVE || !step.is_finite() {
        return place;
    }
    let position = point / step;
    let cell = position.floor();
    let IVec3 { x, y, z } = cell.as_ivec3();
    let key = [x as u32, y as u32, z as u32, step.to_bits()]
        .into_iter()
        .fold(0, |key: u64, part| (key ^ u64::from(part)).wrapping_mul(GOLDEN_RATIO).rotate_left(29));
    ((key >> 32) as u32 & 0xffff).min(LAST_HASH) << 16 | curve(position - cell) << 10 | place
}

/// The place along a Morton curve through 4 × 4 × 4 parts of a cell.
fn curve(within: Vec3) -> u32 {
    let IVec3 { x, y, z } = (4.0 * within).as_ivec3();
    let spread = |digits: i32| (digits & 1 | (digits & 2) << 2) as u32;
    spread(x) << 2 | spread(y) << 1 | spread(z)
}
