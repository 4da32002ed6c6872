//! The triangles that structures hold: those that can be hit, and of identical ones the one with the smallest index.
//!
//! Rays hit identical triangles at the same place, and the smallest index wins. So a pile of them, as exporters leave behind, costs
//! no more than one. Those that are cut out are all held: each may have other holes.

use glam::Vec3;
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::Triangle;

/// Their positions in `triangles`, ascending.
pub fn deduplicate(triangles: &[Triangle]) -> Vec<u32> {
    let mut usable: Vec<(u64, u32)> = triangles
        .par_iter()
        .enumerate()
        .filter(|(_, triangle)| triangle.is_usable())
        .map(|(at, triangle)| (xxh3_64(bytemuck::bytes_of(&bits(triangle))), at as u32))
        .collect();
    usable.par_sort_unstable();
    let mut distinct = Vec::with_capacity(usable.len());
    for same_hash in usable.chunk_by_mut(|a, b| a.0 == b.0) {
        if same_hash.len() > 1 {
            same_hash.sort_unstable_by_key(|&(_, at)| (bits(&triangles[at as usize]), triangles[at as usize].index()));
        }
        let same = same_hash.chunk_by(|a, b| bits(&triangles[a.1 as usize]) == bits(&triangles[b.1 as usize]));
        for same in same {
            let opaque = same.iter().find(|(_, at)| triangles[*at as usize].cut() == 0);
            let cut = same.iter().filter(|(_, at)| triangles[*at as usize].cut() != 0);
            distinct.extend(opaque.into_iter().chain(cut).map(|&(_, at)| at));
        }
    }
    distinct.par_sort_unstable();
    distinct
}

fn bits(triangle: &Triangle) -> [[u32; 3]; 3] {
    triangle.corners().map(|corner: Vec3| corner.to_array().map(f32::to_bits))
}
