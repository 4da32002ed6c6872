// The samples of a pixel, whether two of them lie on one surface, and whether it mirrors: twin of same_surface.rs, and of antialiasing.rs.
#pragma once

#include "data/rays.cuh"
#include "sampling.cuh"
#include "shading/facets.cuh"
#include "surface.cuh"

// The offset below which the share `u` of the filter lies, for `u` in [0, 1).
DEVICE float quantile(const PixelSamples &args, float u) {
    const float place = u * (float)FILTER_STEPS;
    const unsigned step = (unsigned)place;
    const float low = args.quantiles[step], high = args.quantiles[step + 1];
    return low + (place - (float)step) * (high - low);
}

// The ray through a sample of the pixel of ray number `ray`; `sample` is its number among those of the range.
DEVICE Ray sample_ray(const PixelSamples &args, unsigned ray, unsigned sample) {
    const unsigned pixel = args.rays.first_pixel + ray;
    const Pattern pattern = pattern_of(args.seed, number_in_image(args.rays.view, pixel), PIXEL_PATTERN);
    const Vec3 point = pattern_point(pattern, args.samples[0] + sample);
    return view_ray_beside(args.rays.view, pixel, quantile(args, point.x), quantile(args, point.y));
}

// What a sample sees.
DEVICE Hit sample_hit(const PixelSamples &args, unsigned ray, unsigned sample) {
    return load_hit(args.hits + (unsigned long long)sample * args.rays.count, ray);
}

// A piece of a surface, about as large as a pixel.
struct Facet {
    SurfacePoint point;
    // The normal that shading uses.
    Vec3 smooth;
    // The number of the material.
    unsigned material;
    // About how wide the pixel is there.
    float width;
};

// What a ray sees, where a pixel is about as wide as `width`.
DEVICE Facet facet_of(const Scene &scene, const Ray &ray, const Hit &hit, float width) {
    const SurfacePoint point = surface_point(ray, hit, corners_at(scene.triangles, hit.triangle));
    return Facet{point, shading_normal(scene, hit, point.normal), material_index(scene, hit.triangle), width};
}

// What a ray of a camera sees.
DEVICE Facet facet_of(const PixelSamples &args, const Ray &ray, const Hit &hit) {
    return facet_of(args.scene, ray, hit, args.spacing[0] + args.spacing[1] * hit.t);
}

// Whether both have the same material, and neither is farther from the other's tangent plane than `height` times the pixel's width.
DEVICE bool is_level(const Facet &a, const Facet &b, float height) {
    const Vec3 between = b.point.position - a.point.position;
    return a.material == b.material && fabsf(dot(a.point.normal, between)) <= height * a.width &&
           fabsf(dot(b.point.normal, between)) <= height * b.width;
}

// Whether both look about the same where a rough mirror blurs them.
DEVICE bool resembles(const Facet &a, const Facet &b) { return a.material == b.material && dot(a.smooth, b.smooth) >= NEAR_COSINE; }

// Whether two samples of a pixel may be shaded together.
DEVICE bool continues(const Facet &a, const Facet &b) {
    return dot(a.smooth, b.smooth) >= SAME_COSINE && dot(a.point.normal, b.point.normal) >= SAME_FACET_COSINE &&
           is_level(a, b, SAME_HEIGHT);
}

// Whether the surface of a neighbouring pixel may be compared.
DEVICE bool is_near(const Facet &a, const Facet &b) { return dot(a.smooth, b.smooth) >= NEAR_COSINE && is_level(a, b, NEAR_HEIGHT); }

DEVICE const Material &material_of_hit(const Scene &scene, const Hit &hit) {
    return scene.materials[material_index(scene, hit.triangle)];
}

// Whether the surface at `hit` lets rays through.
DEVICE bool is_transmissive(const Scene &scene, const Hit &hit) { return hit.triangle != Hit::NONE && material_of_hit(scene, hit).blends; }

// The largest share that the surface at `hit` may mirror.
DEVICE float most_mirrored(const Scene &scene, const Hit &hit) {
    const Material &material = material_of_hit(scene, hit);
    if (!material.facets)
        return max_element(material.ks + material.ks_tinted);
    // At grazing incidence, all. An image may make facets smooth anywhere.
    const bool varies = material.metallic_roughness_texture != Material::NO_TEXTURE;
    return varies || facets_mirrored_share(material.roughness) > 0.0f ? 1.0f : 0.0f;
}

// The mirror rays of how many of `count` samples on the surface at `hit` are followed.
DEVICE unsigned mirrored_samples(const PixelSamples &args, const Hit &hit, unsigned count) {
    const float most = args.mirrors && hit.triangle != Hit::NONE ? most_mirrored(args.scene, hit) : 0.0f;
    return most == 0.0f ? 0 : most <= FAINT_MIRROR ? (count + 1) / 2 : count;
}
