// Formula (1) for one surface point: twin of mod.rs.
#pragma once

#include "sampling.cuh"
#include "shading/falloff.cuh"
#include "shading/ambient.cuh"
#include "shading/irradiance.cuh"
#include "shading/tint.cuh"
#include "surface.cuh"

// A surface point with what formula (1) needs.
struct Surface {
    SurfacePoint point;
    // The normal that shading uses, and the unit vector to the viewer.
    Vec3 normal, view;
    const Material *material;
    // Whether its mirror ray is followed.
    bool followed;
};

// Whether it has an image of normals.
DEVICE bool has_relief(const Surface &surface) { return surface.material->normal_texture != Material::NO_TEXTURE; }

// The surface point that ray number `ray` sees; `own` provides memory for its material.
DEVICE Surface surface_at(const Scene &scene, const Rays &rays, const Hit *hits, unsigned ray, Material &own) {
    const Hit hit = load_hit(hits, ray);
    const Ray seen_along = ray_at(rays, ray);
    const SurfacePoint point = surface_point(seen_along, hit, corners_at(scene.triangles, hit.triangle));
    const Material *material = material_at(scene, rays, ray, hit, own);
    Surface surface = {point, shading_normal(scene, hit, point.normal), -seen_along.direction, material, mirrors(rays, ray)};
    if (has_relief(surface)) {
        own.smooth = surface.normal;
        surface.normal = mapped_normal(tint_sources(scene), &own, sighting_of(rays, ray), hit, surface.normal);
    }
    return surface;
}

// Gives a surface with an image of normals their mean over the samples of its pixel that are shaded with it.
DEVICE void share_normal(const Scene &scene, const Rays &rays, unsigned ray, const Samples &samples, Surface &surface) {
    const SharedHits shared = shared_hits(rays, ray, samples);
    if (shared.shared != 0 && has_relief(surface))
        surface.normal = mean_normal(tint_sources(scene), surface.material, sighting_of(rays, ray), shared, surface.normal);
}

// The cosine of light along `direction`, by the image of normals if there is one.
DEVICE float softened(const Surface &surface, Vec3 direction, float cosine) {
    return has_relief(surface) ? softened(surface.material->smooth, direction, cosine) : cosine;
}

// The normal of mirrored and refracted rays.
DEVICE Vec3 mirroring(const Surface &surface) {
    return has_relief(surface) ? mirroring(surface.normal, surface.point.normal, surface.view) : surface.normal;
}

// The share of a light's strength along `direction`, from the surface to the light: a spot's, or that of an emissive surface.
DEVICE float cone(const Light &light, Vec3 direction) {
    if (light.surface)
        return larger(-dot(direction, light.direction), 0.0f);
    if (light.cone_scale == 0.0f)
        return 1.0f;
    const float linear = (-dot(direction, light.direction) - light.cos_outer) * light.cone_scale;
    const float clamped = fminf(fmaxf(linear, 0.0f), 1.0f);
    return clamped * clamped;
}

// Intensity of a light at `distance` along `direction` (from the surface to the light), falloff and cone included.
DEVICE Vec3 strength(const Light &light, Vec3 direction, float distance) {
    return falloff(light, distance) * cone(light, direction) * light.intensity;
}

// Light of a light that reaches the eye if all of it comes from `target`: one term of the sum without V.
DEVICE Vec3 reflected(const Surface &surface, const Light &light, Vec3 target) {
    const Vec3 to_light = target - surface.point.position;
    const float distance = length(to_light);
    if (distance == 0.0f)
        return splat(0.0f);
    const Vec3 direction = to_light / distance;
    const float cosine = dot(surface.normal, direction);
    if (cosine <= 0.0f)
        return splat(0.0f);
    const float soft = softened(surface, direction, cosine);
    Vec3 answer = soft * surface.material->kd;
    // What mirror rays see is no highlight, too.
    if (surface.material->ks != splat(0.0f) && !(light.seen && surface.followed)) {
        const Vec3 mirrored = 2.0f * cosine * surface.normal - direction;
        float highlight = powf(fmaxf(dot(mirrored, surface.view), 0.0f), surface.material->shininess);
        if (soft != cosine)
            highlight = soft / cosine * highlight;
        answer = answer + highlight * surface.material->ks;
    }
    return strength(light, direction, distance) * answer;
}

// The light of a light that arrives from `target`, times the cosine.
DEVICE Vec3 arriving_from(const Surface &surface, const Light &light, Vec3 target) {
    const Vec3 to_light = target - surface.point.position;
    const float distance = length(to_light);
    const float cosine = dot(surface.normal, to_light) / distance;
    if (!(cosine > 0.0f))
        return splat(0.0f);
    const Vec3 direction = to_light / distance;
    return softened(surface, direction, cosine) * strength(light, direction, distance);
}

// What a surface shows without lights if nothing else was there; `reflected` is the share of ambient light that it reflects, `emission` what it emits.
DEVICE Vec3 alone(const Scene &scene, const Surface &surface, Vec3 reflected, Vec3 emission) {
    return ambient_at(scene, surface.normal) * reflected + emission;
}

