// Gathered light on a CUDA device, the steps that ask an acceleration structure: see mod.rs. Launched by cuda.rs.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "stages/irradiance_cache/bounce.cuh"
#include "stages/irradiance_cache/records.cuh"

KERNEL_PER_STRUCTURE(place_records, Lookup, WARP, 16)
KERNEL_PER_STRUCTURE(place_nodes, Bounce, WARP, 16)
KERNEL_PER_STRUCTURE(settle_links, Lookup, BLOCK, 4)
KERNEL_PER_STRUCTURE(trace_hemispheres, HemisphereRays, BLOCK, 4)
KERNEL_PER_STRUCTURE(see, HemisphereRays, BLOCK, 3)
KERNEL_PER_STRUCTURE(hide_nodes, Bounce, BLOCK, 4)
