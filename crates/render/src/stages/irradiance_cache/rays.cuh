// Gather rays: their directions, and what they see. Twin of rays.rs.
#pragma once

#include "cuda/tally.cuh"
#include "stages/irradiance_cache/cells.cuh"
#include "stages/irradiance_cache/directions.cuh"
#include "stages/irradiance_cache/guide.cuh"
#include "shading/environment.cuh"
#include "shading/shading.cuh"
#include "shadow/shadow.cuh"

DEVICE unsigned rays_per_record(const HemisphereRays &hemispheres) { return hemispheres.side * hemispheres.side; }

// Where ray number `index` of an even hemisphere lies in the square [-1, 1]^2.
DEVICE void even_place(const HemisphereRays &hemispheres, unsigned long long seed, unsigned index, float &x, float &y) {
    const unsigned long long random = random_bits(seed, index, hemispheres.side);
    const float column = (float)(index % hemispheres.side) + (float)((unsigned)random >> 8) * LAST_DIGIT;
    const float row = (float)(index / hemispheres.side) + (float)((unsigned)(random >> 32) >> 8) * LAST_DIGIT;
    const float side = (float)hemispheres.side;
    x = 2.0f * column / side - 1.0f;
    y = 2.0f * row / side - 1.0f;
}

// The direction of ray number `index` from record number `number`, its weight by the cosine, and how many rays of an even hemisphere it stands for.
DEVICE Vec3 hemisphere_direction(const HemisphereRays &hemispheres, unsigned number, const Record &record, unsigned index, float &weight, float &area) {
    const unsigned long long seed = record.seed ^ hemispheres.sampling.seed;
    float x, y;
    area = 1.0f;
    if (hemispheres.ends != nullptr)
        guided_place(hemispheres, number, seed, index, x, y, area);
    else
        even_place(hemispheres, seed, index, x, y);
    const Vec3 local = direction_above(x, y, weight);
    weight = area * weight;
    Vec3 tangent, other;
    basis(record.normal, tangent, other);
    return local.x * tangent + local.y * other + local.z * record.normal;
}

// Casts a hemisphere of rays from a record. One warp.
DEVICE void cast_hemisphere(const HemisphereRays &hemispheres, unsigned number) {
    const unsigned lane = lane_of_thread(), rays = rays_per_record(hemispheres);
    const unsigned long long start = (unsigned long long)number * rays;
    const Record record = hemispheres.records[number];
    float sum = 0.0f;
    for (unsigned first = 0; first < rays; first += WARP) {
        float weight = 0.0f;
        if (first + lane < rays) {
            float area;
            const Vec3 direction = hemisphere_direction(hemispheres, number, record, first + lane, weight, area);
            hemispheres.list[start + first + lane] = ListedRay{record.origin, number, direction, 0, splat(1.0f), 0};
            hemispheres.weights[start + first + lane] = weight;
            hemispheres.areas[start + first + lane] = area;
        }
        // In the order of the rays.
        for (unsigned ray = 0; ray < WARP && first + ray < rays; ++ray)
            sum += __shfl_sync(ALL_LANES, weight, ray);
    }
    __syncwarp();
    for (unsigned ray = lane; ray < rays; ray += WARP)
        hemispheres.weights[start + ray] /= sum;
    if (lane == 0)
        atomicAdd(&tally_shard(hemispheres.tally).gather_rays, (unsigned long long)rays);
}

// The ray of a thread; false if there is none.
DEVICE bool ray_of_thread(const HemisphereRays &hemispheres, unsigned &ray) {
    ray = blockIdx.x * BLOCK + threadIdx.x;
    return ray < hemispheres.count * rays_per_record(hemispheres);
}

template <class Structure>
DEVICE void trace_hemispheres(const HemisphereRays &hemispheres, const Structure &structure) {
    unsigned number;
    if (!ray_of_thread(hemispheres, number))
        return;
    Ray ray = ray_at(hemispheres.rays, number);
    ray.t_max = hemispheres.reach * size_of_level(hemispheres.records[number / rays_per_record(hemispheres)].level);
    store_hit(hemispheres.hits, number, closest_hit(structure, hemispheres.tally, ray));
}

