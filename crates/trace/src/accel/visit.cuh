// What is done with the triangles that a walk reaches; the same for every structure. Twin of visit.rs.
//
// A walk passes on triangles in sets, and queries how far it is still worth walking:
//
//     template <class Structure, class Set> bool ask(Visitor &, const Structure &, Set set);   // false ends the walk
//     float limit(const Visitor &);                                                             // what lies beyond need not be tested
#pragma once

#include "accel/alpha_mask.cuh"

// The triangles from `next` to before `end`.
struct Run {
    unsigned next, end;
};

DEVICE bool take(Run &run, unsigned &triangle) {
    triangle = run.next++;
    return triangle < run.end;
}

// For each bit set in a word, the triangle that many places after `base`.
struct Chosen {
    unsigned base, bits;
};

DEVICE bool take(Chosen &chosen, unsigned &triangle) {
    triangle = chosen.base + __ffs(chosen.bits) - 1;
    const bool any = chosen.bits != 0;
    chosen.bits &= chosen.bits - 1;
    return any;
}

template <unsigned AXIS, class Structure, class Set>
DEVICE bool next_candidate_along(const RayShear &ray, const Structure &structure, Set &set, unsigned &triangle, Sheared &corners) {
    while (take(set, triangle))
        if (may_meet<AXIS>(ray, triangle_at(structure, triangle), corners))
            return true;
    return false;
}

// The next triangle of the set that single precision cannot rule out. The loop is short, and most triangles go no further; those
// that do are decided outside of it, by all lanes of a warp that have one at once.
template <class Structure, class Set>
DEVICE bool next_candidate(const RayShear &ray, const Structure &structure, Set &set, unsigned &triangle, Sheared &corners) {
    // Tested bit by bit, this becomes two branches instead of a jump table.
    if (ray.axis & 1)
        return next_candidate_along<1>(ray, structure, set, triangle, corners);
    if (ray.axis & 2)
        return next_candidate_along<2>(ray, structure, set, triangle, corners);
    return next_candidate_along<0>(ray, structure, set, triangle, corners);
}

// Searches for the closest hit.
struct Closest {
    RayShear ray;
    // Ray parameter of the best hit, or where the ray ends.
    float limit;
    // Place of the triangle that was hit in the structure.
    unsigned best;
};

DEVICE Closest find_closest(const Ray &ray) { return Closest{ray_shear(ray.origin, ray.direction), ray.t_max, Hit::NONE}; }

DEVICE float limit(const Closest &closest) { return closest.limit; }

template <class Structure, class Set>
DEVICE bool ask(Closest &closest, const Structure &structure, Set set) {
    unsigned triangle;
    Sheared corners;
    while (next_candidate(closest.ray, structure, set, triangle, corners)) {
        Weights weights;
        if (!weigh(corners, weights))
            continue;
        const float t = hit_distance(closest.ray, corners, weights);
        // Equally near: the smaller index wins.
        const bool wins = t < closest.limit || (t == closest.limit && closest.best != Hit::NONE &&
                                                triangle_index(triangle_at(structure, triangle)) <
                                                    triangle_index(triangle_at(whole_of(structure), closest.best)));
        if (t > 0.0f && wins && has_surface(alpha_mask_of(structure), triangle_at(structure, triangle), weights)) {
            closest.limit = t;
            closest.best = noted_place(structure, triangle);
        }
    }
    return true;
}

// The hit that was found. Its barycentric weights are computed only now, once.
template <class Structure>
DEVICE Hit found_hit(const Closest &closest, const Structure &structure) {
    if (closest.best == Hit::NONE)
        return hit_nothing();
    const auto triangle = triangle_at(structure, closest.best);
    Sheared corners;
    may_meet(closest.ray, triangle, corners);
    Weights weights;
    weigh(corners, weights);
    const float u = (float)(weights.v / weights.det), v = (float)(weights.w / weights.det);
    return Hit{closest.limit, u, v, triangle_index(triangle)};
}

// Searches for any hit.
struct Any {
    RayShear ray;
    float t_max;
    // Place of a triangle that was hit in the structure.
    unsigned hit;
};

DEVICE Any find_any(const Ray &ray) { return Any{ray_shear(ray.origin, ray.direction), ray.t_max, Hit::NONE}; }

DEVICE float limit(const Any &any) { return any.t_max; }

template <class Structure, class Set>
DEVICE bool ask(Any &any, const Structure &structure, Set set) {
    unsigned triangle;
    Sheared corners;
    while (next_candidate(any.ray, structure, set, triangle, corners)) {
        Weights weights;
        if (!weigh(corners, weights))
            continue;
        const float t = hit_distance(any.ray, corners, weights);
        if (t > 0.0f && t < any.t_max && has_surface(alpha_mask_of(structure), triangle_at(structure, triangle), weights)) {
            any.hit = noted_place(structure, triangle);
            return false;
        }
    }
    return true;
}

// Searches for a triangle that blocks one short segment.
struct Short {
    ShortTest test;
    Vec3 direction;
    bool blocked;
};

DEVICE float limit(const Short &) { return 1.0f; }

template <class Structure, class Set>
DEVICE bool ask(Short &segment, const Structure &structure, Set set) {
    unsigned triangle;
    while (take(set, triangle)) {
        const Corners corners = load_corners(triangle_at(structure, triangle));
        if (blocks_segment(segment.test, corners, segment.direction) &&
            stops(alpha_mask_of(structure), triangle_at(structure, triangle), corners, segment.test.origin, segment.direction)) {
            segment.blocked = true;
            return false;
        }
    }
    return true;
}
