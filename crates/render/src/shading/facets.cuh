// Facets: rough surfaces, metals and others. Twin of facets.rs, with its steps.
#pragma once

#include "textures/lookup.cuh"

// How a surface point with facets is seen.
struct FacetSight {
    // The cosine of the angle between the normal and the direction to the eye.
    float cosine;
    // The range of mirrored directions over what a sample sees of the surface, an angle.
    float spread;
    // Whether its mirror ray is followed.
    bool followed;
    // Whether it is seen in a mirror.
    bool mirrored;
};

// The share of what facets reflect that mirror rays show.
DEVICE float facets_mirrored_share(float roughness) {
    const float share = fminf(fmaxf((MIRROR_ENDS - roughness) / (MIRROR_ENDS - MIRROR_FADES), 0.0f), 1.0f);
    return share * share * (3.0f - 2.0f * share);
}

// How much of lights mirror rays do not show, in PARTS_OF_FADE parts.
DEVICE unsigned facets_faded(float roughness) {
    const float share = fminf(fmaxf((LIGHTS_END - roughness) / (LIGHTS_END - LIGHTS_FADE), 0.0f), 1.0f);
    return (unsigned)((float)PARTS_OF_FADE * (1.0f - share * share * (3.0f - 2.0f * share)) + 0.5f);
}

// a and b: f0 a + f90 b of light from all sides is reflected.
DEVICE FacetShare facets_of_all(const FacetShare *table, float roughness, float cosine) {
    const float last = (float)FACET_PLACES - 1.0f;
    const float x = roughness * last, y = sqrtf(fminf(cosine, 1.0f)) * last;
    const unsigned column = min((unsigned)x, FACET_PLACES - 2), row = min((unsigned)y, FACET_PLACES - 2);
    const float across = x - (float)column, along = y - (float)row;
    FacetShare rows[2];
    for (unsigned i = 0; i < 2; ++i) {
        const FacetShare *at = table + (row + i) * FACET_PLACES + column;
        rows[i].normal = at[0].normal + across * (at[1].normal - at[0].normal);
        rows[i].grazing = at[0].grazing + across * (at[1].grazing - at[0].grazing);
    }
    return FacetShare{rows[0].normal + along * (rows[1].normal - rows[0].normal),
                      rows[0].grazing + along * (rows[1].grazing - rows[0].grazing)};
}

// What is reflected of light from all sides, with what repeated reflection returns.
DEVICE Vec3 facets_whole(FacetShare share, float again, Vec3 f0, float f90) {
    return (share.normal * f0 + splat(share.grazing * f90)) * (splat(1.0f) + again * f0);
}

// Turns the coefficients of a material with its tint into those of its reflections, and the rest into its lobe.
COLD void set_facets(const FacetShare *table, FacetSight sight, Material *own) {
    const Vec3 base = own->kd, layer = own->ks;
    const float metallic = own->metallic, opacity = own->opacity, roughness = own->roughness;
    const float cosine = fmaxf(sight.cosine, MIN_VIEW_COSINE);
    // 1. and 2.
    const FacetShare share = facets_of_all(table, roughness, cosine);
    const float again = 1.0f / (share.normal + share.grazing) - 1.0f;
    const Vec3 by_layer = facets_whole(share, again, layer, own->grazing);
    const Vec3 all = between(by_layer, facets_whole(share, again, base, 1.0f), metallic);
    const Vec3 front = between(layer, base, metallic);
    const float end = (1.0f - metallic) * own->grazing + metallic;
    const Vec3 once = share.normal * front + share.grazing * splat(end);
    const Vec3 gain = {once.x > 0.0f ? all.x / once.x : 1.0f, once.y > 0.0f ? all.y / once.y : 1.0f,
                       once.z > 0.0f ? all.z / once.z : 1.0f};

    // 3.
    own->kd = (opacity * (1.0f - metallic)) * (base * (splat(1.0f) - by_layer));
    // 5.
    const float mirrors = facets_mirrored_share(roughness), shown = sight.followed ? mirrors : 0.0f;
    own->mirrored = (opacity * shown) * all;
    own->all = own->kd + (opacity * (1.0f - shown)) * all;
    own->ka = own->all;

    // 4.
    const float width = fmaxf(roughness * roughness, MIN_FACET_WIDTH), seen = 0.25f * sight.spread;
    own->square = width * width;
    own->seen_square = own->square + seen * seen;
    own->shown = shown;
    own->boxed = sight.mirrored ? mirrors : shown;
    const float lights = sight.followed ? 1.0f - (float)facets_faded(roughness) / (float)PARTS_OF_FADE : 0.0f;
    own->unmirrored = 1.0f - lights;
    own->ks = front;
    own->grazing = end;
    own->gain = opacity * gain;
    own->cosine = cosine;
}