// The luminance of a colour.
DEVICE float luminance(Vec3 color) { return LUMINANCE_RED * color.x + LUMINANCE_GREEN * color.y + LUMINANCE_BLUE * color.z; }

// Where target number `number` of a light is seen from a surface: those of a directional light are seen from there, at distance 1.
DEVICE Vec3 place_of_target(const Surface &surface, const Scene &scene, unsigned index, unsigned number, float reach) {
    const Vec3 target = scene.light_targets[index * LIGHT_TARGETS + number];
    return scene.lights[index].kind == Light::DIRECTIONAL ? surface.point.origin + reach * target : target;
}

// The same of a surface with facets; half of the part of the light that the point stands for is `part` wide.
DEVICE Vec3 reflected_by_facets(const Surface &surface, const Light &light, Vec3 target, float part) {
    const Vec3 to_light = target - surface.point.position;
    const float distance = length(to_light);
    if (distance == 0.0f)
        return splat(0.0f);
    const Vec3 direction = to_light / distance;
    const float cosine = dot(surface.normal, direction);
    if (cosine <= 0.0f)
        return splat(0.0f);
    const Material &own = *surface.material;
    const bool painted = (light.seen & Light::PAINTED) != 0, boxed = (light.seen & Light::BOXED) != 0;
    const float share = !light.seen ? 1.0f : boxed ? 1.0f - own.boxed : painted ? 1.0f - own.shown : own.unmirrored;
    const Vec3 lobe = facets_toward(*surface.material, surface.normal, surface.view, direction, part / distance);
    const float soft = softened(surface, direction, cosine);
    return strength(light, direction, distance) * (soft * surface.material->kd + (soft * share) * lobe);
}

// The light of a light that arrives from `target`, times the cosine, without a cone or an image of normals.
DEVICE Vec3 arriving_plainly(const Surface &surface, const Light &light, Vec3 target) {
    const Vec3 to_light = target - surface.point.position;
    const float distance = length(to_light);
    const float cosine = dot(surface.normal, to_light) / distance;
    if (!(cosine > 0.0f))
        return splat(0.0f);
    const float emitted = light.surface ? cone(light, to_light / distance) : 1.0f;
    return cosine * emitted * falloff(light, distance) * light.intensity;
}

DEVICE float shaped(float arriving, float plain, float whole) { return plain > 0.0f ? whole * (arriving / plain) : whole; }

// By how much the irradiance of a light that is near or wide differs from what its points say. What the image of normals and a spot's cone change is
// known from the points. A function of its own, so that its callers keep their registers.
COLD Vec3 beyond_points(Surface surface, const Scene &scene, unsigned index, float reach, Vec3 way) {
    const Light &light = scene.lights[index];
    Vec3 arriving = splat(0.0f), plain = splat(0.0f);
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i) {
        const Vec3 place = place_of_target(surface, scene, index, i, reach);
        arriving = arriving + arriving_from(surface, light, place);
        plain = plain + arriving_plainly(surface, light, place);
    }
    Vec3 whole = irradiance(&light, way, surface.normal) * light.intensity;
    whole = Vec3{shaped(arriving.x, plain.x, whole.x), shaped(arriving.y, plain.y, whole.y), shaped(arriving.z, plain.z, whole.z)};
    return whole - arriving / (float)LIGHT_TARGETS;
}

// The same for the share of it that counts: none where the light is far.
DEVICE Vec3 of_whole(const Surface &surface, const Scene &scene, unsigned index, float reach) {
    const Light &light = scene.lights[index];
    const Vec3 way = light_center(light, surface.point.origin, reach) - surface.point.position;
    const float share = nearness(light, way);
    return share > 0.0f ? share * beyond_points(surface, scene, index, reach, way) : splat(0.0f);
}

// Unshadowed light of light number `index` on a surface with facets. A function of its own, so that others keep their registers.
COLD Vec3 unshadowed_by_facets(Surface surface, const Scene &scene, unsigned index, float reach) {
    const Light &light = scene.lights[index];
    const float part = PART_OF_LIGHT * (light.kind == Light::DIRECTIONAL ? reach * light.size : light.size);
    if (!has_size(light))
        return reflected_by_facets(surface, light, light_center(light, surface.point.origin, reach), part);
    Vec3 sum = splat(0.0f);
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i)
        sum = sum + reflected_by_facets(surface, light, place_of_target(surface, scene, index, i, reach), part);
    return sum / (float)LIGHT_TARGETS + of_whole(surface, scene, index, reach) * surface.material->kd;
}

// Unshadowed light of light number `index`.
DEVICE Vec3 unshadowed(const Surface &surface, const Scene &scene, unsigned index, float reach) {
    const Light &light = scene.lights[index];
    if (surface.material->facets)
        return unshadowed_by_facets(surface, scene, index, reach);
    if (!has_size(light))
        return reflected(surface, light, light_center(light, surface.point.origin, reach));
    Vec3 sum = splat(0.0f);
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i)
        sum = sum + reflected(surface, light, place_of_target(surface, scene, index, i, reach));
    return sum / (float)LIGHT_TARGETS + of_whole(surface, scene, index, reach) * surface.material->kd;
}

