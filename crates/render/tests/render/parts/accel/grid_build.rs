use glam::Vec3;
use lightmesh_render::accel::{Grid, GridError, GridOptions, Levels, Triangle};

fn built(triangles: &[Triangle], dims: [u32; 3], levels: Levels) -> Result<Grid, GridError> {
    Grid::new(triangles, &GridOptions { dims: Some(dims), levels, ..GridOptions::default() })
}

fn triangle(at: Vec3, index: u32) -> Triangle {
    Triangle::new([at, at + 0.1 * Vec3::X, at + 0.1 * Vec3::Y], index)
}

/// One of many that fill the unit square.
fn wide(index: u32) -> Triangle {
    Triangle::new([Vec3::ZERO, Vec3::X, Vec3::new(1e-6 * index as f32, 1.0, 0.0)], index)
}

#[test]
fn the_flat_form_is_that_of_the_thesis() {
    let triangles = [triangle(Vec3::ZERO, 5), triangle(Vec3::new(4.0, 4.0, 0.0), 6), triangle(0.1 * Vec3::X, 7)];
    let grid = built(&triangles, [2, 2, 1], Levels::One).unwrap();
    // nx ny nz, four offsets, a leaf with triangles 0 and 1, a leaf with triangle 2.
    assert_eq!(*grid.cells(), [2, 2, 1, 7, -1, -1, 9, -2, 0, -1, 2]);
    assert_eq!(grid.triangles().iter().map(Triangle::index).collect::<Vec<_>>(), [5, 7, 6]);
    assert_eq!(*grid.sources(), [0, 2, 1]);
}

#[test]
fn full_cells_hold_grids() {
    let corner = (0..30).map(|index| triangle(Vec3::splat(0.03 * index as f32), index));
    let triangles: Vec<_> = corner.chain([triangle(Vec3::splat(9.0), 30)]).collect();
    let grid = built(&triangles, [2, 2, 2], Levels::Two).unwrap();
    let nested = grid.cells()[3] as usize;
    assert!(grid.cells()[nested] > 0, "the first cell contains a grid");
    assert!(built(&triangles, [2, 2, 2], Levels::One).unwrap().cells().len() < grid.cells().len());
}

#[test]
fn what_a_grid_holds_is_told_once() {
    let others =
        [triangle(Vec3::splat(0.5), 20), Triangle::new(wide(0).corners(), 30), Triangle::new([Vec3::NAN; 3], 40)];
    let triangles: Vec<_> = (0..9).map(wide).chain(others).collect();
    for levels in [Levels::One, Levels::Two] {
        let grid = built(&triangles, [3, 3, 1], levels).unwrap();
        assert!(grid.references() > 10, "some are in several cells");
        let held: Vec<u32> = grid.held().iter().map(Triangle::index).collect();
        assert_eq!(held, [0, 1, 2, 3, 4, 5, 6, 7, 8, 20]);
    }
}

#[test]
fn impossible_sizes_are_refused_before_anything_is_allocated() {
    let triangles = [triangle(Vec3::ZERO, 0)];
    assert_eq!(built(&triangles, [4, 0, 4], Levels::One).unwrap_err(), GridError::NoCells { dims: [4, 0, 4] });
    for dims in [[u32::MAX; 3], [1 << 16, 1 << 15, 1], [1 << 14, 1 << 14, 1]] {
        let error = built(&triangles, dims, Levels::One).unwrap_err();
        assert!(matches!(error, GridError::TooLarge { what: "cells", .. }), "{error}");
        assert!(error.to_string().contains("use fewer cells"), "{error}");
    }
    let triangles: Vec<_> = (0..300).map(wide).collect();
    for dims in [[3000, 3000, 1], [300, 10_000, 10]] {
        let error = built(&triangles, dims, Levels::Two).unwrap_err();
        assert!(matches!(error, GridError::TooLarge { what: "triangle references", .. }), "{error}");
    }
}

#[test]
fn triangles_that_fill_the_scene_make_automatic_grids_coarse() {
    let triangles: Vec<_> = (0..5000).map(wide).collect();
    for levels in [Levels::One, Levels::Two] {
        let grid = Grid::new(&triangles, &GridOptions { dims: None, levels, ..GridOptions::default() }).unwrap();
        assert!(grid.triangles().len() < 400_000, "{levels:?}: {}", grid.triangles().len());
    }
}

#[test]
fn a_grid_that_rays_cross_for_ever_is_refused() {
    let one = [triangle(Vec3::ZERO, 0)];
    let grid = |dims| Grid::new(&one, &GridOptions { dims: Some(dims), ..GridOptions::default() });
    assert!(grid([1, 1, 10_000]).is_ok());
    for dims in [[1, 1, 10_000_000], [20_000, 1, 1], [8000, 8000, 1000]] {
        assert!(matches!(grid(dims), Err(GridError::TooLarge { .. })), "{dims:?}");
    }
}

#[test]
fn flat_and_empty_scenes_have_few_cells() {
    let flat: Vec<_> = (0..100).map(|index| triangle(Vec3::X * index as f32, index)).collect();
    let grid = Grid::new(&flat, &GridOptions { dims: None, levels: Levels::One, ..GridOptions::default() }).unwrap();
    assert_eq!(grid.dims()[2], 1);
    assert!(grid.dims()[0] > 50);
    assert_eq!(Grid::new(&[], &GridOptions::default()).unwrap().dims(), [1, 1, 1]);
}
