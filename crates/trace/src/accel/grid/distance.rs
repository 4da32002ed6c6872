//! How far each cell of the outer grid is from the nearest one that holds something.
//!
//! From an empty cell at distance d, a walk can skip to where it leaves the cube of cells less than d away: they are all empty. The
//! distance is therefore the largest of those on the three axes (the chessboard distance). Two sweeps find it exactly (Rosenfeld,
//! Pfaltz: *Distance Functions on Digital Pictures*, Pattern Recognition 1968): one forward, in which each cell takes the least
//! distance of the thirteen neighbours before it, plus one, and one backward.

use super::cells::Grid;

impl Grid {
    /// For each cell of the outer grid, x fastest, the distance in cells to the nearest non-empty one: 0 for non-empty cells, at most 255.
    pub fn distances(&self) -> Vec<u8> {
        let dims = self.dims().map(|count| count as usize);
        let offsets = &self.cells[3..3 + dims.iter().product::<usize>()];
        let mut distances: Vec<u8> = offsets.iter().map(|&offset| if offset < 0 { u8::MAX } else { 0 }).collect();
        spread(&mut distances, dims);
        distances
    }
}

/// From 0 and 255, for cells that hold something and others, to distances.
pub fn spread(distances: &mut [u8], dims: [usize; 3]) {
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