// The level of the smallest cells that the rays of a record ask for reflected light: cells become larger from reflection to reflection, up to what
// suits a ray of mean length, so that neither corners are asked in detail everywhere nor whole rooms as one.
DEVICE int asked_level(const HemisphereRays &hemispheres, unsigned record) {
    const int own = hemispheres.records[record].level;
    float sum = 0.0f, count = 0.0f;
    for (unsigned ray = record * rays_per_record(hemispheres); ray < (record + 1) * rays_per_record(hemispheres); ++ray) {
        const Hit hit = load_hit(hemispheres.hits, ray);
        if (hit.triangle != Hit::NONE) {
            sum += hemispheres.areas[ray] * hit.t;
            count += hemispheres.areas[ray];
        }
    }
    float rest;
    return hemispheres.is_near || count == 0.0f ? own : max(own, min(own + 1, level_of_width(BOUNCE_SIZE * (sum / count), rest)));
}

// About how strongly a light may shine on a surface point, whose reach is given: 0 only if no part of it does.
DEVICE float strength_expected(const Light &light, const SurfacePoint &point, float reach) {
    const Vec3 way = light_center(light, point.origin, reach) - point.origin;
    const float distance = length(way);
    const float size = light.kind == Light::DIRECTIONAL ? distance * light.size : light.kind == Light::POINT ? light.radius : light.size;
    const float far = larger(distance, size);
    const float received = fminf((dot(point.normal, way) + size) / far, 1.0f);
    const float front = light.surface ? -dot(light.direction, way) : far;
    if (received <= 0.0f || front <= 0.0f)
        return 0.0f;
    const float intensity = larger(larger(light.intensity.x, light.intensity.y), light.intensity.z);
    return falloff(light, far) * intensity * received * fminf((front + size) / far, 1.0f);
}

// Which lights a point asks about, of many: one after the other, each with a chance by what it may give. A light that is chosen stands for those that
// are not.
struct Choice {
    // How many lights one of strength 1 counts as; 0: all are chosen.
    float scale;
    // How many the lights so far count as. Wherever that passes a whole number, a light is chosen.
    float sum;
};

DEVICE Choice choice_of(const HemisphereRays &hemispheres, const SurfacePoint &point, float reach, unsigned long long key) {
    Choice choice = {0.0f, 0.0f};
    if (hemispheres.scene.light_count > CHOSEN_LIGHTS) {
        float total = 0.0f;
        for (unsigned light = 0; light < hemispheres.scene.light_count; ++light)
            total += strength_expected(hemispheres.scene.lights[light], point, reach);
        if (total > 0.0f && total < INFINITE) {
            const unsigned long long random = random_bits(hemispheres.sampling.seed, key, hemispheres.scene.light_count);
            choice = Choice{(float)CHOSEN_LIGHTS / total, (float)(random >> 40) * LAST_DIGIT};
        }
    }
    return choice;
}

// The chance that the next light had if it is chosen; 0 if it is not.
DEVICE float chance_of(Choice &choice, const Light &light, const SurfacePoint &point, float reach) {
    if (choice.scale == 0.0f)
        return 1.0f;
    const float chance = strength_expected(light, point, reach) * choice.scale;
    const float before = choice.sum;
    choice.sum += chance;
    if (chance >= 1.0f)
        return 1.0f;
    return floorf(choice.sum) > floorf(before) ? chance : 0.0f;
}

