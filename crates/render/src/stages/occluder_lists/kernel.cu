// Occluder lists on a CUDA device: twin of cpu.rs.
//
// `find_starts_*`: where searches start, a warp for each tile and light. `shadows_N_*`: samples in up to N words of bits, by warps that
// take bundles until none is left.
#ifndef ALPHA_TEST
// Scenes with cut-outs or instances use the module with ALPHA_TEST.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "stages/occluder_lists/bundle.cuh"

template <class Structure>
DEVICE void shadows_1(const Shadows &args, const Structure &structure) { shadows_of_bundles<1>(args, structure); }

template <class Structure>
DEVICE void shadows_3(const Shadows &args, const Structure &structure) { shadows_of_bundles<3>(args, structure); }

template <class Structure>
DEVICE void shadows_10(const Shadows &args, const Structure &structure) { shadows_of_bundles<MAX_WORDS>(args, structure); }

template <class Structure>
DEVICE void find_starts(const Shadows &args, const Structure &structure) { starts_of_tile(args, structure); }

KERNEL_PER_STRUCTURE(find_starts, Shadows, WARP, 24)
KERNEL_PER_STRUCTURE(shadows_1, Shadows, WARP, 28)
KERNEL_PER_STRUCTURE(shadows_3, Shadows, WARP, 28)
KERNEL_PER_STRUCTURE(shadows_10, Shadows, WARP, 16)