// The share of light number `index` above the horizon; 1 of a light without an area, and where there is none. Each target stands for a strip.
DEVICE float above_horizon_of_targets(const Surface &surface, const Scene &scene, unsigned index, float reach) {
    if (!has_size(scene.lights[index]))
        return 1.0f;
    // That of the surface, whatever its relief.
    const Vec3 normal = has_relief(surface) ? surface.material->smooth : surface.normal;
    float least = INFINITE, most = -INFINITE;
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i) {
        const float height = dot(normal, place_of_target(surface, scene, index, i, reach) - surface.point.position);
        least = fminf(least, height);
        most = fmaxf(most, height);
    }
    if (least >= 0.0f || most <= 0.0f)
        return 1.0f;
    const float strip = (most - least) * STRIP_OF_TARGET;
    float sum = 0.0f;
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i) {
        const float height = dot(normal, place_of_target(surface, scene, index, i, reach) - surface.point.position);
        sum += fminf(fmaxf(0.5f + height / strip, 0.0f), 1.0f);
    }
    return sum / (float)LIGHT_TARGETS;
}

// The light of light number `index` that reaches the eye if `seen` is the share of the light that arrives. What is below the horizon is no part of
// that share, nor of the unshadowed light, and must not be taken away twice. Near a light whose samples were `weighed`, it is the share of what is
// above the horizon.
DEVICE Vec3 shown(const Surface &surface, const Scene &scene, unsigned index, float reach, Vec3 seen, bool weighed) {
    // Of lights without light, such as the suns whose hours are counted, only what sees them matters.
    const Vec3 intensity = scene.lights[index].intensity;
    if (intensity.x == 0.0f && intensity.y == 0.0f && intensity.z == 0.0f)
        return splat(0.0f);
    const Light &light = scene.lights[index];
    const Vec3 way = light_center(light, surface.point.origin, reach) - surface.point.position;
    if (weighed && has_size(light) && nearness(light, way) > 0.0f)
        return seen * unshadowed(surface, scene, index, reach);
    const Vec3 share = min(seen / above_horizon_of_targets(surface, scene, index, reach), splat(1.0f));
    return share * unshadowed(surface, scene, index, reach);
}

// The light of light number `index` that arrives, times the cosine, if nothing is in the way; what arrives from `to` if a part of the light is
// below the horizon.
DEVICE Vec3 arriving(const Surface &surface, const Scene &scene, unsigned index, float reach, Vec3 to) {
    const Light &light = scene.lights[index];
    if (!has_size(light))
        return arriving_from(surface, light, light_center(light, surface.point.origin, reach));
    Vec3 sum = splat(0.0f);
    for (unsigned i = 0; i < LIGHT_TARGETS; ++i) {
        const Vec3 place = place_of_target(surface, scene, index, i, reach);
        if (dot(surface.point.normal, place - surface.point.origin) <= 0.0f)
            return arriving_from(surface, light, to);
        sum = sum + arriving_from(surface, light, place);
    }
    return sum / (float)LIGHT_TARGETS + of_whole(surface, scene, index, reach);
}

DEVICE Vec3 mirrored_about(Vec3 normal, Vec3 view) { return 2.0f * dot(normal, view) * normal - view; }

// The reflection direction of the view.
DEVICE Vec3 mirrored(const Surface &surface) {
    const Vec3 direction = mirrored_about(mirroring(surface), surface.view);
    return dot(direction, surface.point.normal) > 0.0f ? direction : mirrored_about(surface.point.normal, surface.view);
}

// A direction in which its facets reflect the view; a smooth normal may reflect into the surface, then the direction is reflected there.
DEVICE Drawn drawn(const Surface &surface, float u, float v) {
    Drawn drawn = facets_drawn(*surface.material, mirroring(surface), surface.view, u, v);
    const float height = dot(drawn.direction, surface.point.normal);
    if (height < 0.0f)
        drawn.direction = drawn.direction - 2.0f * height * surface.point.normal;
    return drawn;
}

// The ray that goes on through the surface: straight on from the other side, bent by a body, or reflected where the body reflects everything.
DEVICE Ray onward(const Surface &surface) {
    const SurfacePoint &point = surface.point;
    const float eta = surface.material->eta;
    Vec3 bent = -surface.view;
    if (eta != 0.0f) {
        bool goes = refracted(-surface.view, mirroring(surface), eta, bent);
        if (goes && !(dot(bent, point.normal) < 0.0f))
            goes = refracted(-surface.view, point.normal, eta, bent);
        if (!goes)
            return Ray{point.origin, normalize(mirrored(surface)), INFINITE};
    }
    return Ray{behind(point), bent, INFINITE};
}
