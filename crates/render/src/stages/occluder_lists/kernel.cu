// Occluder lists on a CUDA device: twin of cpu.rs, a warp for each item. `shadows_N_*`: samples in up to N words of bits.
#include "cuda/prelude.cuh"

#include "stages/occluder_lists/item.cuh"

template <class Structure>
DEVICE void shadows_1(const Shadows &args, const Structure &structure) { shadows_of_item<1>(args, structure); }

template <class Structure>
DEVICE void shadows_3(const Shadows &args, const Structure &structure) { shadows_of_item<3>(args, structure); }

template <class Structure>
DEVICE void shadows_10(const Shadows &args, const Structure &structure) { shadows_of_item<MOST_WORDS>(args, structure); }

KERNEL_PER_STRUCTURE(shadows_1, Shadows, WARP, 28)
KERNEL_PER_STRUCTURE(shadows_3, Shadows, WARP, 28)
KERNEL_PER_STRUCTURE(shadows_10, Shadows, WARP, 16)
