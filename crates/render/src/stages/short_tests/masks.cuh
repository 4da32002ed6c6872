// What short tests leave behind.
#pragma once

#include "cuda/tally.cuh"
#include "light_mesh/window.cuh"

// 4. Writes what the object points of an item use: their masks, and the used points of each brick around their cell, so that the next
// step need not look at every light point again. Returns how many bits the lane wrote.
//
// `marks` is room for two words a brick: shared memory has no 64-bit "or" of its own.
DEVICE unsigned write_masks(const ShortTests &args, unsigned long long index, const IVec3 &cell, const unsigned *seen,
                            unsigned *marks) {
    const LightMesh &mesh = args.mesh;
    const unsigned lane = lane_of_thread(), points = 32 * mesh.words;
    const Window window = window_around(mesh, cell);
    const unsigned bricks = window_size(window);
    for (unsigned word = lane; word < 2 * bricks; word += 32)
        marks[word] = 0;
    __syncwarp();
    unsigned used = 0;
    for (unsigned k = lane; k < points; k += 32) {
        const unsigned lanes = seen[k];
        args.masks[index * points + k] = lanes;
        if (lanes == 0)
            continue;
        used += __popc(lanes);
        const IVec3 point = cell + template_offset(mesh, k);
        const unsigned bit = point_bit(point);
        atomicOr(&marks[2 * window_place(window, point) + bit / 32], 1u << bit % 32);
    }
    __syncwarp();
    for (unsigned place = lane; place < bricks; place += 32)
        args.marks[index * bricks + place] = (unsigned long long)marks[2 * place + 1] << 32 | marks[2 * place];
    return used;
}

// Adds what a warp counted. `used` may be of any part of the warp's masks, the others are of the lane.
DEVICE void count_short_tests(const Tally &tally, unsigned half_ball, unsigned used, unsigned tested) {
    Counters &shard = tally_shard(tally);
    count(shard.half_ball, half_ball);
    count(shard.used, used);
    count(shard.short_tests, tested);
}