// Pi f for light from a direction, where half of the part of the light that it stands for is `part` wide: an angle.
DEVICE Vec3 facets_toward(const Material &own, Vec3 normal, Vec3 view, Vec3 direction, float part) {
    const Vec3 sum = direction + view;
    const float size = length(sum);
    if (size == 0.0f)
        return splat(0.0f);
    const Vec3 half = sum / size;
    const float facing = dot(normal, half), light = dot(normal, direction);
    // 4.
    const float wide = own.seen_square + 0.25f * (part * part);
    const Vec3 aside = cross(normal, half);
    const float x = wide * (facing * facing) + dot(aside, aside);
    const float rest = 1.0f - own.square;
    const float seen = light * sqrtf(own.cosine * own.cosine * rest + own.square);
    const float lit = own.cosine * sqrtf(light * light * rest + own.square);
    const float away = fmaxf(1.0f - dot(view, half), 0.0f);
    const float square = away * away;
    const Vec3 fresnel = between(own.ks, splat(own.grazing), square * square * away);
    return (wide / (x * x) * 0.5f / (seen + lit)) * (fresnel * own.gain);
}

// The cosine and the sine of a share of a full turn.
struct Turned {
    float cosine, sine;
};

DEVICE Turned facets_around(float turn) {
    // An eighth of a turn to either side, by the series of the sine.
    const float quarters = 4.0f * turn;
    const unsigned quarter = min((unsigned)quarters, 3u);
    const float angle = (quarters - (float)quarter - 0.5f) * FRAC_PI_2;
    const float square = angle * angle;
    const float sine = angle * (1.0f - square * (1.0f / 6.0f) * (1.0f - square * (1.0f / 20.0f)));
    const float cosine = sqrtf(1.0f - sine * sine);
    if (quarter == 0)
        return Turned{cosine, sine};
    if (quarter == 1)
        return Turned{-sine, cosine};
    return quarter == 2 ? Turned{-cosine, -sine} : Turned{sine, -cosine};
}

// What the other side's facets leave of light: one of its factors.
DEVICE float facets_shadowing(float own, float cosine) { return sqrtf(cosine * cosine * (1.0f - own) + own); }

// A direction in which facets reflect the view, and the share of the radiance there that the eye sees.
struct Drawn {
    Vec3 direction, share;
};

// 6. The direction in which the facets that `u` and `v` in [0, 1) select reflect the view; a share of zero where they reflect it into the surface.
COLD Drawn facets_drawn(const Material &own, Vec3 normal, Vec3 view, float u, float v) {
    // Along the surface to the eye, and across.
    const Vec3 slope = view - dot(normal, view) * normal;
    const float along_square = length_squared(slope);
    const Vec3 axis = fabsf(normal.x) < 0.5f ? Vec3{1.0f, 0.0f, 0.0f} : Vec3{0.0f, 1.0f, 0.0f};
    const Vec3 beside = cross(normal, axis);
    const Vec3 along = along_square > MIN_SMOOTH_SQUARE ? slope / sqrtf(along_square) : beside / length(beside);
    const Vec3 across = cross(normal, along);
    const float cosine = own.cosine, width = own.roughness * own.roughness;
    const float sine = sqrtf(fmaxf(1.0f - cosine * cosine, 0.0f));

    // The facet, where the surface is stretched to a ball.
    const float size = sqrtf(width * sine * (width * sine) + cosine * cosine);
    const float x = width * sine / size, z = cosine / size;
    const Turned turned = facets_around(u);
    const float height = (1.0f - v) * (1.0f + z) - z;
    const float ring = sqrtf(fmaxf(1.0f - height * height, 0.0f));
    const Vec3 unscaled = {width * (ring * turned.cosine + x), width * (ring * turned.sine), height + z};
    const Vec3 half = unscaled / length(unscaled);

    // The view, reflected.
    const float facing = sine * half.x + cosine * half.z;
    const Vec3 reflected = 2.0f * facing * half - Vec3{sine, 0.0f, cosine};
    const float light = reflected.z;
    if (!(light > 0.0f && facing > 0.0f))
        return Drawn{normal, splat(0.0f)};
    const Vec3 direction = reflected.x * along + reflected.y * across + light * normal;

    // What the other side's shadowing leaves, and Fresnel's equations.
    const float square = width * width;
    const float seen = light * facets_shadowing(square, cosine), lit = cosine * facets_shadowing(square, light);
    const float left = light * (cosine + facets_shadowing(square, cosine)) / (seen + lit);
    const float away = fmaxf(1.0f - facing, 0.0f);
    const float twice = away * away;
    const Vec3 fresnel = between(own.ks, splat(own.grazing), twice * twice * away);
    return Drawn{direction / length(direction), (own.shown * left) * (fresnel * own.gain)};
}

// In how many directions a mirror with facets reflects a ray, a power of two; the share `weight` of their radiance reaches the pixel.
DEVICE unsigned facets_directions(float weight, float roughness) {
    const float wide = fminf(roughness * roughness / WIDE_LOBE, 1.0f);
    const float wanted = (float)MAX_DIRECTIONS * wide * sqrtf(weight);
    unsigned count = 1;
    while (count < MAX_DIRECTIONS && (float)count < wanted)
        count *= 2;
    return count;
}

// The cone that a mirror with facets reflects in each of `count` directions, if a smooth one reflects `cone`.
DEVICE Cone facets_blurred(Cone cone, float roughness, unsigned count, float weight) {
    const float all = fminf(fmaxf((float)count / weight, 1.0f), MAX_CONES);
    return Cone{cone.width, fabsf(cone.spread) + WIDTH_OF_LOBE * (roughness * roughness) / sqrtf(all)};
}
