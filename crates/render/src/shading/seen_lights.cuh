// Lights that rays see: twin of seen_lights.rs, with its steps.
#pragma once

#include "data/clip.cuh"
#include "shading/shading.cuh"

// A ray and how wide it is.
struct Beam {
    Vec3 origin, direction;
    Cone cone;
    // What the width of the cone is multiplied with, and where it hits a surface.
    float times, end;
    // The part of it on which lights are seen.
    Limits limits;
    // The share of lights that it shows.
    float shown;
    bool from_camera;
};

// What a ray sees of a light; a share of 0 if nothing.
struct Seen {
    float distance, share;
    Vec3 radiance;
};

// What is in front of the surface that a ray hits, or of everything behind the scene: how much of that is left, and what is seen of lights.
struct InFront {
    float left;
    Vec3 radiance;
};

// The lights in front of what a ray sees, from the nearest on.
struct LightsInFront {
    float left, last_distance;
    unsigned last;
};

// How wide the ray is after a distance.
DEVICE float beam_width(const Beam &beam, float distance) { return fabsf(beam.cone.width + beam.cone.spread * distance) * beam.times; }

// Whether a light at this distance is seen.
DEVICE bool is_met_at(const Beam &beam, float distance) {
    return distance > beam.limits.start && distance <= beam.end * SAME_DISTANCE && distance <= beam.limits.end;
}

// Where the ray meets a plane.
struct Met {
    // Whether that is before a surface, and on the side that shines.
    bool is_met;
    // From the light's centre.
    Vec3 place;
    float distance, cosine;
};

DEVICE Met meets(const Beam &beam, const Light &light, Vec3 normal) {
    // 1. Along the plane that is anywhere, but the light is not.
    const Vec3 way = light.position - beam.origin;
    const float toward = dot(normal, beam.direction);
    const float on_plane = dot(normal, way) / toward;
    const float distance = fminf(on_plane, dot(way, beam.direction) + light.size);
    const bool is_met = on_plane > 0.0f && on_plane < INFINITE && is_met_at(beam, distance);
    const bool shines = !light.surface || dot(light.direction, beam.direction) < 0.0f;
    return Met{is_met && shines, on_plane * beam.direction - way, distance, fabsf(toward)};
}

// The radiance of a flat light.
DEVICE Vec3 shining(const Light &light, float distance, float cosine, float area) {
    const float per = light.inverse_square ? 1.0f : PI * (distance * distance);
    const float seen = light.surface ? area : area * larger(cosine, MIN_SHINING_COSINE);
    return (per / seen) * light.intensity;
}

// The share of what is within `half` of a place that lies between -1 and 1.
DEVICE float overlap(float place, float half) {
    place = fabsf(place);
    if (place + half <= 1.0f)
        return 1.0f;
    if (place - half >= 1.0f)
        return 0.0f;
    // Of no width, it lies at the edge.
    const float inside = fminf(place + half, 1.0f) - larger(place - half, -1.0f);
    return half > 0.0f ? fminf(larger(inside / (2.0f * half), 0.0f), 1.0f) : 0.0f;
}

// The share of a circle `aside` from its centre, if its edge is `width` wide.
DEVICE float within_circle(float radius, float aside, float width) {
    const float square = radius * radius, wide = width * width;
    if (wide <= 3.0f * square) {
        const float edge = sqrtf(square - wide * (1.0f / 12.0f));
        const float inside = edge - aside;
        if (width > 0.0f)
            return fminf(larger(inside / width + 0.5f, 0.0f), 1.0f);
        return inside >= 0.0f ? 1.0f : 0.0f;
    }
    return (3.0f * square / wide) * fminf(larger(1.0f - aside / width, 0.0f), 1.0f);
}

DEVICE float within_half(const Beam &beam, Vec3 place, Vec3 half, float width, float least) {
    const float square = dot(half, half);
    const float along = sqrtf(square);
    const float slope = dot(beam.direction, half) / along / least;
    return overlap(dot(place, half) / square, 0.5f * width * sqrtf(1.0f + slope * slope) / along);
}

DEVICE Seen sees_rectangle(const Beam &beam, const Light &light) {
    const Vec3 across = cross(light.half_u, light.half_v);
    const float quarter = length(across);
    const Met met = meets(beam, light, across / quarter);
    if (!met.is_met)
        return Seen{};
    // 2.
    const float width = beam_width(beam, met.distance), least = larger(met.cosine, MIN_SEEN_COSINE);
    const float share = within_half(beam, met.place, light.half_u, width, least) * within_half(beam, met.place, light.half_v, width, least);
    return Seen{met.distance, share, shining(light, met.distance, met.cosine, 4.0f * quarter)};
}

