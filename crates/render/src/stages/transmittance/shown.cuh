// Whether it can be seen what transmissive surfaces leave of a light: twin of shown.rs.
#pragma once

#include "shading/falloff.cuh"
#include "shadow/projected_light.cuh"

// Whether highlights are all that surfaces of this material show of lights.
DEVICE bool has_mere_highlights(const Material &material) {
    const bool is_plain = material.facets == 0 && material.normal_texture == Material::NO_TEXTURE && material.catcher == 0;
    return is_plain && material.kd == splat(0.0f) && material.shininess >= 1.0f;
}

// Whether what a ray sees at `point` may show that much of a light.
DEVICE bool may_show(const Transmittance &args, unsigned ray, const SurfacePoint &point, const Light &light) {
    const Scene &scene = args.shadows.scene;
    const Rays &rays = args.shadows.rays;
    if (rays.depth == 0)
        return true;
    const Hit hit = load_hit(args.shadows.hits, ray);
    const Material &material = scene.materials[material_index(scene, args.triangles, hit.triangle)];
    if (!has_mere_highlights(material))
        return true;
    // 1. The mirrored view, and the cone that the light is in.
    const Vec3 normal = shading_normal(args.triangles, args.normals, scene.indices, hit, point.normal);
    const Vec3 view = -ray_at(rays, ray).direction;
    const Vec3 mirrored = 2.0f * dot(normal, view) * normal - view;
    float radius;
    const Vec3 way = way_to(scene, light, point.origin, radius);

    // 2. The cosine between both, at most.
    const float square = length_squared(way), along = dot(mirrored, way), beyond = square - radius * radius;
    if (!(beyond > 0.0f && along < sqrtf(beyond)))
        return true;
    const float aside = sqrtf(fmaxf(square - along * along, 0.0f));
    const float cosine = (along * sqrtf(beyond) + radius * aside) / square;

    // 3. The highlight.
    float highlight = fminf(fmaxf(cosine, 0.0f), 1.0f);
    for (float power = 2.0f; power <= material.shininess; power *= 2.0f)
        highlight *= highlight;
    const float strength = falloff(light, sqrtf(square) - radius) * max_element(light.intensity);
    return max_element(weight_of(rays, ray)) * (highlight * strength) > MIN_SHOWN;
}
