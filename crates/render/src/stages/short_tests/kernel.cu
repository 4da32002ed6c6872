// Step 2 on a CUDA device: which light points does each object point see? Formula (2).
//
// 1. `group_points`, `gather_items`: object points by light-mesh cell, at most 32 to an item. Twin of group.rs, tile by tile: the
//    cells of a tile of the picture are grouped, not those of the whole picture, so that no large sort is needed.
// 2. `short_tests_by_cell`: twin of cells.rs and batch.rs, a warp an item.
// 3. `half_balls_of_items`, `short_tests_plain_*`: twin of plain.rs, the oracle: every segment walks through the acceleration
//    structure.
#include "cuda/prelude.cuh"

#include "stages/short_tests/group.cuh"

#include "stages/short_tests/by_cell.cuh"

#include "stages/short_tests/plain.cuh"

KERNEL(group_points, GroupCells, 1024, 2) {
    group_points_of_tile(args);
}

KERNEL(gather_items, GroupCells, 1024, 1) {
    gather_items_of_tile(args);
}

KERNEL(short_tests_by_cell, ShortTests, 32, 32) {
    short_tests_by_cell_of_item<true>(args);
}

// For templates whose masks do not fit into shared memory.
KERNEL(short_tests_by_cell_large, ShortTests, 32, 32) {
    short_tests_by_cell_of_item<false>(args);
}

KERNEL(half_balls_of_items, ShortTests, 32, 32) {
    half_balls_of_item(args);
}

KERNEL(short_tests_plain_bvh, ShortTests, 32, 32) {
    short_tests_plain_of_item(args, args.scene.bvh);
}

KERNEL(short_tests_plain_grid, ShortTests, 32, 32) {
    short_tests_plain_of_item(args, args.scene.grid);
}

KERNEL(short_tests_plain_brute_force, ShortTests, 32, 32) {
    short_tests_plain_of_item(args, args.scene.brute_force);
}
