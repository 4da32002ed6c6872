// Gathered light on a CUDA device, the steps that trace nothing: see mod.rs. Launched by cuda.rs.
#include "cuda/prelude.cuh"

#include "stages/irradiance_cache/bounce.cuh"
#include "stages/irradiance_cache/coarse.cuh"
#include "stages/irradiance_cache/fine.cuh"
#include "stages/irradiance_cache/points.cuh"

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

KERNEL(take_records, TakeRecords, BLOCK, 4) {
    unsigned number;
    if (!thread_has_work(args.count, number))
        return;
    const unsigned owner = args.numbers[args.first + number];
    Record record = args.records[owner];
    record.level += args.coarser;
    args.taken[number] = record;
    if (args.owners != nullptr)
        args.owners[number] = owner;
    if (args.places != nullptr)
        args.places[number] = LightPlace{record.position, record.level, record.normal, 1.0f, record.origin};
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

KERNEL(cast_hemispheres, HemisphereRays, BLOCK, 4) {
    unsigned record;
    if (warp_has_work(args.count, record))
        cast_hemisphere(args, record);
}

KERNEL(guide_hemispheres, GuideRays, BLOCK, 4) {
    unsigned record;
    if (warp_has_work(args.count, record))
        guide_record(args, record);
}

KERNEL(level_hemispheres, HemisphereRays, BLOCK, 4) {
    unsigned record;
    if (thread_has_work(args.count, record))
        args.levels[record] = asked_level(args, record);
}

KERNEL(brighten_hemispheres, HemisphereRays, BLOCK, 4) {
    unsigned record;
    if (thread_has_work(args.count, record))
        brighten(args, record);
}

// ---- bounce.cuh ----

KERNEL(name_nodes, Bounce, BLOCK, 4) {
    unsigned ray;
    if (ray_of_thread(args.hemispheres, ray) && asks_on(args.hemispheres.seen[ray], args.finer))
        name_node(args, args.hemispheres.seen[ray]);
}

KERNEL(list_nodes, Bounce, BLOCK, 4) {
    unsigned ray;
    if (ray_of_thread(args.hemispheres, ray) && asks_node(args.hemispheres.seen[ray]) && !is_open(args.hemispheres.seen[ray]))
        list_node(args, args.hemispheres.seen[ray].node, args.order);
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
    unsigned record;
    if (thread_has_work(args.hemispheres.count, record))
        link_node(args, record);
}

KERNEL(sum_nodes, Bounce, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(args.count, number))
        sum_node(args, number);
}

KERNEL(reflect, Bounce, BLOCK, 4) {
    unsigned record;
    if (warp_has_work(args.hemispheres.count, record))
        add_reflected(args, record);
}

// ---- coarse.cuh, fine.cuh ----

KERNEL(gather_coarse, GatherCoarse, BLOCK, 2) {
    unsigned record;
    if (warp_has_work(args.hemispheres.count, record))
        coarse_of_record(args, record);
}

KERNEL(come_closer, ComeCloser, BLOCK, 4) {
    unsigned record;
    if (thread_has_work(args.hemispheres.count, record))
        move_closer(args, record);
}

KERNEL(gather_fine, GatherFine, BLOCK, 2) {
    unsigned record;
    if (warp_has_work(args.hemispheres.count, record))
        fine_of_record(args, record);
}

// What records gather that see no coarse one.
KERNEL(take_light, GatherFine, BLOCK, 4) {
    unsigned number;
    if (thread_has_work(args.count, number))
        args.fine[args.first + args.misses[args.first_miss + number]] = args.coarse[number].light;
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

KERNEL(take_misses, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        record_of_miss(args, index);
}

KERNEL(answer_misses, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        find_mean_of_miss(args, index);
}

KERNEL(add_means, GatherPoints, BLOCK, 4) {
    unsigned index;
    if (thread_has_work(args.count, index))
        sum_means(args, index);
}
