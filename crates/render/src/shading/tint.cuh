// Textures, vertex colours and opacities, which give the coefficients of formula (1) at a surface point: twin of tint.rs.
#pragma once

#include "shading/dielectric.cuh"
#include "shading/facets.cuh"
#include "shading/normal_map.cuh"

// The value at `hit` of an image of what is emitted, or of facets: few materials have one, which is not worth registers everywhere.
COLD Vec3 rare_texel_at(TintSources sources, unsigned number, Sighting from, Hit hit) { return texel_at(sources, number, from, hit); }

// The values of images at a surface point.
struct Colors {
    // The product of texture and vertex colour, the texture of what is emitted, and that of how rough (y) and metallic (z) facets are.
    Vec3 tint, glow, facets;
};

// The product of texture and vertex colour at `hit`.
DEVICE Vec3 tint_at(const TintSources &sources, const Material &material, const Sighting &from, const Hit &hit) {
    const unsigned *vertices = vertices_at(sources, hit);
    Vec3 tint = splat(1.0f);
    if (material.texture != Material::NO_TEXTURE)
        tint = texel_at(sources, material.texture, from, hit);
    if (sources.colors == nullptr)
        return tint;
    const Vec3 a = sources.colors[vertices[0]], b = sources.colors[vertices[1]], c = sources.colors[vertices[2]];
    return tint * ((1.0f - hit.u - hit.v) * a + hit.u * b + hit.v * c);
}

DEVICE Colors colors_at(const TintSources &sources, const Material &material, const Sighting &from, const Hit &hit) {
    Colors colors = {tint_at(sources, material, from, hit), splat(1.0f), splat(1.0f)};
    if (material.emission_texture != Material::NO_TEXTURE)
        colors.glow = rare_texel_at(sources, material.emission_texture, from, hit);
    if (material.metallic_roughness_texture != Material::NO_TEXTURE)
        colors.facets = rare_texel_at(sources, material.metallic_roughness_texture, from, hit);
    return colors;
}

// How opaque a surface of this material is at `hit`.
DEVICE float opacity_at(const TintSources &sources, const Material &material, const Hit &hit) {
    return material.blends ? opacity_at(sources.alpha_mask, stored_triangle(sources.triangles, hit.triangle), hit.u, hit.v) : 1.0f;
}

// Sets `own` to the material with the coefficients that colours and an opacity give it.
DEVICE void set_tint(const Material *material, const Colors &colors, float opacity, Material *own) {
    const Vec3 &tint = colors.tint;
    // Of facets, these are what they are made of.
    const float there = material->facets ? 1.0f : opacity;
    own->ka = there * (material->ka * tint);
    own->kd = there * (material->kd * tint);
    own->ks = there * (material->ks + material->ks_tinted * tint);
    own->all = own->kd;
    own->mirrored = own->ks;
    own->facets = material->facets;
    own->opacity = opacity;
    own->roughness = material->roughness * colors.facets.y;
    own->metallic = material->metallic * colors.facets.z;
    own->grazing = material->grazing;
    own->emission = opacity * (material->emission * colors.glow + material->emission_tinted * tint);
    own->transmittance = (1.0f - opacity) * material->transmittance;
    own->blends = material->blends;
    own->eta = 0.0f;
    own->shininess = material->shininess;
    own->catcher = material->catcher;
    own->lamp = material->lamp;
    own->number = material->number;
    own->normal_texture = material->normal_texture;
    own->normal_scale = material->normal_scale;
}

// Changes the coefficients where a dielectric begins or ends.
DEVICE void set_boundary(const Boundary &met, Material *own) {
    const float mirrored = mirrored_share(met);
    own->ka = met.left * own->ka;
    own->kd = met.left * own->kd;
    own->ks = mirrored * met.left;
    own->all = own->kd;
    own->mirrored = own->ks;
    own->emission = met.left * own->emission;
    own->transmittance = (1.0f - mirrored) * met.left * own->transmittance;
    own->eta = met.thin ? 0.0f : met.eta;
}

