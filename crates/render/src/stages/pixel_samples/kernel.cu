// The samples of pixels on a CUDA device: twin of cpu.rs, one thread per sample.
#ifndef ALPHA_TEST
// Scenes with cut-outs or instances use the module with ALPHA_TEST.
#define INSTANCES 0
#endif
#include "cuda/prelude.cuh"

#include "accel/walk.cuh"
#include "cuda/tally.cuh"
#include "cuda/warp.cuh"
#include "data/clip.cuh"
#include "shading/ids.cuh"
#include "stages/pixel_samples/same_surface.cuh"

// The threads of a warp along a curve: any four, eight or sixteen from a multiple of their number on take neighbouring pixels.
DEVICE unsigned along_curve(unsigned thread) {
    const unsigned column = (thread & 1) | (thread >> 1 & 2) | (thread >> 2 & 4), row = (thread >> 1 & 1) | (thread >> 2 & 2);
    return (thread & ~(WARP - 1)) | row << 3 | column;
}

// The pixel and the sample of a thread, where each of `width` neighbouring threads takes a sample of a pixel.
struct Place {
    unsigned ray, sample;
    bool has_ray;
};

// Neighbouring threads take neighbouring pixels, too.
DEVICE Place place_of(const PixelSamples &args, unsigned tile, unsigned part, unsigned width) {
    const unsigned thread = along_curve(part * (BLOCK / width) + threadIdx.x / width);
    Place place = {0, threadIdx.x % width, false};
    place.has_ray = ray_of_thread(args.rays, tile, thread, place.ray);
    return place;
}

// 1. What each sample sees. A warp casts several samples of each of a few pixels: its rays are as close together as they can be.
template <class Structure>
DEVICE void pixel_samples(const PixelSamples &args, const Structure &structure) {
    const unsigned long long block = args.first_block + blockIdx.x;
    const unsigned tile = (unsigned)(block / args.samples[1]), part = (unsigned)(block % args.samples[1]);
    const unsigned first = part / args.together * args.together;
    const Place place = place_of(args, tile, part - first, args.together);
    if (place.has_ray) {
        const unsigned ray = place.ray, sample = first + place.sample;
        const Ray along = sample_ray(args, ray, sample);
        const Limits limits = limits_of(args.rays.view, along);
        const Hit hit = from_origin(limits, closest_hit(structure, args.tally, between(limits, along)));
        store_hit(args.hits + (unsigned long long)sample * args.rays.count, ray, hit);
    }
}

KERNEL_PER_STRUCTURE(pixel_samples, PixelSamples, BLOCK, 4)

// Counts a sample of a pixel by what it sees: `ids` is 0 for objects, 1 for materials. Further things than there are slots are not counted.
DEVICE void count_sample(const PixelSamples &args, unsigned ids, unsigned ray, unsigned id) {
    for (unsigned slot = 0; slot < args.matte_slots; ++slot) {
        unsigned *number = args.mattes + (ids * args.matte_slots + slot) * 2ull * args.film_pixels + ray;
        if (*number != 0 && *number != id)
            continue;
        *number = id;
        number[args.film_pixels] += 1;
        return;
    }
}

// The numbers of what samples see: how many see each, and the nearest one's.
KERNEL(count_ids, PixelSamples, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, (unsigned)(args.first_block + blockIdx.x), threadIdx.x, ray))
        return;
    // Nothing so far is zero.
    float depth = args.depth[ray];
    for (unsigned sample = 0; sample < args.samples[1]; ++sample) {
        const Hit hit = sample_hit(args, ray, sample);
        if (hit.triangle == Hit::NONE)
            continue;
        const unsigned object = object_of(args.scene, hit.triangle), material = material_of(args.scene, hit.triangle);
        count_sample(args, 0, ray, object);
        count_sample(args, 1, ray, material);
        if (depth != 0.0f && hit.t >= depth)
            continue;
        depth = hit.t;
        args.ids[ray] = object;
        args.ids[args.film_pixels + ray] = material;
    }
}

// Coverage, and the layers of the nearest sample.
KERNEL(nearest_samples, PixelSamples, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, (unsigned)(args.first_block + blockIdx.x), threadIdx.x, ray))
        return;
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

