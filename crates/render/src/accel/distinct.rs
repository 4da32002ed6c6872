//! The triangles that structures hold: those that can be hit, and of identical ones the one with the smallest index.
//!
//! Rays hit identical triangles at the same place, and the smallest index wins. So a pile of them, as exporters leave behind, costs
//! no more than one. Those that are cut out are all held: each may have other holes.

use glam::Vec3;
use rayon::prelude::*;
use xxhash_rust::xxh3::xxh3_64;

use super::Triangle;

/// Their positions in `triangles`, ascending.
pub(super) fn distinct(triangles: &[Triangle]) -> Vec<u32> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(size: f32, index: u32) -> Triangle {
        Triangle::new([Vec3::ZERO, size * Vec3::X, size * Vec3::Y], index)
    }

    #[test]
    fn one_of_identical_triangles_is_held() {
        let triangles = [triangle(1.0, 4), triangle(2.0, 3), triangle(1.0, 2), triangle(0.0, 1), triangle(2.0, 5)];
        assert_eq!(distinct(&triangles), [1, 2]);
        let mut cut = triangles.map(|triangle| triangle.cut_out(u32::from(triangle.index() != 3)));
        assert_eq!(distinct(&cut), [0, 1, 2, 4], "what is cut out may differ");
        cut[0] = triangle(1.0, 4);
        assert_eq!(distinct(&cut), [0, 1, 2, 4]);
        let turned = [Vec3::X, Vec3::Y, Vec3::ZERO];
        assert_eq!(distinct(&[triangle(1.0, 0), Triangle::new(turned, 1)]), [0, 1], "other corners come first");
    }
}
