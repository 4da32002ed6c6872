// What one surface point sees of one light: twin of projected_light.rs.
#pragma once

#include "accel/region.cuh"
#include "sampling.cuh"
#include "surface.cuh"

// The form of a light's samples.
enum Shape { SHAPE_DISC, SHAPE_RECTANGLE, SHAPE_POINT };

// Whether more than the centre of a light counts.
DEVICE bool is_spread_over(const Sampling &sampling, const Light &light) {
    const bool spread = sampling.spread && light.kind == Light::POINT && light.radius > 0.0f && sampling.samples > 1;
    return has_size(light) || spread;
}

DEVICE Shape shape_of(const Sampling &sampling, const Light &light) {
    if (!is_spread_over(sampling, light))
        return SHAPE_POINT;
    return light.kind == Light::RECTANGLE ? SHAPE_RECTANGLE : SHAPE_DISC;
}

// A light as one surface point sees it: samples are at `center + x · along + y · across`, seen from the point and scaled.
struct Sight {
    Vec3 center, along, across;
    // The scale over the parameter at which segments to the light end.
    float end;
    // By how much of their distance samples are shifted along their rows; in [0, 1).
    float shift;
    // The part of the last line that lies inside of a rectangle; in (0, 1].
    float inside;
    // Selects the samples that are left out where a row has too many.
    unsigned choice;
};

// The way from a point to the centre of a light, from which no point of the light is farther than `radius`.
DEVICE Vec3 way_to(const Scene &scene, const Light &light, Vec3 from, float &radius) {
    const float reach = scene_reach(scene, from), largest = larger(light.size, light.radius);
    radius = light.kind == Light::DIRECTIONAL ? reach * largest : largest;
    return light_center(light, from, reach) - from;
}

