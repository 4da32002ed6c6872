// Step 4 on a CUDA device: which lights does each light point see? Twin of cpu.rs, one thread a light point.
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "light_mesh/bricks.cuh"
#include "light_mesh/lattice.cuh"
#include "sampling.cuh"
#include "surface.cuh"

// Shadow rays from a light point that reach the light: one, or those of this launch.
template <class Structure>
DEVICE unsigned rays_that_arrive(const LongTests &args, const Structure &structure, const Light &light, IVec3 index) {
    const Vec3 from = lattice_point(args.mesh, index);
    const float reach = scene_reach(args.scene, from);
    const bool sized = has_size(light);
    const Pattern pattern = pattern_of(args.sampling.seed, lattice_packed(args.mesh, index), args.light);
    unsigned seen = 0;
    for (unsigned sample = args.first_sample; sample < args.first_sample + args.sample_count; ++sample) {
        const Vec3 target = sized ? light_point(light, from, reach, pattern_point(pattern, sample))
                                  : light_center(light, from, reach);
        seen += !occluded(structure, args.tally, long_segment(from, target));
    }
    return seen;
}

template <class Structure>
DEVICE void long_tests(const LongTests &args, const Structure &structure) {
    const unsigned number = blockIdx.x * blockDim.x + threadIdx.x;
    if (number >= args.point_count)
        return;
    const unsigned long long rank = args.first_point + number;
    const unsigned long long place = __ldg(args.points.points + rank);
    const unsigned long long slot = place >> 6;
    const unsigned bit = place & 63;
    const Light &light = args.scene.lights[args.light];
    const unsigned seen = rays_that_arrive(args, structure, light, point_of((args.points.table.keys[slot] - 1) << 6 | bit));
    const LitBy lit = args.lit[args.light];
    if (has_size(light))
        lit.seen[rank] = (unsigned short)((args.first_sample == 0 ? 0 : lit.seen[rank]) + seen);
    else if (seen > 0)
        atomicOr(&lit.bits[slot], 1ull << bit);
}

KERNEL(long_tests_bvh, LongTests, 256, 4) { long_tests(args, args.scene.bvh); }

KERNEL(long_tests_grid, LongTests, 256, 4) { long_tests(args, args.scene.grid); }

KERNEL(long_tests_brute_force, LongTests, 256, 4) { long_tests(args, args.scene.brute_force); }
