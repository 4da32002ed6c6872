// Gathered light on a CUDA device, the steps that trace nothing: see mod.rs. Launched by cuda/.
#include "cuda/prelude.cuh"

#include "gathered/bounce.cuh"
#include "gathered/far.cuh"
#include "gathered/fine.cuh"
#include "gathered/points.cuh"

// The number of a thread, or of a warp; false if there is nothing for it to do.
DEVICE bool thread_has_work(unsigned count, unsigned &number) {
    number = blockIdx.x * BLOCK + threadIdx.x;
    return number < count;
}

DEVICE bool warp_has_work(unsigned count, unsigned &number) {
    number = (blockIdx.x * BLOCK + threadIdx.x) / WARP;
    return number < count;
}

// ---- Tables ----

KERNEL(add_names_again, Names, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(*args.count, number))
        add_again(args, number);
}

KERNEL(take_sites, TakeSites, BLOCK, 4) {
    unsigned number;
    if (!thread_has_work(args.count, number))
        return;
    const unsigned owner = args.numbers[args.first + number];
    Site site = args.sites[owner];
    site.level += args.coarser;
    args.taken[number] = site;
    if (args.owners != nullptr)
        args.owners[number] = owner;
    if (args.places != nullptr)
        args.places[number] = LightPlace{site.position, site.level, site.normal, 1.0f, site.origin};
}

// ---- lookup.cuh ----

KERNEL(find_cells, Lookup, BLOCK, 4) {
    unsigned number;
    const bool is_place = thread_has_work(args.count, number);
    const LightPlace place = is_place ? args.places[number] : LightPlace{};
    ask_cells(args, place.share > 0.0f, place);
}

KERNEL(count_links, Lookup, BLOCK, 4) {
    unsigned number;
    const bool is_place = thread_has_work(args.count, number);
    const LightPlace place = is_place ? args.places[number] : LightPlace{};
    const unsigned count = find_links(args, place.share > 0.0f, place, 0, nullptr);
    if (is_place)
        args.offsets[number] = count;
}

KERNEL(fill_links, Lookup, BLOCK, 4) {
    unsigned number;
    const bool is_place = thread_has_work(args.count, number);
    const LightPlace place = is_place ? args.places[number] : LightPlace{};
    find_links(args, place.share > 0.0f, place, is_place ? args.offsets[number] : 0, args.links);
}

KERNEL(value_links, Lookup, BLOCK, 4) {
    unsigned place;
    if (thread_has_work(args.count, place))
        ask_values(args, place);
}

// ---- rays.cuh ----

KERNEL(cast_fans, Fans, BLOCK, 4) {
    unsigned site;
    if (warp_has_work(args.count, site))
        cast_fan(args, site);
}

KERNEL(guide_fans, GuideFans, BLOCK, 4) {
    unsigned site;
    if (warp_has_work(args.count, site))
        guide_site(args, site);
}

KERNEL(level_fans, Fans, BLOCK, 4) {
    unsigned site;
    if (thread_has_work(args.count, site))
        args.levels[site] = asked_level(args, site);
}

KERNEL(brighten_fans, Fans, BLOCK, 4) {
    unsigned site;
    if (thread_has_work(args.count, site))
        brighten(args, site);
}

// ---- bounce.cuh ----

KERNEL(name_nodes, Bounce, BLOCK, 4) {
    unsigned ray;
    if (fan_ray_of_thread(args.fans, ray) && asks_on(args.fans.seen[ray], args.finer))
        name_node(args, args.fans.seen[ray]);
}

KERNEL(list_nodes, Bounce, BLOCK, 4) {
    unsigned ray;
    if (fan_ray_of_thread(args.fans, ray) && asks_node(args.fans.seen[ray]) && !is_open(args.fans.seen[ray]))
        list_node(args, args.fans.seen[ray].node, args.order);
}

KERNEL(list_unlinked, Bounce, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(args.count, number))
        list_unlinked_node(args, number);
}

KERNEL(list_seen, Bounce, BLOCK, 4) {
    const unsigned long long number = (unsigned long long)blockIdx.x * BLOCK + threadIdx.x;
    if (number < (unsigned long long)args.count * BOUNCE_RAYS)
        list_seen_node(args, number);
}

KERNEL(link_nodes, Bounce, BLOCK, 4) {
    unsigned site;
    if (thread_has_work(args.fans.count, site))
        link_node(args, site);
}

KERNEL(sum_nodes, Bounce, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(args.count, number))
        sum_node(args, number);
}

KERNEL(reflect, Bounce, BLOCK, 4) {
    unsigned site;
    if (warp_has_work(args.fans.count, site))
        add_reflected(args, site);
}

// ---- far.cuh, fine.cuh ----

KERNEL(gather_far, GatherFar, BLOCK, 2) {
    unsigned site;
    if (warp_has_work(args.fans.count, site))
        far_of_site(args, site);
}

KERNEL(come_closer, ComeCloser, BLOCK, 4) {
    unsigned site;
    if (thread_has_work(args.fans.count, site))
        move_closer(args, site);
}

KERNEL(gather_fine, GatherFine, BLOCK, 2) {
    unsigned site;
    if (warp_has_work(args.fans.count, site))
        fine_of_site(args, site);
}

// What sites gather that see no coarse one.
KERNEL(take_light, GatherFine, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(args.count, number))
        args.fine[args.first + args.alone[args.first_alone + number]] = args.far[number].light;
}

// ---- points.cuh ----

KERNEL(ask_light, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        ask_at(args, index);
}

// Only where there are images of normals.
KERNEL(find_normals, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        find_normal(args, index);
}

KERNEL(mean_light, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        find_mean(args, index);
}

KERNEL(take_alone, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        site_of_alone(args, index);
}

KERNEL(give_alone, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        find_mean_alone(args, index);
}

KERNEL(add_means, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        sum_means(args, index);
}
