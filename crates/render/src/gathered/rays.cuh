// Gather rays: their directions, and what they see. Twin of rays.rs.
#pragma once

#include "cuda/tally.cuh"
#include "gathered/cells.cuh"
#include "gathered/directions.cuh"
#include "gathered/guide.cuh"
#include "shading/environment.cuh"
#include "shading/shading.cuh"
#include "shadow/shadow.cuh"

DEVICE unsigned rays_of_fan(const Fans &fans) { return fans.side * fans.side; }

// Where ray number `index` of an even fan lies in the square [-1, 1]^2.
DEVICE void even_place(const Fans &fans, unsigned long long seed, unsigned index, float &x, float &y) {
    const unsigned long long random = random_bits(seed, index, fans.side);
    const float column = (float)(index % fans.side) + (float)((unsigned)random >> 8) * LAST_DIGIT;
    const float row = (float)(index / fans.side) + (float)((unsigned)(random >> 32) >> 8) * LAST_DIGIT;
    const float side = (float)fans.side;
    x = 2.0f * column / side - 1.0f;
    y = 2.0f * row / side - 1.0f;
}

// The direction of ray number `index` from site number `number`, its weight by the cosine, and how many rays of an even fan it stands for.
DEVICE Vec3 fan_direction(const Fans &fans, unsigned number, const Site &site, unsigned index, float &weight, float &area) {
    const unsigned long long seed = site.seed ^ fans.sampling.seed;
    float x, y;
    area = 1.0f;
    if (fans.ends != nullptr)
        guided_place(fans, number, seed, index, x, y, area);
    else
        even_place(fans, seed, index, x, y);
    const Vec3 local = direction_above(x, y, weight);
    weight = area * weight;
    Vec3 tangent, other;
    basis(site.normal, tangent, other);
    return local.x * tangent + local.y * other + local.z * site.normal;
}

// Casts a fan of rays from a site. One warp.
DEVICE void cast_fan(const Fans &fans, unsigned number) {
    const unsigned lane = lane_of_thread(), rays = rays_of_fan(fans);
    const unsigned long long start = (unsigned long long)number * rays;
    const Site site = fans.sites[number];
    float sum = 0.0f;
    for (unsigned first = 0; first < rays; first += WARP) {
        float weight = 0.0f;
        if (first + lane < rays) {
            float area;
            const Vec3 direction = fan_direction(fans, number, site, first + lane, weight, area);
            fans.list[start + first + lane] = ListedRay{site.origin, number, direction, 0, splat(1.0f), 0};
            fans.weights[start + first + lane] = weight;
            fans.areas[start + first + lane] = area;
        }
        // In the order of the rays.
        for (unsigned ray = 0; ray < WARP && first + ray < rays; ++ray)
            sum += __shfl_sync(ALL_LANES, weight, ray);
    }
    __syncwarp();
    for (unsigned ray = lane; ray < rays; ray += WARP)
        fans.weights[start + ray] /= sum;
    if (lane == 0)
        atomicAdd(&tally_shard(fans.tally).gather_rays, (unsigned long long)rays);
}

// The ray of a thread; false if there is none.
DEVICE bool fan_ray_of_thread(const Fans &fans, unsigned &ray) {
    ray = blockIdx.x * BLOCK + threadIdx.x;
    return ray < fans.count * rays_of_fan(fans);
}

template <class Structure>
DEVICE void trace_fans(const Fans &fans, const Structure &structure) {
    unsigned number;
    if (!fan_ray_of_thread(fans, number))
        return;
    Ray ray = ray_at(fans.rays, number);
    ray.t_max = fans.reach * size_of_level(fans.sites[number / rays_of_fan(fans)].level);
    store_hit(fans.hits, number, closest_hit(structure, fans.tally, ray));
}

