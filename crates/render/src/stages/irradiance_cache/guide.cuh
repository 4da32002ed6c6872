// Where the second rays of a coarse record go: twin of guide.rs.
#pragma once

#include "cuda/warp.cuh"
#include "sampling.cuh"
#include "shading/shading.cuh"

// The first rays along one axis that tell of a block, from the first one to before the end: its own and those next to it.
struct RaysAround {
    unsigned first, end;
};

DEVICE RaysAround rays_around(unsigned block, unsigned side) {
    const unsigned first = GUIDE_BLOCK * block;
    return RaysAround{first - min(first, GUIDE_RING), min(first + GUIDE_BLOCK + GUIDE_RING, side)};
}

// The standard deviation of what the first rays of a record saw in a block and next to it: luminance times weight.
DEVICE float deviation(const HemisphereRays &hemispheres, unsigned record, unsigned column, unsigned row) {
    const unsigned side = hemispheres.side, start = record * side * side;
    const RaysAround columns = rays_around(column, side), rows = rays_around(row, side);
    float sum = 0.0f, square = 0.0f, count = 0.0f;
    for (unsigned y = rows.first; y < rows.end; ++y)
        for (unsigned x = columns.first; x < columns.end; ++x) {
            const unsigned ray = start + y * side + x;
            const float value = hemispheres.weights[ray] * luminance(hemispheres.seen[ray].radiance);
            sum += value;
            square += value * value;
            count += 1.0f;
        }
    const float mean = sum / count;
    return sqrtf(larger(square / count - mean * mean, 0.0f));
}

// How many rays go into each block of a record, whose first rays have seen something. One warp.
DEVICE void guide_record(const GuideRays &args, unsigned number) {
    const unsigned record = args.uneven[args.first + number], lane = lane_of_thread();
    const unsigned blocks = args.hemispheres.side / GUIDE_BLOCK, count = blocks * blocks;
    // In the order of the blocks.
    float total = 0.0f;
    for (unsigned first = 0; first < count; first += WARP) {
        const unsigned block = first + lane;
        const float own = block < count ? deviation(args.hemispheres, record, block % blocks, block / blocks) : 0.0f;
        for (unsigned next = 0; next < WARP && first + next < count; ++next)
            total += __shfl_sync(ALL_LANES, own, next);
    }
    const float guided = total > 0.0f ? GUIDED / total : 0.0f, even = total > 0.0f ? 1.0f - GUIDED : 1.0f;
    float share = 0.0f;
    for (unsigned first = 0; first < count; first += WARP) {
        const unsigned block = first + lane;
        const float own = block < count ? deviation(args.hemispheres, record, block % blocks, block / blocks) : 0.0f;
        unsigned end = 0;
        for (unsigned next = 0; next < WARP && first + next < count; ++next) {
            share += even / (float)count + guided * __shfl_sync(ALL_LANES, own, next);
            if (next == lane)
                end = block + 1 < count ? (unsigned)(share * (float)args.rays) : args.rays;
        }
        if (block < count)
            args.ends[number * count + block] = end;
    }
}

// Where ray number `index` of a record lies in the square [-1, 1]^2, and the area that it stands for, relative to that of a ray of an even hemisphere.
DEVICE void guided_place(const HemisphereRays &hemispheres, unsigned record, unsigned long long seed, unsigned index, float &x, float &y, float &area) {
    const unsigned blocks = hemispheres.blocks, rays = hemispheres.side * hemispheres.side;
    const unsigned *ends = hemispheres.ends + record * blocks * blocks;
    unsigned block = 0, beyond = blocks * blocks;
    while (block < beyond) {
        const unsigned middle = (block + beyond) / 2;
        if (ends[middle] <= index)
            block = middle + 1;
        else
            beyond = middle;
    }
    const unsigned first = block > 0 ? ends[block - 1] : 0, count = ends[block] - first, number = index - first;
    const unsigned scramble = (unsigned)random_bits(seed, block, hemispheres.side);
    const unsigned within = (unsigned)random_bits(seed, (unsigned long long)(number + 1) << 32 | block, hemispheres.side);
    const float across = ((float)number + (float)(within >> 8) * LAST_DIGIT) / (float)count;
    const float along = (float)((__brev(number) ^ scramble) >> 8) * LAST_DIGIT;
    const float side = (float)blocks;
    x = 2.0f * ((float)(block % blocks) + across) / side - 1.0f;
    y = 2.0f * ((float)(block / blocks) + along) / side - 1.0f;
    area = (float)rays / ((float)count * side * side);
}
