// Cooperative operations of the 32 threads of a warp.
#pragma once

#include "cuda/prelude.cuh"

// All lanes take part.
#define ALL_LANES 0xffffffffu

DEVICE unsigned lane_of_thread() {
    return threadIdx.x % WARP;
}

// The lanes below this one.
DEVICE unsigned lanes_below(unsigned lane) {
    return (1u << lane) - 1;
}

DEVICE unsigned warp_or(unsigned value) {
    for (int step = WARP / 2; step > 0; step /= 2)
        value |= __shfl_xor_sync(ALL_LANES, value, step);
    return value;
}

DEVICE unsigned warp_sum(unsigned value) {
    for (int step = WARP / 2; step > 0; step /= 2)
        value += __shfl_xor_sync(ALL_LANES, value, step);
    return value;
}

// The inclusive prefix sum: this lane's value and those of all lanes before.
DEVICE unsigned warp_running_sum(unsigned value) {
    const unsigned lane = lane_of_thread();
    for (unsigned step = 1; step < WARP; step *= 2) {
        const unsigned other = __shfl_up_sync(ALL_LANES, value, step);
        value += lane >= step ? other : 0;
    }
    return value;
}

// Appends the values of the lanes that have one to a list, in the order of the lanes.
DEVICE void warp_append(bool has, unsigned value, unsigned *list, unsigned &count) {
    const unsigned lanes = __ballot_sync(ALL_LANES, has);
    if (has)
        list[count + __popc(lanes & lanes_below(lane_of_thread()))] = value;
    count += __popc(lanes);
}

// The lane to whose share of a list a place belongs, where shares follow each other and `end` is where the lane's ends: the number
// of lanes whose shares end before or there. Nothing of meaning for a place behind the list.
DEVICE unsigned warp_owner(unsigned end, unsigned place) {
    unsigned owner = 0;
    for (unsigned step = WARP / 2; step > 0; step /= 2) {
        const unsigned other = __shfl_sync(ALL_LANES, end, owner + step - 1);
        owner += other <= place ? step : 0;
    }
    return owner;
}

// The value of one lane.
DEVICE Vec3 warp_broadcast(const Vec3 &value, unsigned lane) {
    return Vec3{__shfl_sync(ALL_LANES, value.x, lane), __shfl_sync(ALL_LANES, value.y, lane),
                __shfl_sync(ALL_LANES, value.z, lane)};
}

DEVICE float warp_min(float value) {
    for (int step = WARP / 2; step > 0; step /= 2)
        value = fminf(value, __shfl_xor_sync(ALL_LANES, value, step));
    return value;
}

DEVICE float warp_max(float value) {
    for (int step = WARP / 2; step > 0; step /= 2)
        value = fmaxf(value, __shfl_xor_sync(ALL_LANES, value, step));
    return value;
}

// The transpose of the 32 x 32 bit matrix whose rows the lanes hold: bit j of lane i goes to bit i of lane j (Warren: Hacker's
// Delight, 7-3).
DEVICE unsigned warp_transposed(unsigned row) {
    const unsigned lane = lane_of_thread();
    unsigned keep = 0xffff0000u;
    for (int step = WARP / 2; step > 0; step /= 2) {
        const unsigned other = __shfl_xor_sync(ALL_LANES, row, step);
        // `keep` selects the upper half of each pair of groups of `step` bits.
        row = (lane & step) ? (row & keep) | ((other & keep) >> step) : (row & ~keep) | ((other & ~keep) << step);
        keep ^= keep >> (step / 2);
    }
    return row;
}
