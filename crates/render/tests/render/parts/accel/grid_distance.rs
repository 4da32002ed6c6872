use glam::Vec3;
use lightmesh_render::accel::{Grid, GridOptions, Levels, Triangle};
use lightmesh_render::internals::accel::spread;

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
    let grid =
        Grid::new(&triangles, &GridOptions { dims: Some([10, 3, 5]), levels: Levels::One, ..GridOptions::default() })
            .unwrap();
    let distances = grid.distances();
    let at = |x: usize, y: usize, z: usize| distances[(z * 3 + y) * 10 + x];
    assert_eq!([at(0, 0, 0), at(9, 2, 4), at(1, 1, 1), at(4, 0, 0), at(5, 2, 4), at(6, 0, 1)], [0, 0, 1, 4, 4, 3]);
    assert_eq!(Grid::new(&[], &GridOptions::default()).unwrap().distances(), [255]);
}
