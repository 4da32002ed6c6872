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
};

// The share of what facets reflect that mirror rays show.
DEVICE float facets_mirrored_share(float roughness) {
    const float share = fminf(fmaxf((MIRROR_ENDS - roughness) / (MIRROR_ENDS - MIRROR_FADES), 0.0f), 1.0f);
    return share * share * (3.0f - 2.0f * share);
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
    const float cosine = fmaxf(sight.cosine, LEAST_VIEW_COSINE);
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
    const float shown = sight.followed ? facets_mirrored_share(roughness) : 0.0f;
    own->mirrored = (opacity * shown) * all;
    own->all = own->kd + (opacity * (1.0f - shown)) * all;
    own->ka = own->all;

    // 4.
    const float width = fmaxf(roughness * roughness, LEAST_FACET_WIDTH), seen = 0.25f * sight.spread;
    own->square = width * width;
    own->seen_square = own->square + seen * seen;
    own->unmirrored = 1.0f - shown;
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

// The cone that a mirror with facets reflects, if a smooth one reflects `cone`.
DEVICE Cone facets_blurred(Cone cone, float roughness) {
    return Cone{cone.width, fabsf(cone.spread) + WIDTH_OF_LOBE * (roughness * roughness)};
}
