// The kernels of gathered_rays.cu, for scenes in which some triangles are cut out.
#define CUT_OUTS 1
#include "gathered/gathered_rays.cu"
