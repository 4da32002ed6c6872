// Gathered light on a CUDA device, the steps that ask an acceleration structure: see mod.rs. Launched by cuda/.
#define CUT_OUTS 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "gathered/bounce.cuh"
#include "gathered/sites.cuh"

KERNEL_PER_STRUCTURE(place_sites, Lookup, WARP, 16)
KERNEL_PER_STRUCTURE(place_nodes, Bounce, WARP, 16)
KERNEL_PER_STRUCTURE(settle_links, Lookup, BLOCK, 4)
KERNEL_PER_STRUCTURE(trace_fans, Fans, BLOCK, 4)
KERNEL_PER_STRUCTURE(see, Fans, BLOCK, 3)
KERNEL_PER_STRUCTURE(hide_nodes, Bounce, BLOCK, 4)
