// What fine sites receive: from afar what coarse sites gather, and from nearby what their own rays hit. Twin of fine.rs.
#pragma once

#include "gathered/light.cuh"
#include "gathered/lookup.cuh"
#include "gathered/rays.cuh"

// A site among near things asks smaller coarse cells: light changes fast from place to place there.
DEVICE void move_closer(const ComeCloser &args, unsigned number) {
    const Fans &fans = args.fans;
    const unsigned rays = rays_of_fan(fans), start = number * rays;
    int level = args.sites[number].level;
    float most = CROWDED;
    for (unsigned step = 0; step < CLOSER; ++step) {
        const float reach = fans.reach * size_of_level(level);
        float near = 0.0f;
        for (unsigned ray = start; ray < start + rays; ++ray) {
            const Hit hit = load_hit(fans.hits, ray);
            if (hit.t < reach)
                near += fans.weights[ray] / hit.t;
        }
        const float crowded = near * size_of_level(level);
        if (crowded <= most || crowded > HOPELESS)
            break;
        --level;
        most *= CROWDED_AGAIN;
    }
    const float reach = fans.reach * size_of_level(level);
    for (unsigned ray = start; ray < start + rays; ++ray)
        if (load_hit(fans.hits, ray).t >= reach)
            store_hit(fans.hits, ray, Hit{INFINITE, 0.0f, 0.0f, Hit::NONE});
    args.sites[number].level = level;
    args.places[number].level = level;
}

// What a coarse site gathers.
DEVICE const FarLight &far_of(const GatherFine &args, const Link &link) { return args.far[args.lookup.table.values[link.site] - 1]; }

// Adds the mean of the rays of a bin, if there are any: with their sum, sites with many rays would count more here than in the light that is corrected.
DEVICE void add_bin(const Bins &bins, unsigned bin, float weight, Vec3 &sum, float &weights) {
    const float count = bins.counts[bin];
    if (count > 0.0f) {
        sum = sum + weight * (bins.sums[bin] / count);
        weights += weight;
    }
}

// What coarse sites see in a direction: radiance all along, and what is beyond near things; `mean` without any.
DEVICE void seen_along(const GatherFine &args, unsigned place, unsigned bin, Vec3 mean, Vec3 &all, Vec3 &beyond) {
    Vec3 all_sum = splat(0.0f), beyond_sum = splat(0.0f);
    float all_weight = 0.0f, beyond_weight = 0.0f;
    for (unsigned index = args.lookup.offsets[place]; index < args.lookup.offsets[place + 1]; ++index) {
        const Link link = args.lookup.links[index];
        if (link.weight <= 0.0f)
            continue;
        const FarLight &far = far_of(args, link);
        add_bin(far.all, bin, link.weight, all_sum, all_weight);
        add_bin(far.beyond, bin, link.weight, beyond_sum, beyond_weight);
    }
    all = all_weight > 0.0f ? all_sum / all_weight : mean;
    beyond = beyond_weight > 0.0f ? beyond_sum / beyond_weight : all;
}

// The light of the coarse sites around, by their weights. Returns the sum of these.
DEVICE float far_light(const GatherFine &args, unsigned place, Vec3 normal, SurfaceLight &light, bool &has_near) {
    const Lookup &lookup = args.lookup;
    float total = 0.0f;
    for (unsigned index = lookup.offsets[place]; index < lookup.offsets[place + 1]; ++index)
        total += larger(lookup.links[index].weight, 0.0f);
    for (unsigned index = lookup.offsets[place]; index < lookup.offsets[place + 1]; ++index) {
        const Link link = lookup.links[index];
        if (link.weight <= 0.0f)
            continue;
        const FarLight &far = far_of(args, link);
        add_light(light, link.weight / total, far.light, normal - lookup.table.sites[link.site].normal);
        has_near = has_near || far.has_near;
    }
    return total;
}

// What a fine site receives. One warp, all of whose lanes find the same; of the rays, each takes its own.
DEVICE void fine_of_site(const GatherFine &args, unsigned number) {
    const Fans &fans = args.fans;
    const unsigned rays = rays_of_fan(fans), start = number * rays, lane = lane_of_thread();
    const Site site = fans.sites[number];
    SurfaceLight light = {};
    bool has_near = false;
    const float total = far_light(args, number, site.normal, light, has_near);
    for (unsigned ray = start; ray < start + rays; ++ray)
        has_near = has_near || load_hit(fans.hits, ray).triangle != Hit::NONE;
    const Vec3 mean = light.mean;
    for (unsigned first = 0; total > 0.0f && has_near && first < rays; first += WARP) {
        Vec3 direction = {}, weighted = {}, seen = {};
        if (first + lane < rays) {
            const unsigned ray = start + first + lane;
            direction = load_listed(fans.list + ray, 1);
            Vec3 all, beyond;
            seen_along(args, number, direction_bin(direction), mean, all, beyond);
            const bool hits = load_hit(fans.hits, ray).triangle != Hit::NONE;
            seen = hits ? fans.seen[ray].radiance : beyond;
            weighted = fans.weights[ray] * (seen - all);
        }
        // In the order of the rays.
        for (unsigned ray = 0; ray < WARP && first + ray < rays; ++ray)
            take_light(light, site.normal, warp_broadcast(direction, ray), warp_broadcast(weighted, ray));
        light.most = max(light.most, Vec3{warp_max(seen.x), warp_max(seen.y), warp_max(seen.z)});
    }
    if (lane != 0)
        return;
    args.fine[args.first + number] = light;
    if (!(total > 0.0f))
        args.alone[atomicAdd(args.alone_count, 1u)] = number;
}
