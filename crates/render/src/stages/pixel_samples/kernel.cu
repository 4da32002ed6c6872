// The samples of pixels on a CUDA device: twin of cpu.rs, one thread per sample, then one per pixel.
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "cuda/tally.cuh"
#include "stages/pixel_samples/alike.cuh"

// 1. What each sample sees.
template <class Structure>
DEVICE void pixel_samples(const PixelSamples &args, const Structure &structure) {
    const unsigned width = args.rays.view.size[0], rows = args.rays.count / width;
    const unsigned blocks = (width + BLOCK_SIDE - 1) / BLOCK_SIDE * ((rows + BLOCK_SIDE - 1) / BLOCK_SIDE);
    const unsigned long long block = args.first_block + blockIdx.x;
    const unsigned sample = (unsigned)(block / blocks);
    unsigned ray;
    if (ray_of_thread(args.rays, (unsigned)(block % blocks), threadIdx.x, ray)) {
        const Hit hit = closest_hit(structure, args.tally, sample_ray(args, ray, sample));
        store_hit(args.hits + (unsigned long long)sample * args.rays.count, ray, hit);
    }
}

KERNEL_PER_STRUCTURE(pixel_samples, PixelSamples, BLOCK, 4)

// Coverage, and the layers of the nearest sample.
DEVICE void take_nearest(const PixelSamples &args, unsigned ray) {
    for (unsigned sample = 0; sample < args.samples[1]; ++sample) {
        const Hit hit = sample_hit(args, ray, sample);
        if (hit.triangle == Hit::NONE)
            continue;
        if (args.coverage != nullptr)
            args.coverage[ray] += args.weight;
        // Nothing so far is zero.
        if (args.depth != nullptr && (args.depth[ray] == 0.0f || hit.t < args.depth[ray])) {
            const Facet facet = facet_of(args, sample_ray(args, ray, sample), hit);
            args.depth[ray] = hit.t;
            args.position[ray] = facet.point.position;
            args.normal[ray] = facet.point.normal;
        }
    }
}

// 2. Which pixels are shared?
KERNEL(merge_samples, PixelSamples, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, (unsigned)(args.first_block + blockIdx.x), threadIdx.x, ray))
        return;
    take_nearest(args, ray);
    unsigned state = 0;
    if (!args.apart) {
        const Hit center = load_hit(args.centers, ray);
        const Ray through = ray_at(args.rays, ray);
        // Each sample has a mirror ray of its own.
        bool shared = !mirrors(args, center);
        for (unsigned sample = 0; shared && sample < args.samples[1]; ++sample)
            shared = is_alike(args, through, center, sample_ray(args, ray, sample), sample_hit(args, ray, sample));
        if (!shared && !args.keeps)
            store_hit(args.centers, ray, Hit{INFINITE, 0.0f, 0.0f, Hit::NONE});
        state = shared ? PIXEL_SHARED : 0;
    }
    args.state[ray] = state;
}
