// Step 4 on a CUDA device: which lights does each light point see? Twin of cpu.rs, one thread per light point.
#define ALPHA_TEST 1
#ifndef INSTANCES
// Scenes with instances use the module with INSTANCES.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "light_mesh/bricks.cuh"
#include "light_mesh/lattice.cuh"
#include "shadow/shadow.cuh"

// Number of shadow rays from a light point that reach the light: of one, or of those of this launch.
template <class Structure>
DEVICE unsigned rays_that_arrive(const LongTests &args, const Structure &structure, IVec3 index) {
    const Vec3 from = lattice_point(args.mesh, index);
    const Targets targets = targets_of(args.scene, args.sampling, args.light, from, lattice_packed(args.mesh, index));
    unsigned seen = 0;
    for (unsigned sample = args.first_sample; sample < args.first_sample + args.sample_count; ++sample)
        seen += !hidden(structure, args.tally, targets.light, from, target(targets, sample));
    return seen;
}

template <class Structure>
DEVICE void long_tests(const LongTests &args, const Structure &structure) {
    const unsigned number = blockIdx.x * blockDim.x + threadIdx.x;
    if (number >= args.point_count)
        return;
    const unsigned long long rank = args.first_point + number;
    const unsigned long long place = __ldg(args.points.points + rank);
    const unsigned long long slot = place >> POINT_BITS;
    const unsigned bit = place & ((1u << POINT_BITS) - 1);
    const Light &light = args.scene.lights[args.light];
    const unsigned long long brick = args.points.table.keys[slot] - 1;
    const unsigned seen = rays_that_arrive(args, structure, point_of(brick << POINT_BITS | bit));
    const VisibilityOfLight lit = args.lit;
    if (has_size(light))
        lit.seen[rank] = (unsigned short)((args.first_sample == 0 ? 0 : lit.seen[rank]) + seen);
    else if (seen > 0)
        atomicOr(&lit.bits[slot], 1ull << bit);
}

KERNEL_PER_STRUCTURE(long_tests, LongTests, BLOCK, 4)
