// What fine records receive: from afar what coarse records gather, and from nearby what their own rays hit. Twin of fine.rs.
#pragma once

#include "stages/irradiance_cache/light.cuh"
#include "stages/irradiance_cache/lookup.cuh"
#include "stages/irradiance_cache/rays.cuh"

// A record among near things asks smaller coarse cells: light changes fast from place to place there.
DEVICE void move_closer(const ComeCloser &args, unsigned number) {
    const HemisphereRays &hemispheres = args.hemispheres;
    const unsigned rays = rays_per_record(hemispheres), start = number * rays;
    int level = args.records[number].level;
    float most = CROWDED;
    for (unsigned step = 0; step < CLOSER; ++step) {
        const float reach = hemispheres.reach * size_of_level(level);
        float near = 0.0f;
        for (unsigned ray = start; ray < start + rays; ++ray) {
            const Hit hit = load_hit(hemispheres.hits, ray);
            if (hit.t < reach)
                near += hemispheres.weights[ray] / hit.t;
        }
        const float crowded = near * size_of_level(level);
        if (crowded <= most || crowded > HOPELESS)
            break;
        --level;
        most *= CROWDED_AGAIN;
    }
    const float reach = hemispheres.reach * size_of_level(level);
    for (unsigned ray = start; ray < start + rays; ++ray)
        if (load_hit(hemispheres.hits, ray).t >= reach)
            store_hit(hemispheres.hits, ray, Hit{INFINITE, 0.0f, 0.0f, Hit::NONE});
    args.records[number].level = level;
    args.places[number].level = level;
}

// What a coarse record gathers.
DEVICE const CoarseLight &coarse_of(const GatherFine &args, const Link &link) { return args.coarse[args.lookup.table.values[link.record] - 1]; }

// Adds the mean of the rays of a bin, if there are any: with their sum, records with many rays would count more here than in the light that is corrected.
DEVICE void add_bin(const Bins &bins, unsigned bin, float weight, Vec3 &sum, float &weights) {
    const float count = bins.counts[bin];
    if (count > 0.0f) {
        sum = sum + weight * (bins.sums[bin] / count);
        weights += weight;
    }
}

// What coarse records see in a direction: radiance all along, and what is beyond near things; `mean` without any.
DEVICE void seen_along(const GatherFine &args, unsigned place, unsigned bin, Vec3 mean, Vec3 &all, Vec3 &beyond) {
    Vec3 all_sum = splat(0.0f), beyond_sum = splat(0.0f);
    float all_weight = 0.0f, beyond_weight = 0.0f;
    for (unsigned index = args.lookup.offsets[place]; index < args.lookup.offsets[place + 1]; ++index) {
        const Link link = args.lookup.links[index];
        if (link.weight <= 0.0f)
            continue;
        const CoarseLight &coarse = coarse_of(args, link);
        add_bin(coarse.all, bin, link.weight, all_sum, all_weight);
        add_bin(coarse.beyond, bin, link.weight, beyond_sum, beyond_weight);
    }
    all = all_weight > 0.0f ? all_sum / all_weight : mean;
    beyond = beyond_weight > 0.0f ? beyond_sum / beyond_weight : all;
}

// The light of the coarse records around, by their weights. Returns the sum of these.
DEVICE float coarse_light(const GatherFine &args, unsigned place, Vec3 normal, SurfaceLight &light, bool &has_near) {
    const Lookup &lookup = args.lookup;
    float total = 0.0f;
    for (unsigned index = lookup.offsets[place]; index < lookup.offsets[place + 1]; ++index)
        total += larger(lookup.links[index].weight, 0.0f);
    for (unsigned index = lookup.offsets[place]; index < lookup.offsets[place + 1]; ++index) {
        const Link link = lookup.links[index];
        if (link.weight <= 0.0f)
            continue;
        const CoarseLight &coarse = coarse_of(args, link);
        add_light(light, link.weight / total, coarse.light, normal - lookup.table.records[link.record].normal);
        has_near = has_near || coarse.has_near;
    }
    return total;
}

// What a fine record receives. One warp, all of whose lanes find the same; of the rays, each takes its own.
DEVICE void fine_of_record(const GatherFine &args, unsigned number) {
    const HemisphereRays &hemispheres = args.hemispheres;
    const unsigned rays = rays_per_record(hemispheres), start = number * rays, lane = lane_of_thread();
    const Record record = hemispheres.records[number];
    SurfaceLight light = {};
    bool has_near = false;
    const float total = coarse_light(args, number, record.normal, light, has_near);
    for (unsigned ray = start; ray < start + rays; ++ray)
        has_near = has_near || load_hit(hemispheres.hits, ray).triangle != Hit::NONE;
    const Vec3 mean = light.mean;
    for (unsigned first = 0; total > 0.0f && has_near && first < rays; first += WARP) {
        Vec3 direction = {}, weighted = {}, seen = {};
        if (first + lane < rays) {
            const unsigned ray = start + first + lane;
            direction = load_listed(hemispheres.list + ray, 1);
            Vec3 all, beyond;
            seen_along(args, number, direction_bin(direction), mean, all, beyond);
            const bool hits = load_hit(hemispheres.hits, ray).triangle != Hit::NONE;
            seen = hits ? hemispheres.seen[ray].radiance : beyond;
            weighted = hemispheres.weights[ray] * (seen - all);
        }
        // In the order of the rays.
        for (unsigned ray = 0; ray < WARP && first + ray < rays; ++ray)
            take_light(light, record.normal, warp_broadcast(direction, ray), warp_broadcast(weighted, ray));
        light.most = max(light.most, Vec3{warp_max(seen.x), warp_max(seen.y), warp_max(seen.z)});
    }
    if (lane != 0)
        return;
    args.fine[args.first + number] = light;
    if (!(total > 0.0f))
        args.misses[atomicAdd(args.miss_count, 1u)] = number;
}
