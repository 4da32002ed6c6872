// What coarse records gather: light from everywhere, by direction. Twin of coarse.rs.
#pragma once

#include "stages/irradiance_cache/light.cuh"
#include "stages/irradiance_cache/rays.cuh"

// Bins of a lane: those of its number, and of that number and 32.
struct LaneBins {
    Vec3 sums[BINS / WARP];
    float counts[BINS / WARP];
};

static_assert(BINS == 2 * WARP, "two bins of each lane");

DEVICE void take_bin(LaneBins &bins, unsigned bin, Vec3 radiance, float count) {
    UNROLL
    for (unsigned k = 0; k < BINS / WARP; ++k)
        if (bin == k * WARP + lane_of_thread()) {
            bins.sums[k] = bins.sums[k] + count * radiance;
            bins.counts[k] += count;
        }
}

// Writes a lane's bins, or adds them to what first rays found.
DEVICE void store_bins(const LaneBins &bins, Bins &all, bool joins) {
    UNROLL
    for (unsigned k = 0; k < BINS / WARP; ++k) {
        const unsigned bin = k * WARP + lane_of_thread();
        all.sums[bin] = joins ? FIRST_COUNT * all.sums[bin] + bins.sums[k] : bins.sums[k];
        all.counts[bin] = joins ? FIRST_COUNT * all.counts[bin] + bins.counts[k] : bins.counts[k];
    }
}

// Adds light that was found by `others` guided rays to what `count` rays found before.
DEVICE SurfaceLight joined(const SurfaceLight &before, const SurfaceLight &light, float count, float others) {
    const float share = others / (FIRST_COUNT * count + others);
    SurfaceLight both = {};
    add_light(both, 1.0f - share, before, splat(0.0f));
    add_light(both, share, light, splat(0.0f));
    return both;
}

// What a record gathers. One warp, all of whose lanes find the same, but for bins.
DEVICE void coarse_of_record(const GatherCoarse &args, unsigned number) {
    const HemisphereRays &hemispheres = args.hemispheres;
    const unsigned rays = rays_per_record(hemispheres);
    const Record record = hemispheres.records[number];
    const float near = NEAR_CELLS * size_of_level(record.level);
    SurfaceLight light = {};
    LaneBins all = {}, beyond = {};
    bool has_near = false;
    float mean = 0.0f, square = 0.0f;
    for (unsigned ray = number * rays; ray < (number + 1) * rays; ++ray) {
        const Vec3 direction = load_listed(hemispheres.list + ray, 1), radiance = hemispheres.seen[ray].radiance;
        const float weight = hemispheres.weights[ray], area = hemispheres.areas[ray];
        take_light(light, record.normal, direction, weight * radiance);
        const unsigned bin = direction_bin(direction);
        take_bin(all, bin, radiance, area);
        light.most = max(light.most, radiance);
        if (load_hit(hemispheres.hits, ray).t < near)
            has_near = true;
        else
            take_bin(beyond, bin, radiance, area);
        const float bright = luminance(radiance);
        mean += weight * bright;
        square += weight * bright * bright;
    }
    CoarseLight &coarse = args.coarse[args.first + (args.owners != nullptr ? args.owners[number] : number)];
    const bool joins = args.before != 0;
    store_bins(all, coarse.all, joins);
    store_bins(beyond, coarse.beyond, joins);
    if (lane_of_thread() != 0)
        return;
    coarse.light = joins ? joined(coarse.light, light, (float)args.before, (float)rays) : light;
    coarse.has_near = has_near || (joins && coarse.has_near);
    if (!joins && square > (1.0f + EVEN * EVEN) * mean * mean)
        args.uneven[atomicAdd(args.uneven_count, 1u)] = number;
}
