// Light that was reflected several times: what reaches the points that gather rays hit. Twin of bounce.rs.
#pragma once

#include "stages/irradiance_cache/lookup.cuh"
#include "stages/irradiance_cache/rays.cuh"

#define BOUNCE_RAYS (BOUNCE_SIDE * BOUNCE_SIDE)

DEVICE bool asks_node(const SeenRay &seen) { return seen.kind != SURFACE_KINDS; }

// Whether a ray asks and has no answer yet.
DEVICE bool is_open(const SeenRay &seen) { return asks_node(seen) && seen.node == NO_NUMBER; }

// The name of the node that a ray asks: in a cell that is smaller by `finer` levels than the one that was asked at first.
DEVICE Name name_of_seen(const SeenRay &seen, int finer) {
    const int level = seen.level - finer;
    return name_of_node(level, cell_at(level, seen.position), seen.kind, (unsigned)finer);
}

DEVICE bool is_somewhere(const Record &record) { return !(record.normal == splat(0.0f)); }

// Whether a node may answer what is asked in a cell that is smaller by so many levels than the one that was asked at first.
DEVICE bool may_answer(const Node &node, const Record &record, int finer) {
    return is_somewhere(record) && (!node.covered || finer == BOUNCE_FINER);
}

// Whether a ray asks a node in a cell that is smaller by so many levels.
DEVICE bool asks_on(const SeenRay &seen, int finer) { return is_open(seen) && seen.from <= finer; }

// Asks for the node that a ray sees.
DEVICE void name_node(const Bounce &args, const SeenRay &seen) { add_name(args.names, name_of_seen(seen, args.finer)); }

// Whether a ray asks on where something is in the way. Where others see little, what is lit matters: most of what is reflected comes from there.
DEVICE bool insists(const Bounce &args, unsigned ray) {
    return args.insist || luminance(args.hemispheres.seen[ray].radiance) > args.hemispheres.brightness[ray / rays_per_record(args.hemispheres)];
}

// Finds the node that a ray sees, or none if something is in the way, or no surface was found. Only rays that insist ask on there.
template <class Structure>
DEVICE void hide_nodes(const Bounce &args, const Structure &structure) {
    unsigned ray;
    if (!ray_of_thread(args.hemispheres, ray) || !asks_on(args.hemispheres.seen[ray], args.finer))
        return;
    SeenRay &seen = args.hemispheres.seen[ray];
    const unsigned node = number_of(args.names, name_of_seen(seen, args.finer).key);
    const Record &record = args.records[node];
    const Open open = {seen.position, -ray_at(args.hemispheres.rays, ray).direction, load_hit(args.hemispheres.hits, ray).t};
    const bool covered = args.nodes[node].covered;
    if (may_answer(args.nodes[node], record, args.finer) &&
        !occluded(structure, args.hemispheres.tally, record_segment(seen.position, seen.normal, open, record, covered)))
        seen.node = node;
    else if (!insists(args, ray) && !(is_somewhere(record) && covered))
        seen.from = BOUNCE_FINER + 1;
}

// Lists a node, once, if less is known of it, or asked for, than is asked now.
DEVICE void list_node(const Bounce &args, unsigned node, unsigned order) {
    if (args.nodes[node].wanted < order && atomicMax(&args.nodes[node].wanted, order) < order)
        args.listed[atomicAdd(args.listed_count, 1u)] = node;
}

// Numbers the links of a listed node that has none.
DEVICE void list_unlinked_node(const Bounce &args, unsigned number) {
    const unsigned node = args.listed[args.first + number];
    if (args.nodes[node].links != 0)
        return;
    const unsigned place = atomicAdd(args.unlinked_count, 1u);
    args.unlinked[place] = node;
    args.nodes[node].links = args.linked + place + 1;
}

DEVICE const NodeLink *links_of(const Bounce &args, const Node &node) { return args.links + (unsigned long long)(node.links - 1) * BOUNCE_RAYS; }

