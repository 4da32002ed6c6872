// Light that was reflected several times: what reaches the points that gather rays hit. Twin of bounce.rs.
#pragma once

#include "gathered/lookup.cuh"
#include "gathered/rays.cuh"

DEVICE bool asks_node(const SeenRay &seen) { return seen.kind != SURFACE_KINDS; }

DEVICE LightPlace place_of_seen(const SeenRay &seen) { return LightPlace{seen.position, seen.level, seen.normal, 1.0f}; }

// Asks for the site that a ray sees.
DEVICE void name_node(const Bounce &args, const SeenRay &seen) {
    add_name(args.names, name_of_kind(seen.level, cell_at(seen.level, seen.position), seen.kind));
}

// The number of the site that a ray sees.
DEVICE unsigned node_of(const Bounce &args, const SeenRay &seen) {
    return number_of(args.names, name_of_kind(seen.level, cell_at(seen.level, seen.position), seen.kind).key);
}

// Lists a site, once, if less is known of it than is asked.
DEVICE void list_node(const Bounce &args, unsigned node) {
    if (args.nodes[node].known < args.order && atomicExch(args.stamps + node, args.stamp) != args.stamp)
        args.listed[atomicAdd(args.listed_count, 1u)] = node;
}

// Finds the site that a ray sees, or none if something is in the way.
template <class Structure>
DEVICE void hide_nodes(const Bounce &args, const Structure &structure) {
    unsigned ray;
    if (!fan_ray_of_thread(args.fans, ray) || !asks_node(args.fans.seen[ray]))
        return;
    SeenRay &seen = args.fans.seen[ray];
    const unsigned node = node_of(args, seen);
    const Site &site = args.sites[node];
    const LightPlace place = place_of_seen(seen);
    const bool hides = may_be_hidden(place, site.position, args.nodes[node].nearest) &&
                       occluded(structure, args.fans.tally, site_segment(place, site));
    seen.node = hides ? NO_NUMBER : node;
}

// What arrives at a site after one reflection: what its rays see.
DEVICE void find_first(const Bounce &args, unsigned site) {
    const Fans &fans = args.fans;
    Node &node = args.nodes[fans.owners[site]];
    if (node.known != 0)
        return;
    Vec3 sum = splat(0.0f);
    for (unsigned ray = site * rays_of_fan(fans); ray < (site + 1) * rays_of_fan(fans); ++ray)
        sum = sum + fans.weights[ray] * fans.seen[ray].radiance;
    node.first = sum;
    node.nearest = nearest_of_fan(fans, site);
    node.known = 1;
}

// What arrives at a site after up to two reflections: also what arrives at those that its rays see. Their mean stands for those that are hidden.
DEVICE void find_second(const Bounce &args, unsigned site) {
    const Fans &fans = args.fans;
    Vec3 lit = splat(0.0f), hidden = splat(0.0f), all = splat(0.0f);
    float count = 0.0f;
    for (unsigned ray = site * rays_of_fan(fans); ray < (site + 1) * rays_of_fan(fans); ++ray) {
        const SeenRay &seen = fans.seen[ray];
        if (!asks_node(seen))
            continue;
        const Vec3 weight = fans.weights[ray] * seen.kd;
        if (seen.node == NO_NUMBER) {
            hidden = hidden + weight;
            continue;
        }
        const Vec3 value = args.nodes[seen.node].first;
        lit = lit + weight * value;
        all = all + value;
        count += 1.0f;
    }
    Node &node = args.nodes[fans.owners[site]];
    node.second = node.first + lit + hidden * (count > 0.0f ? all / count : splat(0.0f));
    node.known = 2;
}

// Adds to what the rays of a site see what is reflected of light that lights do not give. One warp.
DEVICE void add_reflected(const Bounce &args, unsigned site) {
    const Fans &fans = args.fans;
    const unsigned rays = rays_of_fan(fans), start = site * rays, lane = lane_of_thread();
    Vec3 all = splat(0.0f);
    float count = 0.0f;
    for (unsigned first = 0; first < rays; first += WARP) {
        Vec3 value = {};
        bool sees = false;
        if (first + lane < rays) {
            const SeenRay &seen = fans.seen[start + first + lane];
            sees = asks_node(seen) && seen.node != NO_NUMBER;
            value = sees ? args.nodes[seen.node].second : value;
        }
        const unsigned lanes = __ballot_sync(ALL_LANES, sees);
        count += (float)__popc(lanes);
        // In the order of the rays.
        for (unsigned rest = lanes; rest != 0; rest &= rest - 1)
            all = all + warp_broadcast(value, __ffs(rest) - 1);
    }
    const Vec3 mean = count > 0.0f ? all / count : splat(0.0f);
    for (unsigned ray = start + lane; ray < start + rays; ray += WARP) {
        SeenRay &seen = fans.seen[ray];
        if (asks_node(seen))
            seen.radiance = seen.radiance + seen.kd * (seen.node == NO_NUMBER ? mean : args.nodes[seen.node].second);
    }
}
