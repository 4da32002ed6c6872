// Surface points by light-mesh cell on a CUDA device, at most 32 per bundle. Twin of cpu.rs, tile by tile: the cells of a tile of the
// image are grouped, not those of the whole image, so that no large sort is needed.
//
// 1. to 3. `group_points`: the bundles of each tile.
// 4. `gather_bundles`: those of all tiles in one list.
#include "cuda/prelude.cuh"

#include "stages/cells/group.cuh"

KERNEL(group_points, GroupCells, TILE, 2) {
    group_points_of_tile(args);
}

KERNEL(gather_bundles, GroupCells, TILE, 1) {
    gather_bundles_of_tile(args);
}
