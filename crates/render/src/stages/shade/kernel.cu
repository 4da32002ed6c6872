// Formula (1) on a CUDA device: twin of cpu.rs, one thread per ray.
#include "cuda/prelude.cuh"

#include "shading/shading.cuh"

// The share of a light for a ray.
DEVICE float share_of(const Shade &args, unsigned light, unsigned ray) {
    return __ldg(args.share + (unsigned long long)light * args.rays.count + ray);
}

// Whether a ray gets anything from the lights of this group.
DEVICE bool sees_any(const Shade &args, unsigned ray) {
    for (unsigned light = args.first_light; light < args.end_light; ++light)
        if (share_of(args, light, ray) > 0.0f)
            return true;
    return false;
}

// Formula (1) without its last term: the terms of a group of lights are added to those before.
DEVICE Vec3 add_group(const Shade &args, unsigned ray, const Surface &surface, Vec3 radiance) {
    if (args.first_light == 0)
        radiance = args.scene.ambient * surface.material->ka + surface.material->emission;
    const float reach = scene_reach(args.scene, surface.point.origin);
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        const float share = share_of(args, light, ray);
        if (share > 0.0f)
            radiance = radiance + share * unshadowed(surface, args.scene, light, reach);
    }
    return radiance;
}

// Stores what a pixel sees. The layers of a pixel that sees nothing stay as they are.
DEVICE void fill_layers(const Shade &args, unsigned ray, const Surface &surface, unsigned long long place) {
    args.depth[place] = load_hit(args.hits, ray).t;
    args.normal[place] = surface.point.normal;
    args.position[place] = surface.point.position;
    args.light_points[place] = args.used != nullptr ? args.used[ray] : 0;
    for (unsigned light = args.first_light; light < args.end_light; ++light)
        args.visibility[light * args.film_pixels + place] = share_of(args, light, ray);
}

KERNEL(shade, Shade, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray))
        return;
    const unsigned long long place = pixel_of(args.rays, ray) - args.film_pixel;
    // Without a place of its own, the sum of a ray is its pixel's until it is complete.
    const bool first = args.first_light == 0, last = args.end_light == args.scene.light_count;
    Vec3 &sum = args.sums != nullptr ? args.sums[ray] : args.color[place];
    Vec3 radiance = first ? args.scene.background : sum;
    if (load_hit(args.hits, ray).triangle != Hit::NONE && (first || args.depth != nullptr || sees_any(args, ray))) {
        Material own;
        const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
        radiance = add_group(args, ray, surface, radiance);
        if (args.depth != nullptr)
            fill_layers(args, ray, surface, place);
    }
    if (!last) {
        sum = radiance;
        return;
    }
    const Vec3 before = first || args.sums != nullptr ? args.color[place] : Vec3{};
    args.color[place] = before + weight_of(args.rays, ray) * radiance;
}