// Lists what a link of a listed node leads to, if less is known of it than one reflection less.
DEVICE void list_seen_node(const Bounce &args, unsigned long long number) {
    const Node &node = args.nodes[args.listed[args.first + (unsigned)(number / BOUNCE_RAYS)]];
    const unsigned seen = links_of(args, node)[number % BOUNCE_RAYS].node;
    if (seen != NO_NUMBER)
        list_node(args, seen, args.order - 1);
}

// Keeps what the rays of a node see. What arrives with the last reflection alone is known then.
DEVICE void link_node(const Bounce &args, unsigned record) {
    const HemisphereRays &hemispheres = args.hemispheres;
    Node &node = args.nodes[args.unlinked[args.first + record]];
    NodeLink *links = args.links + (unsigned long long)(args.linked + record) * BOUNCE_RAYS;
    Vec3 first = splat(0.0f), hidden = splat(0.0f);
    for (unsigned index = 0; index < BOUNCE_RAYS; ++index) {
        const unsigned ray = record * BOUNCE_RAYS + index;
        const SeenRay &seen = hemispheres.seen[ray];
        first = first + hemispheres.weights[ray] * seen.radiance;
        const Vec3 weight = hemispheres.weights[ray] * seen.kd;
        if (is_open(seen))
            hidden = hidden + weight;
        links[index] = NodeLink{asks_node(seen) ? seen.node : NO_NUMBER, weight};
    }
    node.values[0] = first;
    node.hidden = hidden;
    node.known = max(node.known, 1u);
}

// What arrives at a listed node after one reflection more than `order`. The mean of what its rays see stands for what is hidden.
DEVICE void sum_node(const Bounce &args, unsigned number) {
    Node &node = args.nodes[args.listed[number]];
    if (node.known != args.order)
        return;
    const NodeLink *links = links_of(args, node);
    Vec3 lit = splat(0.0f), all = splat(0.0f);
    float count = 0.0f;
    for (unsigned index = 0; index < BOUNCE_RAYS; ++index) {
        const NodeLink link = links[index];
        if (link.node == NO_NUMBER)
            continue;
        const Vec3 value = args.nodes[link.node].values[args.order - 1];
        lit = lit + link.weight * value;
        all = all + value;
        count += 1.0f;
    }
    node.values[args.order] = node.values[0] + lit + node.hidden * (count > 0.0f ? all / count : splat(0.0f));
    node.known = args.order + 1;
}

// Adds to what the rays of a record see what is reflected of light that lights do not give. One warp.
DEVICE void add_reflected(const Bounce &args, unsigned record) {
    const HemisphereRays &hemispheres = args.hemispheres;
    const unsigned rays = rays_per_record(hemispheres), start = record * rays, lane = lane_of_thread();
    Vec3 all = splat(0.0f);
    float count = 0.0f;
    for (unsigned first = 0; first < rays; first += WARP) {
        Vec3 value = {};
        bool sees = false;
        if (first + lane < rays) {
            const SeenRay &seen = hemispheres.seen[start + first + lane];
            sees = asks_node(seen) && seen.node != NO_NUMBER;
            value = sees ? args.nodes[seen.node].values[ORDERS - 1] : value;
        }
        const unsigned lanes = __ballot_sync(ALL_LANES, sees);
        count += (float)__popc(lanes);
        // In the order of the rays.
        for (unsigned rest = lanes; rest != 0; rest &= rest - 1)
            all = all + warp_broadcast(value, __ffs(rest) - 1);
    }
    const Vec3 mean = count > 0.0f ? all / count : splat(0.0f);
    for (unsigned ray = start + lane; ray < start + rays; ray += WARP) {
        SeenRay &seen = hemispheres.seen[ray];
        if (asks_node(seen))
            seen.radiance = seen.radiance + seen.kd * (seen.node == NO_NUMBER ? mean : args.nodes[seen.node].values[ORDERS - 1]);
    }
}