// The level of the smallest cells that the rays of a site ask for reflected light: cells become larger from reflection to reflection, up to what
// suits a ray of mean length, so that neither corners are asked in detail everywhere nor whole rooms as one.
DEVICE int asked_level(const Fans &fans, unsigned site) {
    const int own = fans.sites[site].level;
    float sum = 0.0f, count = 0.0f;
    for (unsigned ray = site * rays_of_fan(fans); ray < (site + 1) * rays_of_fan(fans); ++ray) {
        const Hit hit = load_hit(fans.hits, ray);
        if (hit.triangle != Hit::NONE) {
            sum += fans.areas[ray] * hit.t;
            count += fans.areas[ray];
        }
    }
    float rest;
    return fans.is_near || count == 0.0f ? own : max(own, min(own + 1, level_of_width(BOUNCE_SIZE * (sum / count), rest)));
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

DEVICE Choice choice_of(const Fans &fans, const SurfacePoint &point, float reach, unsigned long long key) {
    Choice choice = {0.0f, 0.0f};
    if (fans.scene.light_count > CHOSEN_LIGHTS) {
        float total = 0.0f;
        for (unsigned light = 0; light < fans.scene.light_count; ++light)
            total += strength_expected(fans.scene.lights[light], point, reach);
        if (total > 0.0f && total < INFINITE) {
            const unsigned long long random = random_bits(fans.sampling.seed, key, fans.scene.light_count);
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
DEVICE unsigned add_lights(const Fans &fans, const Structure &structure, const Surface &surface, unsigned long long key, Vec3 &radiance) {
    const float reach = scene_reach(fans.scene, surface.point.origin);
    Choice choice = choice_of(fans, surface.point, reach, key);
    unsigned cast = 0;
    for (unsigned light = 0; light < fans.scene.light_count; ++light) {
        const float chance = chance_of(choice, fans.scene.lights[light], surface.point, reach);
        if (chance == 0.0f)
            continue;
        const Vec3 to = target(targets_of(fans.scene, fans.sampling, light, surface.point.origin, key), 0);
        if (dot(surface.point.normal, to - surface.point.origin) <= 0.0f)
            continue;
        const Vec3 gain = surface.material->all * (arriving(surface, fans.scene, light, reach, to) / chance);
        if (gain == splat(0.0f))
            continue;
        ++cast;
        if (!hidden(structure, fans.tally, fans.scene.lights[light], surface.point.origin, to))
            radiance = radiance + gain;
    }
    return cast;
}

// What a ray sees, but for the light that reaches what it hits from no light directly.
template <class Structure>
DEVICE SeenRay seen_by(const Fans &fans, const Structure &structure, unsigned ray, unsigned &cast) {
    SeenRay seen = {};
    seen.kind = SURFACE_KINDS;
    seen.node = NO_NUMBER;
    const Hit hit = load_hit(fans.hits, ray);
    const Vec3 direction = ray_at(fans.rays, ray).direction;
    // A shadow catcher shows what is behind it.
    if (hit.triangle == Hit::NONE || fans.scene.materials[material_index(fans.scene, hit.triangle)].catcher) {
        if (!fans.is_near || hit.triangle != Hit::NONE)
            seen.radiance = surroundings(fans.scene.environment, direction, SKY_CONE * fans.rays.cone.spread);
        return seen;
    }
    Material own;
    const Surface surface = surface_at(fans.scene, fans.rays, fans.hits, ray, own);
    seen.radiance = fans.lamps && surface.material->lamp ? splat(0.0f) : surface.material->emission;
    // Facets reflect as if they scattered.
    if (surface.material->all == splat(0.0f))
        return seen;
    const unsigned number = ray / rays_of_fan(fans), index = ray % rays_of_fan(fans);
    const Site &site = fans.sites[number];
    cast = add_lights(fans, structure, surface, site.seed + (rays_of_fan(fans) + index), seen.radiance);
    const bool front = dot(outward_of(corners_at(fans.scene.triangles, hit.triangle)), direction) < 0.0f;
    float rest;
    seen.position = surface.point.position;
    seen.normal = surface.point.normal;
    seen.kd = surface.material->all;
    seen.level = max(level_of_width(BOUNCE_SIZE * hit.t, rest), fans.levels[number]);
    seen.kind = surface_kind(surface.point.normal, front);
    return seen;
}

template <class Structure>
DEVICE void see(const Fans &fans, const Structure &structure) {
    unsigned ray, cast = 0;
    if (fan_ray_of_thread(fans, ray))
        fans.seen[ray] = seen_by(fans, structure, ray, cast);
    count(tally_shard(fans.tally).shadow_rays, cast);
}

// Finds the mean luminance that the rays of a site see. Rays that see much more ask the smallest cells at once.
DEVICE void brighten(const Fans &fans, unsigned site) {
    const unsigned first = site * rays_of_fan(fans), end = first + rays_of_fan(fans);
    float mean = 0.0f;
    for (unsigned ray = first; ray < end; ++ray)
        mean += fans.weights[ray] * luminance(fans.seen[ray].radiance);
    fans.brightness[site] = mean;
    for (unsigned ray = first; ray < end; ++ray)
        if (luminance(fans.seen[ray].radiance) > BRIGHT * mean)
            fans.seen[ray].from = BOUNCE_FINER;
}
