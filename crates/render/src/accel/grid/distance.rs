//! How far each cell of the outer grid is from the nearest one that holds something.
//!
//! From an empty cell at distance d, a walk can skip to where it leaves the cube of cells less than d away: they are all empty. The
//! distance is therefore the largest of those on the three axes (the chessboard distance). Two sweeps find it exactly (Rosenfeld,
//! Pfaltz: *Distance Functions on Digital Pictures*, Pattern Recognition 1968): one forward, in which each cell takes the least
//! distance of the thirteen neighbours before it, plus one, and one backward.

use super::Grid;

impl Grid {
    /// For each cell of the outer grid, x fastest, the distance in cells to the nearest non-empty one: 0 for non-empty cells, at most 255.
    pub(crate) fn distances(&self) -> Vec<u8> {
        let dims = self.dims().map(|count| count as usize);
        let offsets = &self.cells[3..3 + dims.iter().product::<usize>()];
        let mut distances: Vec<u8> = offsets.iter().map(|&offset| if offset < 0 { u8::MAX } else { 0 }).collect();
        spread(&mut distances, dims);
        distances
    }
}

/// From 0 and 255, for cells that hold something and others, to distances.
fn spread(distances: &mut [u8], dims: [usize; 3]) {
    // The neighbours after a cell are those before it in the reversed list.
    for _ in 0..2 {
        sweep(distances, dims);
        distances.reverse();
    }
}

/// Each cell takes the least distance of the neighbours before it, plus one, if that is less than its own.
fn sweep(distances: &mut [u8], [x, y, z]: [usize; 3]) {
    let mut before = vec![u8::MAX; x];
    for row in 0..y * z {
        // 1. The neighbouring rows: one in the same layer, three in the layer before.
        let column = row % y;
        let (done, rest) = distances.split_at_mut(row * x);
        before.fill(u8::MAX);
        let mut take = |neighbour: usize| {
            let cells = &done[neighbour * x..][..x];
            before.iter_mut().zip(cells).for_each(|(least, &distance)| *least = distance.min(*least));
        };
        if column > 0 {
            take(row - 1);
        }
        if row >= y {
            take(row - y);
            if column > 0 {
                take(row - y - 1);
            }
            if column + 1 < y {
                take(row - y + 1);
            }
        }
        // 2. In these rows, the cells next to this one and their neighbours; then the previous cell in this row.
        let own = &mut rest[..x];
        for (place, cell) in own.iter_mut().enumerate() {
            let near = &before[place.saturating_sub(1)..(place + 2).min(x)];
            let least = near.iter().fold(u8::MAX, |least, &distance| least.min(distance));
            *cell = least.saturating_add(1).min(*cell);
        }
        let mut last = u8::MAX;
        for cell in own {
            last = last.saturating_add(1).min(*cell);
            *cell = last;
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::{GridOptions, Levels, Triangle};

    /// The distances by their definition.
    fn expected(occupied: &[bool], [x, y, z]: [usize; 3]) -> Vec<u8> {
        let cells = || (0..x * y * z).map(|cell| [cell % x, cell / x % y, cell / x / y]);
        let holders: Vec<[usize; 3]> = cells().zip(occupied).filter(|(_, held)| **held).map(|(cell, _)| cell).collect();
        let distance = |a: [usize; 3], b: &[usize; 3]| (0..3).map(|axis| a[axis].abs_diff(b[axis])).max().unwrap_or(0);
        cells()
            .map(|cell| holders.iter().map(|holder| distance(cell, holder)).min().unwrap_or(255).min(255) as u8)
            .collect()
    }

    #[test]
    fn two_sweeps_find_the_distances_by_definition() {
        let mut state = 7u64;
        for dims in [[1, 1, 1], [9, 1, 1], [1, 9, 1], [1, 1, 9], [13, 7, 1], [8, 9, 10], [17, 5, 6], [700, 1, 2]] {
            for rarity in [2, 10, 200, 1000] {
                let cells = dims.iter().product();
                let occupied: Vec<bool> = (0..cells)
                    .map(|_| {
                        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                        (state >> 33).is_multiple_of(rarity)
                    })
                    .collect();
                let mut distances: Vec<u8> = occupied.iter().map(|&held| if held { 0 } else { u8::MAX }).collect();
                spread(&mut distances, dims);
                assert_eq!(distances, expected(&occupied, dims), "{dims:?}, one in {rarity}");
            }
        }
    }

    #[test]
    fn a_grid_knows_its_empty_cells() {
        let triangle = |at: Vec3, index| Triangle::new([at, at + 0.1 * Vec3::X, at + 0.1 * Vec3::Y], index);
        let triangles = [triangle(Vec3::ZERO, 0), triangle(Vec3::new(10.0, 3.0, 5.0), 1)];
        let grid = Grid::new(
            &triangles,
            &GridOptions { dims: Some([10, 3, 5]), levels: Levels::One, ..GridOptions::default() },
        )
        .unwrap();
        let distances = grid.distances();
        let at = |x: usize, y: usize, z: usize| distances[(z * 3 + y) * 10 + x];
        assert_eq!([at(0, 0, 0), at(9, 2, 4), at(1, 1, 1), at(4, 0, 0), at(5, 2, 4), at(6, 0, 1)], [0, 0, 1, 4, 4, 3]);
        assert_eq!(Grid::new(&[], &GridOptions::default()).unwrap().distances(), [255]);
    }
}
