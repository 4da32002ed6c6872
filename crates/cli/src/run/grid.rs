//! `lightmesh grid`.

use std::time::Instant;

use lightmesh::render::PreparedGeometry;
use lightmesh::render::accel::{Grid, GridOptions, Levels};
use lightmesh::request::BUILDING;
use lightmesh::scene::Instancing;
use lightmesh_memory::Budget;

use super::open::open_stored;
use crate::args::GridArgs;
use crate::failure::Failure;
use crate::memory;
use crate::output::{self, Outputs};
use crate::progress::Watcher;

pub(super) fn run(args: &GridArgs) -> Result<(), Failure> {
    output::check_writable(&args.output)?;
    let outputs = Outputs::new([("-o", Some(&*args.output))])?;
    let watcher = Watcher::plain(args.quiet);
    // Normals are no part of the grid.
    let scene = open_stored(&args.scene, None, Instancing::Never, &outputs, &watcher)?;

    let start = Instant::now();
    let levels = if args.levels == 1 { Levels::One } else { Levels::Two };
    let budget = Budget::new(args.scene.reading.request().memory_limit.map(|limit| limit.0));
    let options = GridOptions { dims: args.grid.map(|dims| dims.0), levels, budget };
    let build = || -> Result<Grid, Failure> {
        let triangles = PreparedGeometry::triangles_of(&scene.geometry, budget)?;
        Ok(Grid::new(&triangles, &options)?)
    };
    let grid = memory::during(BUILDING, build)?;
    let seconds = start.elapsed().as_secs_f64();
    grid.save(&args.output)?;

    let ([nx, ny, nz], count, file) = (grid.dims(), scene.geometry.mesh.triangles.len(), args.output.display());
    watcher.summary(&format!("{}, {count} triangles: {nx}x{ny}x{nz} cells in {seconds:.3} s, {file}", scene.name));
    Ok(())
}
