// Step 2 on a CUDA device: which light points does each surface point see? Formula (2).
//
// 1. `short_tests_by_cell_*`: twin of cells.rs and batch.rs, one warp per bundle.
// 2. `half_balls_of_bundles`, `short_tests_plain_*`: twin of plain.rs, the reference: every segment walks through the
//    acceleration structure.
#ifndef ALPHA_TEST
// Scenes with cut-outs or instances use the module with ALPHA_TEST.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "stages/short_tests/by_cell.cuh"

#include "stages/short_tests/plain.cuh"

KERNEL_PER_STRUCTURE(short_tests_by_cell, ShortTests, WARP, 32)

KERNEL_PER_STRUCTURE(short_tests_by_cell_large, ShortTests, WARP, 32)

KERNEL(half_balls_of_bundles, ShortTests, WARP, 32) {
    half_balls_of_bundle(args);
}

KERNEL_PER_STRUCTURE(short_tests_plain, ShortTests, WARP, 32)
