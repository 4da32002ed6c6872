// Light that is near or wide: the irradiance of a whole light in closed form. Twin of irradiance.rs.
#pragma once

#include "sampling.cuh"
#include "shading/turns.cuh"

// How much of a light's irradiance follows the closed form: from 0 of a light that is far or narrow to 1 of one that is near or wide. `way` is the
// way to its centre.
DEVICE float nearness(const Light &light, Vec3 way) {
    if (light.kind == Light::DIRECTIONAL)
        return light.radius > WIDE_SUN ? 1.0f : 0.0f;
    const float far = NEAR_LIGHT * length(way);
    if (!light.inverse_square || light.size <= far)
        return 0.0f;
    // From there to half of the distance.
    return fminf((light.size - far) / larger(far, F32_MIN_POSITIVE), 1.0f);
}

// The irradiance of a cap of directions, given the cosine between its middle and the normal, and the sine and cosine of its half-angle.
DEVICE float cap(float toward, float sine, float cosine) {
    if (toward >= sine)
        return PI * (sine * sine) * toward;
    if (toward <= -sine)
        return 0.0f;
    const float aside = sqrtf(larger(1.0f - toward * toward, 0.0f));
    const float x = cosine / sine;
    const float y = aside > 0.0f ? fminf(fmaxf(-x * toward / aside, -1.0f), 1.0f) : 0.0f;
    const float q = sqrtf(1.0f - y * y);
    return sine * sine * (toward * angle(q, y) - x * q * aside) + angle(q * aside, x);
}

// Whether all of a disc is above the horizon.
DEVICE bool is_above(Vec3 way, Vec3 axis, float radius, Vec3 normal) {
    const float leaning = dot(normal, axis);
    return dot(normal, way) >= radius * sqrtf(larger(1.0f - leaning * leaning, 0.0f));
}

// The irradiance of a Lambertian disc above the horizon.
DEVICE float lambertian_disc(Vec3 way, Vec3 axis, float radius, Vec3 normal) {
    const float height = dot(axis, way);
    axis = height < 0.0f ? -axis : axis;
    const float z = fabsf(height);
    const Vec3 aside = way - z * axis;
    const float rho_square = length_squared(aside), square = radius * radius;
    const float rho = sqrtf(rho_square);
    const float near = rho - radius, far = rho + radius;
    const float root = sqrtf((z * z + near * near) * (z * z + far * far));
    const float all = z * z + rho_square + square + root;
    const float along = root + (z * z + square - rho_square);
    const float light = dot(normal, axis) * along + 2.0f * z * dot(normal, aside);
    return all * root > 0.0f ? larger(PI * square * light / (all * root), 0.0f) : 0.0f;
}

// A flat light with corners, one after the other: each is the one before, turned in the light's own coordinates.
struct Plate {
    Vec3 center, half_u, half_v;
    // The first corner, in halves.
    float x, y;
    // The angle to the next.
    float cosine, sine;
    unsigned corners;
};

// Adds each edge of what is above the horizon.
template <class Edges>
DEVICE void each_edge(const Plate &plate, Vec3 normal, Edges &edges) {
    float x = plate.x, y = plate.y;
    Vec3 start = plate.center + (x * plate.half_u + y * plate.half_v);
    float from = dot(normal, start);
    // Where the polygon leaves, and where it comes back to, what is above.
    Vec3 left = {}, back = {};
    bool cut = false;
    ROLLED
    for (unsigned corner = 0; corner < plate.corners; ++corner) {
        const float turned = plate.cosine * x - plate.sine * y;
        y = plate.sine * x + plate.cosine * y;
        x = turned;
        const Vec3 end = plate.center + (x * plate.half_u + y * plate.half_v);
        const float to = dot(normal, end);
        if (from >= 0.0f || to >= 0.0f) {
            const Vec3 crossing = start + from / (from - to) * (end - start);
            Vec3 a = start, b = end;
            if (from < 0.0f) {
                back = crossing;
                a = crossing;
            } else if (to < 0.0f) {
                left = crossing;
                cut = true;
                b = crossing;
            }
            add_edge(edges, a, b);
        }
        start = end;
        from = to;
    }
    if (cut)
        add_edge(edges, left, back);
}

// The sum over edges if it is Lambertian.
struct LambertianEdges {
    Vec3 normal;
    float sum;
};

