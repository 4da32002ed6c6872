// Fragments on a CUDA device: twin of cpu.rs, one thread per pixel.
//
// 1. `find_contrast`: which shared pixels are split?
// 2. `count_fragments`: how many fragments the pixels of each block have; then a scan of each list.
// 3. `emit_fragments`: the fragments and what they see, in the order of blocks, threads and samples; their pixels begin anew.
#include "cuda/prelude.cuh"

#include "cuda/tally.cuh"
#include "stages/pixel_samples/same_surface.cuh"

// The columns or rows around a place, and it.
struct Around {
    unsigned start, end;
};

DEVICE Around around(unsigned place, unsigned size) { return Around{place > 0 ? place - 1 : 0, min(size, place + 2)}; }

// Whether the difference between two colours can be seen.
DEVICE bool differs(Vec3 a, Vec3 b, float contrast) {
    const Vec3 bound = contrast * (max(a, b) + splat(CONTRAST_FLOOR));
    const Vec3 apart = abs(a - b);
    return apart.x > bound.x || apart.y > bound.y || apart.z > bound.z;
}

// What the first sample of a pixel sees.
COLD Facet first_facet(const PixelSamples &args, unsigned index, Hit hit) {
    return facet_of(args, sample_ray(args, index, 0), hit);
}

// Whether the radiance of a shared pixel differs from a neighbour's. The first sample lies on the pixel's surface.
DEVICE bool is_split(const PixelSamples &args, unsigned index) {
    if ((args.state[index] & PIXEL_SHARED) == 0)
        return false;
    const unsigned width = args.rays.view.size[0];
    const Around columns = around(index % width, width), rows = around(index / width, args.rays.count / width);
    const bool leaves = leaves_image(args.rays.view);
    bool has_own = false;
    Facet own = {};
    for (unsigned row = rows.start; row < rows.end; ++row)
        for (unsigned column = columns.start; column < columns.end; ++column) {
            const unsigned other = row * width + column;
            const int right = (int)column - (int)(index % width), down = (int)row - (int)(index / width);
            if (leaves && is_beyond(args.rays.view, args.rays.first_pixel + index, right, down))
                continue;
            if ((args.state[other] & PIXEL_SHARED) == 0 || !differs(args.color[index], args.color[other], args.contrast))
                continue;
            const Hit hit = sample_hit(args, index, 0), beside = sample_hit(args, other, 0);
            if (hit.triangle == Hit::NONE || beside.triangle == Hit::NONE)
                continue;
            if (!has_own)
                own = first_facet(args, index, hit);
            has_own = true;
            if (is_near(own, first_facet(args, other, beside)))
                return true;
        }
    return false;
}

KERNEL(find_contrast, PixelSamples, BLOCK, 4) {
    unsigned index;
    if (!ray_of_thread(args.rays, (unsigned)(args.first_block + blockIdx.x), threadIdx.x, index))
        return;
    // Neighbours read the other bit alone.
    if (is_split(args, index))
        args.state[index] |= PIXEL_SPLIT;
}

// The samples that one of them owns, from the owner on.
DEVICE unsigned part_of(const PixelSamples &args, unsigned index, unsigned owner) {
    unsigned part = 0;
    for (unsigned sample = owner; sample < args.samples[1]; ++sample)
        part |= (args.owners[(unsigned long long)sample * args.rays.count + index] == owner ? 1u : 0u) << sample;
    return part;
}

// The number of fragments in each list.
struct Counted {
    unsigned counts[3];
};

DEVICE void take(const PixelSamples &, unsigned, Counted &counted, unsigned list, unsigned, unsigned, float) { ++counted.counts[list]; }

// Where the next fragment of each list is written, and how many see a surface so far.
struct Written {
    unsigned places[3], found;
};

DEVICE void take(const PixelSamples &args, unsigned index, Written &written, unsigned list, unsigned sample, unsigned shared,
                 float weight) {
    const Ray ray = sample_ray(args, index, sample);
    const unsigned place = written.places[list]++;
    args.fragments[list][place] = ListedRay{
        ray.origin, args.rays.first_pixel + index, ray.direction, args.samples[0] + sample + 1, splat(weight), shared};
    const Hit hit = sample_hit(args, index, sample);
    store_hit(args.fragment_hits[list], place, hit);
    written.found += list < 2 && hit.triangle != Hit::NONE;
}

