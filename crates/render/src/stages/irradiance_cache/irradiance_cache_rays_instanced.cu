// The kernels of irradiance_cache_rays.cu that test triangles, for scenes with shapes in many places.
#define INSTANCES 1
#define WALKS_bvh 0
#include "stages/irradiance_cache/irradiance_cache_rays.cu"
