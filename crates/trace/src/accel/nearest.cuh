// The hits of a ray in order, some at once: twin of `All` of visit.rs, which finds all of them.
#pragma once

#include "accel/walk.cuh"

struct NearestHits {
    ClampedRay near;
    RayShear ray;
    // What is not behind this parameter of the ray asked for does not count.
    float behind;
    unsigned count;
    // Parameters of the near ray, and places of triangles in the structure.
    float t[HITS_AT_ONCE];
    unsigned places[HITS_AT_ONCE];
};

DEVICE float limit(const NearestHits &hits) { return hits.count == HITS_AT_ONCE ? hits.t[HITS_AT_ONCE - 1] : hits.near.ray.t_max; }

// Whether a hit at `t` on the triangle `index` comes before hit number `number`.
template <class Structure>
DEVICE bool comes_before(const NearestHits &hits, const Structure &structure, float t, unsigned index, unsigned number) {
    return t < hits.t[number] ||
           (t == hits.t[number] && index < triangle_index(triangle_at(whole_of(structure), hits.places[number])));
}

template <class Structure, class Set>
DEVICE bool ask(NearestHits &hits, const Structure &structure, Set set) {
    unsigned triangle;
    Sheared corners;
    while (next_candidate(hits.ray, structure, set, triangle, corners)) {
        Weights weights;
        if (!weigh(corners, weights))
            continue;
        const float t = hit_distance(hits.ray, corners, weights);
        if (!(t > 0.0f && t < hits.near.ray.t_max && asked_parameter(hits.near, t) > hits.behind))
            continue;
        const unsigned index = triangle_index(triangle_at(structure, triangle));
        const bool full = hits.count == HITS_AT_ONCE;
        if (full && !comes_before(hits, structure, t, index, HITS_AT_ONCE - 1))
            continue;
        if (!has_surface(alpha_mask_of(structure), triangle_at(structure, triangle), weights))
            continue;
        unsigned place = full ? HITS_AT_ONCE - 1 : hits.count++;
        for (; place > 0 && comes_before(hits, structure, t, index, place - 1); --place) {
            hits.t[place] = hits.t[place - 1];
            hits.places[place] = hits.places[place - 1];
        }
        hits.t[place] = t;
        hits.places[place] = noted_place(structure, triangle);
    }
    return true;
}

// Finds the nearest hits of a ray behind a parameter. There may be more if HITS_AT_ONCE are found.
template <class Structure>
DEVICE void find_nearest(const Structure &structure, const Tally &tally, const Ray &ray, float behind, NearestHits &hits) {
    hits.near = clamped_ray(structure.ray_clamp, ray);
    hits.behind = behind;
    hits.count = 0;
    if (hits.near.scale == 0.0)
        return;
    hits.ray = ray_shear(hits.near.ray.origin, hits.near.ray.direction);
    walk(structure, tally, hits.near.ray, hits);
}

// Hit number `number` of those found.
template <class Structure>
DEVICE Hit nearest_hit(const NearestHits &hits, const Structure &structure, unsigned number) {
    Hit hit = found_hit(Closest{hits.ray, hits.t[number], hits.places[number]}, structure);
    hit.t = asked_parameter(hits.near, hit.t);
    return hit;
}
