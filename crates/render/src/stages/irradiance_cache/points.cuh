// What surface points receive: the mean of what fine records around them do. Twin of cpu.rs.
#pragma once

#include "stages/irradiance_cache/light.cuh"
#include "stages/irradiance_cache/lookup.cuh"
#include "shading/normal_map.cuh"

// Asks for light at a ray's surface point: at one level, or between two.
DEVICE void ask_at(const GatherPoints &args, unsigned index) {
    LightPlace places[2] = {};
    const unsigned ray = args.first + index;
    if (load_hit(args.hits, ray).triangle != Hit::NONE) {
        const SurfacePoint point = surface_point_of(args.scene, args.rays, args.hits, ray);
        float rest;
        const int level = level_of_width(args.pixels * (args.spacing[0] + args.spacing[1] * length(point.position - args.eye)), rest);
        const float next = larger((rest - BLEND_FROM) / (2.0f - BLEND_FROM), 0.0f);
        places[0] = LightPlace{point.position, max(level, args.least_level), point.normal, 1.0f - next, point.origin};
        places[1] = LightPlace{point.position, max(level + 1, args.least_level), point.normal, next, point.origin};
    }
    args.places[2 * index] = places[0];
    args.places[2 * index + 1] = places[1];
}

// Finds the normal that shading uses at a ray's surface point, by an image if there is one; the mean over the samples of the pixel that are shaded
// with it.
DEVICE void find_normal(const GatherPoints &args, unsigned index) {
    const unsigned ray = args.first + index;
    const Hit hit = load_hit(args.hits, ray);
    if (hit.triangle == Hit::NONE)
        return;
    const Vec3 smooth = shading_normal(args.scene, hit, surface_point_of(args.scene, args.rays, args.hits, ray).normal);
    args.normals[index] = smooth;
    const Material *material = args.scene.materials + material_index(args.scene, hit.triangle);
    if (material->normal_texture == Material::NO_TEXTURE)
        return;
    const TintSources sources = tint_sources(args.scene);
    const Sighting from = sighting_of(args.rays, ray);
    const Vec3 own = mapped_normal(sources, material, from, hit, smooth);
    const SharedHits shared = shared_hits(args.rays, ray, Samples{args.samples, args.first_sampled, args.sampled_pixels, args.sample_count});
    args.normals[index] = shared.shared != 0 ? mean_normal(sources, material, from, shared, own) : own;
}

// The normal that shading uses.
DEVICE Vec3 normal_at(const GatherPoints &args, unsigned place, Vec3 facing) {
    if (args.normals != nullptr)
        return args.normals[place / 2];
    return shading_normal(args.scene, load_hit(args.hits, args.first + place / 2), facing);
}

// The mean at a place; those without records are listed.
DEVICE void find_mean(const GatherPoints &args, unsigned index) {
    const LightPlace place = args.places[index];
    args.means[index] = splat(0.0f);
    if (place.share <= 0.0f)
        return;
    const Vec3 normal = normal_at(args, index, place.normal);
    Vec3 sum = splat(0.0f);
    float weights = 0.0f;
    const unsigned first = args.brute_force ? 0 : args.lookup.offsets[index], end = args.brute_force ? 0 : args.lookup.offsets[index + 1];
    for (unsigned link = first; link < end; ++link) {
        const unsigned record = args.lookup.links[link].record;
        const float weight = args.lookup.links[link].weight;
        if (weight <= 0.0f)
            continue;
        const SurfaceLight &light = args.fine[args.lookup.table.values[record] - 1];
        sum = sum + weight * light_at(light, normal - args.lookup.table.records[record].normal);
        weights += weight;
    }
    if (weights > 0.0f)
        args.means[index] = sum / weights;
    else
        args.misses[atomicAdd(args.miss_count, 1u)] = index;
}

// A surface point that sees no record as a record of its own. All have the same pattern, or each its own.
DEVICE void record_of_miss(const GatherPoints &args, unsigned index) {
    const unsigned place = args.misses[args.first_miss + index];
    const SurfacePoint point = surface_point_of(args.scene, args.rays, args.hits, args.first + place / 2);
    const unsigned long long x = __float_as_uint(point.position.x), y = __float_as_uint(point.position.y), z = __float_as_uint(point.position.z);
    const unsigned long long seed = args.brute_force ? 0 : x ^ y << 21 ^ z << 42;
    const int level = args.places[place].level + COARSER;
    args.records[index] = Record{point.position, level, point.origin, point.normal, seed};
    args.asked[index] = LightPlace{point.position, level, point.normal, 1.0f, point.origin};
}

// What it receives.
DEVICE void find_mean_of_miss(const GatherPoints &args, unsigned index) {
    const unsigned place = args.misses[args.first_miss + index];
    const Vec3 normal = args.places[place].normal;
    const SurfaceLight &light = args.brute_force ? args.coarse[index].light : args.own[index];
    args.means[place] = light_at(light, normal_at(args, place, normal) - normal);
}

// Both answers for a ray.
DEVICE void sum_means(const GatherPoints &args, unsigned index) {
    Vec3 sum = splat(0.0f);
    for (unsigned place = 2 * index; place < 2 * index + 2; ++place)
        if (args.places[place].share > 0.0f)
            sum = sum + args.places[place].share * max(args.means[place], splat(0.0f));
    args.light[args.first + index] = sum;
}
