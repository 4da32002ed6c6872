//! Surface points by cell on the CPU: one sort by the cells' keys.

use rayon::prelude::*;

use crate::data::cells::CellGroups;
use crate::data::wave::HostWave;
use crate::light_mesh::{LightMesh, PointKey, point_key};

pub(crate) fn cells(wave: &HostWave, mesh: &LightMesh) -> CellGroups {
    // 1. The cell of each surface point.
    let seen = (0..wave.hits.len()).into_par_iter().filter(|&ray| wave.sees(ray));
    let mut keyed: Vec<(PointKey, u32)> =
        seen.map(|ray| (point_key(mesh.lattice.cell(wave.surface_point(ray).position)), ray as u32)).collect();

    // 2. Sort by cell; within a cell by ray, so that neighbours stay neighbours.
    keyed.par_sort_unstable();

    // 3. Every cell begins a group.
    CellGroups::of_sorted(&keyed)
}