DEVICE void add_edge(LambertianEdges &edges, Vec3 a, Vec3 b) {
    const Vec3 across = cross(a, b);
    const float far = length(across);
    if (far > 0.0f)
        edges.sum += angle(far, dot(a, b)) * (dot(edges.normal, across) / far);
}

// The irradiance if it is Lambertian.
DEVICE float lambertian(const Plate &plate, Vec3 normal) {
    LambertianEdges edges = {normal, 0.0f};
    each_edge(plate, normal, edges);
    return 0.5f * fabsf(edges.sum);
}

// The sums over edges if it shines evenly.
struct EvenEdges {
    Vec3 normal, axis, first;
    bool begun;
    float solid, aside;
};

DEVICE void add_edge(EvenEdges &edges, Vec3 a, Vec3 b) {
    if (!edges.begun)
        edges.first = a;
    edges.begun = true;
    const Vec3 first = edges.first;
    const float da = length(a), db = length(b);
    // The triangle of the edge and the first corner (Van Oosterom and Strackee 1983).
    const float d = length(first);
    const float volume = fabsf(dot(first, cross(a, b)));
    const float corner = d * da * db + dot(first, a) * db + dot(first, b) * da + dot(a, b) * d;
    edges.solid += 2.0f * (TAU * turns(volume, corner));
    const Vec3 edge = b - a;
    const float far = length(edge);
    const float sum = da + db + far, rest = larger(da + db - far, 2.0f * UNIT_ROUNDOFF * (da + db + far));
    if (far > 0.0f)
        edges.aside += dot(edges.normal, cross(edge, edges.axis)) / far * logarithm(larger(sum / rest, 1.0f));
}

// The same if it shines evenly; its corners turn around `axis`.
DEVICE float even(const Plate &plate, Vec3 normal, Vec3 axis) {
    const float height = dot(axis, plate.center);
    const Vec3 away = height < 0.0f ? -axis : axis;
    EvenEdges edges = {normal, axis, Vec3{}, false, 0.0f, 0.0f};
    each_edge(plate, normal, edges);
    return larger(dot(normal, away) * edges.solid - edges.aside, 0.0f);
}

// The irradiance of a light of intensity 1 on a surface with the unit `normal`, over pi where that is the light's unit. A spot's cone is left out. A
// function of its own, so that its callers keep their registers.
COLD float irradiance(const Light *light, Vec3 way, Vec3 normal) {
    const float radius = light->radius;
    if (light->kind == Light::DIRECTIONAL) {
        const float cosine = 1.0f / sqrtf(1.0f + radius * radius);
        const float sine = radius * cosine;
        const float share = cap(-dot(normal, light->direction), sine, cosine) / (PI * (sine * sine));
        return light->inverse_square ? FRAC_1_PI * share : share;
    }
    if (light->kind == Light::SPHERE) {
        const float distance = length(way);
        const float sine = distance > radius ? radius / distance : 1.0f;
        const float cosine = sqrtf(larger(1.0f - sine * sine, 0.0f));
        const float toward = distance > 0.0f ? dot(normal, way) / distance : 1.0f;
        return cap(toward, sine, cosine) * (FRAC_1_PI * FRAC_1_PI) / (radius * radius);
    }
    if (light->surface && dot(light->direction, way) >= 0.0f)
        return 0.0f;
    if (light->kind == Light::DISK) {
        const Vec3 axis = light->direction;
        const Plate plate = {way,           radius * light->half_u, radius * light->half_v, CORNER_RADIUS, 0.0f,
                             CORNER_COSINE, CORNER_SINE,            DISC_CORNERS};
        float seen;
        if (!light->surface)
            seen = even(plate, normal, axis);
        else if (is_above(way, axis, radius, normal))
            seen = lambertian_disc(way, axis, radius, normal);
        else
            seen = lambertian(plate, normal);
        return seen * (FRAC_1_PI * FRAC_1_PI) / (radius * radius);
    }
    const Plate plate = {way, light->half_u, light->half_v, 1.0f, 1.0f, 0.0f, 1.0f, 4};
    const Vec3 across = cross(light->half_u, light->half_v);
    const float quarter = length(across);
    const float seen = light->surface ? lambertian(plate, normal) : even(plate, normal, across / quarter);
    return seen * FRAC_1_PI / (4.0f * quarter);
}
