// The kernels of gathered_rays.cu that test triangles, for scenes with shapes in many places.
#define INSTANCES 1
#define WALKS_bvh 0
#include "gathered/gathered_rays.cu"