// Turns the coefficients of a material with facets into what these make of them at `hit`; `followed` says whether its mirror ray is.
DEVICE void face(const TintSources &sources, const Sighting &from, const Hit &hit, bool followed, Material *own) {
    const Corners corners = corners_at(sources.triangles, hit.triangle);
    const SurfacePoint point = surface_point(Ray{from.origin, from.direction, INFINITE}, hit, corners);
    Vec3 normal = shading_normal(sources.triangles, sources.normals, sources.indices, hit, point.normal);
    if (own->normal_texture != Material::NO_TEXTURE)
        normal = mapped_normal(sources, own, from, hit, normal);
    const Cone cone = cone_after(from.cone, hit.t);
    const float turn = is_point(cone) ? 0.0f : curvature(sources.triangles, sources.normals, sources.indices, hit, corners, point.normal);
    const float spread = is_point(cone) ? 0.0f : fabsf(cone_reflected(cone, turn).spread);
    set_facets(sources.facet_table, FacetSight{dot(normal, -from.direction), spread, followed, from.mirrored}, own);
}

// Sets `own` to the material with its coefficients at `hit`.
COLD void tint_material(TintSources sources, const Material *material, Sighting from, Hit hit, bool followed, Material *own) {
    set_tint(material, colors_at(sources, *material, from, hit), opacity_at(sources, *material, hit), own);
    if (material->ior != 0.0f) {
        const Ray ray = {from.origin, from.direction, INFINITE};
        const Corners corners = corners_at(sources.triangles, hit.triangle);
        const Vec3 facing = surface_point(ray, hit, corners).normal;
        Vec3 normal = shading_normal(sources.triangles, sources.normals, sources.indices, hit, facing);
        if (material->normal_texture != Material::NO_TEXTURE)
            normal = mirroring(mapped_normal(sources, material, from, hit, normal), facing, -from.direction);
        set_boundary(boundary_about(normal, corners, *material, ray, hit), own);
    }
    if (material->facets)
        face(sources, from, hit, followed, own);
}

// Sets `own` to the material with the mean of its coefficients at these hits, seen at `center`; leaves it without any.
COLD void tint_by_all(TintSources sources, const Material *material, Sighting from, SharedHits all, Hit center, bool followed,
                      Material *own) {
    Colors sum = {splat(0.0f), splat(0.0f), splat(0.0f)};
    float opacities = 0.0f, count = 0.0f;
    for (unsigned sample = 0; sample < all.count; ++sample) {
        const Hit hit = load_hit(all.hits + sample * all.stride, 0);
        if ((all.shared >> sample & 1) == 0 || hit.triangle == Hit::NONE)
            continue;
        const Colors colors = colors_at(sources, *material, from, hit);
        sum = Colors{sum.tint + colors.tint, sum.glow + colors.glow, sum.facets + colors.facets};
        opacities += opacity_at(sources, *material, hit);
        count += 1.0f;
    }
    if (count == 0.0f)
        return;
    set_tint(material, Colors{sum.tint / count, sum.glow / count, sum.facets / count}, opacities / count, own);
    if (material->facets)
        face(sources, from, center, followed, own);
}

// Whether the mirror ray of what a ray sees is followed.
DEVICE bool mirrors(const Rays &rays, unsigned ray) { return rays.depth - throughs_of(rays, ray) < rays.bounces; }

// The material at `hit`: that of its triangle, or `own` if it has a tint. So a material without one takes no registers for
// coefficients.
DEVICE const Material *material_at(const Scene &scene, const Rays &rays, unsigned ray, const Hit &hit, Material &own) {
    const Material *material = scene.materials + material_index(scene, hit.triangle);
    if (!material->tinted)
        return material;
    tint_material(tint_sources(scene), material, sighting_of(rays, ray), hit, mirrors(rays, ray), &own);
    return &own;
}
