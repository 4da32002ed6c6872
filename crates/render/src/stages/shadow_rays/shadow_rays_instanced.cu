// The kernels of kernel.cu that test triangles, for scenes with shapes in many places.
#define INSTANCES 1
#define WALKS_bvh 0
#include "stages/shadow_rays/kernel.cu"