DEVICE Seen sees_disc(const Beam &beam, const Light &light) {
    const Met met = meets(beam, light, light.direction);
    if (!met.is_met)
        return Seen{};
    // 2.
    const float aside = length(met.place);
    const float slope = aside > 0.0f ? dot(beam.direction, met.place) / aside / larger(met.cosine, MIN_SEEN_COSINE) : 0.0f;
    const float share = within_circle(light.radius, aside, beam_width(beam, met.distance) * sqrtf(1.0f + slope * slope));
    return Seen{met.distance, share, shining(light, met.distance, met.cosine, PI * (light.radius * light.radius))};
}

DEVICE Seen sees_ball(const Beam &beam, const Light &light) {
    // 1. Not from inside.
    const Vec3 way = light.position - beam.origin;
    const float square = light.radius * light.radius;
    const float along = dot(way, beam.direction), all = dot(way, way);
    const float aside = length(way - along * beam.direction);
    const float before = aside < light.radius ? sqrtf(square - aside * aside) : 0.0f;
    const float distance = along - before;
    if (!(all > square && is_met_at(beam, distance)))
        return Seen{};
    // 2.
    const float share = within_circle(light.radius, aside, beam_width(beam, along));
    const float strength = cone(light, beam.direction);
    if (strength <= 0.0f)
        return Seen{};
    const float per = light.inverse_square ? FRAC_1_PI : all;
    return Seen{distance, share, (strength * (per / square)) * light.intensity};
}

DEVICE Seen sees_sun(const Beam &beam, const Light &light) {
    // 1. Behind everything.
    const float cosine = -dot(light.direction, beam.direction);
    if (!(beam.end == INFINITE && cosine > 0.0f))
        return Seen{};
    // 2.
    const float aside = length(beam.direction / cosine + light.direction);
    const float share = within_circle(light.radius, aside, fabsf(beam.cone.spread) * beam.times);
    const float square = light.radius * light.radius;
    const float per = light.inverse_square ? FRAC_1_PI : 1.0f;
    return Seen{INFINITE, share, (per * (1.0f + square) / square) * light.intensity};
}

DEVICE Seen sees(const Beam &beam, const Light &light) {
    if (light.kind == Light::RECTANGLE)
        return sees_rectangle(beam, light);
    if (light.kind == Light::DISK)
        return sees_disc(beam, light);
    return light.kind == Light::SPHERE ? sees_ball(beam, light) : sees_sun(beam, light);
}

// A ray, `times` as wide as its cone.
DEVICE Beam beam_of(const Rays &rays, const Hit *hits, unsigned ray, float times) {
    const Ray along = ray_at(rays, ray);
    const Hit hit = load_hit(hits, ray);
    const float end = hit.triangle != Hit::NONE ? hit.t : INFINITE;
    return Beam{along.origin, along.direction, cone_of(rays, ray), times, end, limits_of(rays, ray, along), lights_share(rays, ray),
                rays.depth == 0};
}

// All of what is behind, and no light yet.
DEVICE LightsInFront in_front_of_all() { return LightsInFront{1.0f, -1.0f, 0}; }

// The next light in front of what a ray sees, and what it shows of it; false if there are no more. A function of its own, so that its callers keep
// their registers.
COLD bool next_in_front(const Scene &scene, const Beam &beam, LightsInFront &walk, unsigned &index, Vec3 &radiance) {
    // 3. From the nearest on.
    if (!(walk.left > 0.0f))
        return false;
    Seen nearest = {};
    for (unsigned number = 0; number < scene.light_count; ++number) {
        const Light &light = scene.lights[number];
        if ((light.seen & (beam.from_camera ? Light::CAMERA : Light::SURFACE)) == 0)
            continue;
        const Seen seen = sees(beam, light);
        const bool is_left = seen.distance > walk.last_distance || (seen.distance == walk.last_distance && number > walk.last);
        if (seen.share > 0.0f && is_left && (nearest.share == 0.0f || seen.distance < nearest.distance)) {
            nearest = seen;
            index = number;
        }
    }
    if (nearest.share == 0.0f)
        return false;
    radiance = (walk.left * nearest.share * beam.shown) * nearest.radiance;
    walk.left *= 1.0f - nearest.share;
    walk.last_distance = nearest.distance;
    walk.last = index;
    return true;
}

// What is in front of what a ray sees.
DEVICE InFront in_front(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray, float times) {
    InFront all = {1.0f, splat(0.0f)};
    if (!scene.seen_lights)
        return all;
    const Beam beam = beam_of(rays, hits, ray, times);
    LightsInFront walk = in_front_of_all();
    unsigned index;
    Vec3 radiance;
    while (next_in_front(scene, beam, walk, index, radiance))
        all.radiance = all.radiance + radiance;
    all.left = walk.left;
    return all;
}
