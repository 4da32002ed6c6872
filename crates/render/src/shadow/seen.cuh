// What kernels that test samples row by row share: the samples still seen, and the share that they make up.
#pragma once

#include "shadow/occlusion.cuh"

// The samples of a light that a lane still sees: rows of bits, or the centre alone.
template <unsigned WORDS>
struct Seen {
    unsigned bits[WORDS];
};

template <unsigned WORDS>
DEVICE bool any(const Seen<WORDS> &seen) {
    unsigned all = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        all |= seen.bits[word];
    return all != 0;
}

template <unsigned WORDS>
DEVICE unsigned number(const Seen<WORDS> &seen) {
    unsigned sum = 0;
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        sum += __popc(seen.bits[word]);
    return sum;
}

// Fills in the places of x = 0 in the rows of a lane's samples.
DEVICE void fill_row_offsets(const Sight &projected, const SampleRows &set, const RowTable &table) {
    ROLLED
    for (unsigned row = 0; row < set.rows; ++row)
        table.offsets[row * WARP] = row_offset(projected, set, row);
}

// The samples in front of a surface, before anything hides them; none unless the lane `has` a surface point.
template <unsigned WORDS>
DEVICE Seen<WORDS> seen_unhidden(bool has, const SurfacePoint &point, const Sight &projected, Shape shape, const SampleRows &set,
                                 const RowTable &table) {
    Seen<WORDS> seen = {};
    if (shape == SHAPE_POINT) {
        seen.bits[0] = has && center_above_horizon(point, projected);
        return seen;
    }
    fill_row_offsets(projected, set, table);
    samples_above_horizon<WORDS>(point, projected, set, table, seen.bits);
    UNROLL
    for (unsigned word = 0; word < WORDS; ++word)
        seen.bits[word] = has ? seen.bits[word] : 0;
    return seen;
}

// Adds what a lane sees of a light with this set of samples to its share.
DEVICE void add_seen(const Shadows &args, Shape shape, unsigned light, unsigned ray, unsigned seen) {
    float &share = args.share[(unsigned long long)light * args.rays.count + ray];
    if (shape == SHAPE_POINT) {
        share = (float)seen;
        return;
    }
    const unsigned all = seen + (args.set == 0 ? 0 : (unsigned)share), samples = args.sampling.samples;
    if (args.set + 1 < args.set_count)
        share = (float)all;
    else
        share = all == 0 ? 0.0f : all == samples ? 1.0f : (float)all / (float)samples;
}
