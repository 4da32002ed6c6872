// The kernels of kernel.cu that test triangles, for scenes in which some are cut out, or that have instances.
#define ALPHA_TEST 1
#include "stages/occluder_lists/kernel.cu"