// Hands the samples of `part`, which lie on one surface, to `taker` as far as their mirror rays are followed.
template <class Taker>
DEVICE void add_mirrored(const PixelSamples &args, unsigned index, const Hit &hit, unsigned part, Taker &taker) {
    const unsigned size = __popc(part), followed = mirrored_samples(args, hit, size);
    unsigned left = part;
    for (unsigned sample = 0; sample < followed; ++sample, left &= left - 1)
        take(args, index, taker, 2, __ffs(left) - 1, 0, (float)size / (float)(followed * args.all_samples));
}

// Hands the shared fragments, the single samples and the mirror samples of a pixel to `taker`.
template <class Taker>
DEVICE void add_fragments(const PixelSamples &args, unsigned index, Taker &taker) {
    const unsigned state = args.state[index], count = args.samples[1];
    if (index < args.inner[0] || index >= args.inner[1])
        return;
    if (args.apart || (state & PIXEL_SPLIT)) {
        for (unsigned sample = 0; sample < count; ++sample)
            take(args, index, taker, 1, sample, 0, args.weight);
        return;
    }
    unsigned rest = count == WARP ? ALL_LANES : (1u << count) - 1;
    if (state == PIXEL_SHARED) {
        add_mirrored(args, index, sample_hit(args, index, 0), rest, taker);
        return;
    }
    while (rest != 0) {
        const unsigned first = __ffs(rest) - 1, part = part_of(args, index, first);
        rest &= ~part;
        // What sees nothing costs nothing.
        const Hit hit = sample_hit(args, index, first);
        if (is_transmissive(args.scene, hit)) {
            for (unsigned left = part; left != 0; left &= left - 1)
                take(args, index, taker, 1, __ffs(left) - 1, 0, args.weight);
            continue;
        }
        take(args, index, taker, 0, first, part, (float)__popc(part) / (float)args.all_samples);
        add_mirrored(args, index, hit, part, taker);
    }
}

// The sum of the values of the threads of the block before this one, and of all.
DEVICE unsigned sum_before(unsigned value, unsigned &all) {
    SHARED(unsigned, warps, [BLOCK / WARP]);
    const unsigned warp = threadIdx.x / WARP, sum = warp_running_sum(value);
    __syncthreads();
    if (lane_of_thread() == WARP - 1)
        warps[warp] = sum;
    __syncthreads();
    unsigned before = sum - value;
    all = 0;
    for (unsigned other = 0; other < BLOCK / WARP; ++other) {
        before += other < warp ? warps[other] : 0;
        all += warps[other];
    }
    return before;
}

// The number of fragments of the thread's pixel.
DEVICE Counted count_of(const PixelSamples &args, bool has, unsigned index) {
    Counted counted = {};
    if (has)
        add_fragments(args, index, counted);
    return counted;
}

KERNEL(count_fragments, PixelSamples, BLOCK, 4) {
    const unsigned long long block = args.first_block + blockIdx.x;
    unsigned index = 0;
    const bool has = ray_of_thread(args.rays, (unsigned)block, threadIdx.x, index);
    const Counted counted = count_of(args, has, index);
    for (unsigned list = 0; list < 3; ++list) {
        unsigned all;
        sum_before(counted.counts[list], all);
        if (threadIdx.x == 0)
            args.counts[list][block] = all;
    }
}

KERNEL(emit_fragments, PixelSamples, BLOCK, 4) {
    const unsigned long long block = args.first_block + blockIdx.x;
    unsigned index = 0;
    const bool has = ray_of_thread(args.rays, (unsigned)block, threadIdx.x, index);
    const Counted counted = count_of(args, has, index);
    Written written = {};
    for (unsigned list = 0; list < 3; ++list) {
        unsigned all;
        written.places[list] = args.counts[list][block] + sum_before(counted.counts[list], all);
    }
    if (has)
        add_fragments(args, index, written);
    count(tally_shard(args.tally).surface_points, written.found);
    if (!has || args.apart || args.state[index] == PIXEL_SHARED)
        return;
    // Begin anew.
    args.color[index] = splat(0.0f);
    if (args.caught != nullptr)
        args.caught[index] = 0.0f;
    if (args.light_points != nullptr)
        args.light_points[index] = 0;
    for (unsigned light = 0; light < args.light_count; ++light)
        args.visibility[light * args.film_pixels + index] = 0.0f;
    if (args.light_groups != nullptr)
        for (unsigned group = 0; group <= args.light_count; ++group)
            args.light_groups[group * args.film_pixels + index] = splat(0.0f);
}