// Adds what reaches a point from lights that are chosen, as a random point of each is seen or not. Returns the number of rays that were cast.
template <class Structure>
DEVICE unsigned add_lights(const HemisphereRays &hemispheres, const Structure &structure, const Surface &surface, unsigned long long key, Vec3 &radiance) {
    const float reach = scene_reach(hemispheres.scene, surface.point.origin);
    Choice choice = choice_of(hemispheres, surface.point, reach, key);
    unsigned cast = 0;
    for (unsigned light = 0; light < hemispheres.scene.light_count; ++light) {
        const float chance = chance_of(choice, hemispheres.scene.lights[light], surface.point, reach);
        if (chance == 0.0f)
            continue;
        const Vec3 to = target(targets_of(hemispheres.scene, hemispheres.sampling, light, surface.point.origin, key), 0);
        if (dot(surface.point.normal, to - surface.point.origin) <= 0.0f)
            continue;
        const Vec3 gain = surface.material->all * (arriving(surface, hemispheres.scene, light, reach, to) / chance);
        if (gain == splat(0.0f))
            continue;
        ++cast;
        if (!hidden(structure, hemispheres.tally, hemispheres.scene.lights[light], surface.point.origin, to))
            radiance = radiance + gain;
    }
    return cast;
}

// What a ray sees, but for the light that reaches what it hits from no light directly.
template <class Structure>
DEVICE SeenRay seen_by(const HemisphereRays &hemispheres, const Structure &structure, unsigned ray, unsigned &cast) {
    SeenRay seen = {};
    seen.kind = SURFACE_KINDS;
    seen.node = NO_NUMBER;
    const Hit hit = load_hit(hemispheres.hits, ray);
    const Vec3 direction = ray_at(hemispheres.rays, ray).direction;
    // A shadow catcher shows what is behind it.
    if (hit.triangle == Hit::NONE || hemispheres.scene.materials[material_index(hemispheres.scene, hit.triangle)].catcher) {
        if (!hemispheres.is_near || hit.triangle != Hit::NONE)
            seen.radiance = surroundings(hemispheres.scene.environment, direction, SKY_CONE * hemispheres.rays.cone.spread);
        return seen;
    }
    Material own;
    const Surface surface = surface_at(hemispheres.scene, hemispheres.rays, hemispheres.hits, ray, own);
    seen.radiance = hemispheres.lamps && surface.material->lamp ? splat(0.0f) : surface.material->emission;
    // Facets reflect as if they scattered.
    if (surface.material->all == splat(0.0f))
        return seen;
    const unsigned number = ray / rays_per_record(hemispheres), index = ray % rays_per_record(hemispheres);
    const Record &record = hemispheres.records[number];
    cast = add_lights(hemispheres, structure, surface, record.seed + (rays_per_record(hemispheres) + index), seen.radiance);
    const bool front = dot(outward_of(corners_at(hemispheres.scene.triangles, hit.triangle)), direction) < 0.0f;
    float rest;
    seen.position = surface.point.position;
    seen.normal = surface.point.normal;
    seen.kd = surface.material->all;
    seen.level = max(level_of_width(BOUNCE_SIZE * hit.t, rest), hemispheres.levels[number]);
    seen.kind = surface_kind(surface.point.normal, front);
    return seen;
}

template <class Structure>
DEVICE void see(const HemisphereRays &hemispheres, const Structure &structure) {
    unsigned ray, cast = 0;
    if (ray_of_thread(hemispheres, ray))
        hemispheres.seen[ray] = seen_by(hemispheres, structure, ray, cast);
    count(tally_shard(hemispheres.tally).shadow_rays, cast);
}

// Finds the mean luminance that the rays of a record see. Rays that see much more ask the smallest cells at once.
DEVICE void brighten(const HemisphereRays &hemispheres, unsigned record) {
    const unsigned first = record * rays_per_record(hemispheres), end = first + rays_per_record(hemispheres);
    float mean = 0.0f;
    for (unsigned ray = first; ray < end; ++ray)
        mean += hemispheres.weights[ray] * luminance(hemispheres.seen[ray].radiance);
    hemispheres.brightness[record] = mean;
    for (unsigned ray = first; ray < end; ++ray)
        if (luminance(hemispheres.seen[ray].radiance) > BRIGHT * mean)
            hemispheres.seen[ray].from = BOUNCE_FINER;
}