// The facet of one lane.
DEVICE Facet broadcast(const Facet &facet, unsigned lane) {
    Facet answer = facet;
    answer.point.position = warp_broadcast(facet.point.position, lane);
    answer.point.normal = warp_broadcast(facet.point.normal, lane);
    answer.smooth = warp_broadcast(facet.smooth, lane);
    answer.material = __shfl_sync(ALL_LANES, facet.material, lane);
    answer.width = __shfl_sync(ALL_LANES, facet.width, lane);
    return answer;
}

// What a thread knows of its sample.
struct Sampled {
    Hit hit;
    Facet facet;
};

// Whether two samples of a pixel may be shaded together.
DEVICE bool is_alike(unsigned triangle, const Facet &facet, const Sampled &other) {
    return triangle == other.hit.triangle ||
           (triangle != Hit::NONE && other.hit.triangle != Hit::NONE && continues(facet, other.facet));
}

// The owner of each thread's sample: the first one of its pixel that lies on a surface with it, and is not owned by another. `lanes` are
// those of the pixel that have a sample, `base` is the first. All lanes of the warp take part.
DEVICE unsigned owner_of(const Sampled &own, unsigned lanes, unsigned base) {
    const unsigned lane = lane_of_thread();
    unsigned rest = lanes, owner = 0;
    while (__ballot_sync(ALL_LANES, rest != 0) != 0) {
        const unsigned first = rest != 0 ? __ffs(rest) - 1 : lane;
        const unsigned triangle = __shfl_sync(ALL_LANES, own.hit.triangle, first);
        const Facet facet = broadcast(own.facet, first);
        const bool joins = (rest >> lane & 1) != 0 && is_alike(triangle, facet, own);
        const unsigned joined = __ballot_sync(ALL_LANES, joins) & lanes;
        owner = joins ? first - base : owner;
        rest &= ~joined;
    }
    return owner;
}

// 2. Which pixels are shared, and which samples of the others lie on one surface? A thread for each sample, those of a pixel in one warp.
KERNEL(merge_samples, PixelSamples, BLOCK, 4) {
    const unsigned long long block = args.first_block + blockIdx.x;
    const unsigned width = args.lanes, lane = lane_of_thread();
    const Place place = place_of(args, (unsigned)(block / width), (unsigned)(block % width), width);
    const bool has = place.has_ray && place.sample < args.samples[1];
    const unsigned base = lane / width * width;
    const unsigned lanes = __ballot_sync(ALL_LANES, has) & (width == WARP ? ALL_LANES : ((1u << width) - 1) << base);

    const Hit center = place.has_ray ? load_hit(args.centers, place.ray) : Hit{INFINITE, 0.0f, 0.0f, Hit::NONE};
    Sampled own = {};
    own.hit = has ? sample_hit(args, place.ray, place.sample) : center;
    // Most pixels need no facets.
    // Each sample has a ray of its own behind the surface.
    const bool may_share = !is_transmissive(args.scene, center);
    const unsigned others = __ballot_sync(ALL_LANES, own.hit.triangle != center.triangle || !may_share);
    bool shared = true;
    unsigned owner = 0;
    if (others != 0) {
        if ((others & lanes) != 0) {
            if (has && own.hit.triangle != Hit::NONE)
                own.facet = facet_of(args, sample_ray(args, place.ray, place.sample), own.hit);
            Facet middle = {};
            if (place.has_ray && center.triangle != Hit::NONE)
                middle = facet_of(args, ray_at(args.rays, place.ray), center);
            shared = !has || (may_share && is_alike(center.triangle, middle, own));
        }
        const unsigned apart = __ballot_sync(ALL_LANES, !shared) & lanes;
        shared = apart == 0;
        owner = owner_of(own, shared ? 0 : lanes, base);
    }
    if (!place.has_ray)
        return;
    if (has && !shared)
        args.owners[(unsigned long long)place.sample * args.rays.count + place.ray] = (unsigned char)owner;
    if (place.sample == 0) {
        args.state[place.ray] = shared ? PIXEL_SHARED : 0;
        if (!shared && !args.keeps)
            store_hit(args.centers, place.ray, Hit{INFINITE, 0.0f, 0.0f, Hit::NONE});
    }
}