// Two unit vectors perpendicular to `way` and to each other.
DEVICE void facing(Vec3 way, Vec3 &tangent, Vec3 &bitangent) {
    const float far = length(way);
    const Vec3 n = far > 0.0f ? way / far : Vec3{0.0f, 0.0f, 1.0f};
    const float sign = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    tangent = Vec3{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
    bitangent = Vec3{b, sign + n.y * n.y * a, -n.y};
}

// The place of a disc's only row that is as likely to be below `share` of the disc as above, for `share` in [-1, 1].
DEVICE float middle_row(float share) {
    const float square = share * share;
    return share * (0.79f + square * (0.05f + 0.15f * square * square));
}

// The samples of a light's rectangle.
DEVICE void project_rectangle(Sight &projected, const Light &light, unsigned lines, float aside) {
    Vec3 u = light.scale * light.half_u, v = light.scale * light.half_v;
    if (length_squared(u) < length_squared(v)) {
        const Vec3 longer = v;
        v = u;
        u = longer;
    }
    const Vec3 step = v / (float)lines;
    projected.inside = 1.0f - aside;
    projected.center = projected.center + 2.0f * aside * step;
    projected.along = u + step;
    projected.across = v;
}

// The samples of a disc about `center`.
DEVICE void project_disc(Sight &projected, const Light &light, Vec3 center, float reach, unsigned lines, float turn, float aside) {
    Vec3 tangent = light.half_u, bitangent = light.half_v;
    if (light.kind == Light::POINT || light.kind == Light::SPHERE)
        facing(center, tangent, bitangent);
    const float square = turn * turn;
    const float cosine = (1.0f - square) / (1.0f + square), sine = 2.0f * turn / (1.0f + square);
    const float radius = light.scale * disc_radius(light, center, reach);
    projected.along = radius * (cosine * tangent + sine * bitangent);
    projected.across = radius * (cosine * bitangent - sine * tangent);
    if (lines == 1) {
        const float y = middle_row(2.0f * aside - 1.0f);
        projected.center = projected.center + y * projected.across;
        projected.along = sqrtf(larger(1.0f - y * y, 0.0f)) * projected.along;
    }
}

// Light number `index` as `point` sees it; `key` selects the random pattern, `lines` is the number of rows of samples.
DEVICE Sight projected_light_of(const Scene &scene, const Sampling &sampling, unsigned index, Shape shape, unsigned lines,
                                const SurfacePoint &point, unsigned long long key) {
    const Light &light = scene.lights[index];
    const float reach = scene_reach(scene, point.origin);
    const Vec3 target = seen_center(light, point.origin, reach);
    const Vec3 center = target - point.origin;
    const float length = max_element(abs(center));
    const float error = GAMMA_32 * max_element(max(abs(point.origin), abs(target)));
    const float spared = error < 0.5f * length ? error / length : 0.5f;
    Sight projected = {};
    projected.center = light.scale * center;
    projected.end = light.scale / (1.0f - spared);
    projected.inside = 1.0f;
    if (shape == SHAPE_POINT)
        return projected;
    const unsigned long long random = random_bits(sampling.seed, key, index);
    projected.shift = (float)((unsigned)random & 0xffff) / SHIFT_STEPS;
    projected.choice = (unsigned)(random >> 16) & 0xffff;
    const float aside = (float)projected.choice / SHIFT_STEPS,
        turn = (float)((unsigned)(random >> 32) & 0xffff) / (0.5f * SHIFT_STEPS) - 1.0f;
    if (shape == SHAPE_RECTANGLE)
        project_rectangle(projected, light, lines, aside);
    else
        project_disc(projected, light, center, reach, lines, turn, aside);
    return projected;
}

DEVICE float shift_of(const Sight &projected, const SampleRows &set, unsigned row) {
    const float shift = projected.shift + set.shift[row];
    return shift >= 1.0f ? shift - 1.0f : shift;
}

// The place of x = 0 in a row of samples.
DEVICE float row_offset(const Sight &projected, const SampleRows &set, unsigned row) {
    return set.half[row] - shift_of(projected, set, row);
}

// The sample at place `place` of row number `row`, seen from the point and not scaled.
DEVICE Vec3 sample_at(const Sight &projected, const SampleRows &set, unsigned row, unsigned place, float scale) {
    const float x = ((float)place - row_offset(projected, set, row)) / set.density[row];
    return (projected.center + x * projected.along + set.y[row] * projected.across) / scale;
}

// The samples of a row that count, as the lowest bits.
DEVICE unsigned valid_samples(const Sight &projected, const SampleRows &set, unsigned row) {
    const unsigned count = set.count[row];
    unsigned bits = (1u << count) - 1;
    // What enters a rectangle, and what leaves it.
    if (row == set.entering || row == set.leaving) {
        const unsigned inside = (unsigned)larger(ceilf(projected.inside * (float)count - shift_of(projected, set, row)), 0.0f);
        const unsigned before = (1u << min(inside, count)) - 1;
        bits &= row == set.leaving ? before : ~before;
    }
    // Some rows, one after the other from any, have a sample less.
    if ((set.line[row] + projected.choice) % set.lines < set.surplus)
        bits &= ~(1u << (set.line[row] + projected.choice / set.lines) % count);
    return bits;
}

// ---- Searches ----

// No sample of a ball is farther from its centre.
DEVICE float ball_extent(const Light &light) { return light.body > 0.0f ? ASIDE_OF_BODY * light.body : light.radius; }

// Half the edges of the box around a light, if a directional one is `reach` away.
DEVICE Vec3 half_extent(const Light &light, float reach) {
    if (light.kind == Light::RECTANGLE)
        return abs(light.half_u) + abs(light.half_v);
    if (light.kind == Light::DISK || light.kind == Light::DIRECTIONAL) {
        const Vec3 rest = max(Vec3{1.0f, 1.0f, 1.0f} - light.direction * light.direction, splat(0.0f));
        const float radius = ENLARGEMENT * (light.kind == Light::DISK ? light.radius : reach * light.radius);
        return radius * Vec3{rough_root(rest.x), rough_root(rest.y), rough_root(rest.z)};
    }
    return splat(light.kind == Light::POINT || light.kind == Light::SPHERE ? ball_extent(light) : 0.0f);
}

// A box around the samples of a light as seen from `origins`.
DEVICE Bounds emitter_bounds(const Scene &scene, const Light &light, Shape shape, const Bounds &origins) {
    const Vec3 apart = max(abs(origins.low - scene.center), abs(origins.high - scene.center));
    const float reach = scene.far + 2.0f * element_sum(apart);
    Bounds middle = {light.position, light.position};
    if (light.kind == Light::DIRECTIONAL) {
        const Vec3 way = reach * light.direction;
        middle = Bounds{origins.low - way, origins.high - way};
    }
    const Vec3 half = shape == SHAPE_POINT ? splat(0.0f) : half_extent(light, reach);
    return Bounds{middle.low - half, middle.high + half};
}

// Where everything is that may hide an emitter from a point of `origins`. `memory` is for its faces.
DEVICE Region<ShaftShape> shadow_region(const Bounds &origins, const Bounds &emitter, ShaftFaces *memory) {
    const Vec3 extent = max(origins.high, emitter.high) - min(origins.low, emitter.low);
    const Vec3 margin = splat(SHADOW_MARGIN * max_element(extent));
    return region_shaft(Bounds{origins.low - margin, origins.high + margin}, Bounds{emitter.low - margin, emitter.high + margin},
                        memory);
}
