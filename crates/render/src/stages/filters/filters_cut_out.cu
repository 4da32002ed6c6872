// The kernels of kernel.cu that test triangles, for scenes in which some are cut out.
#define CUT_OUTS 1
#include "stages/filters/kernel.cu"
