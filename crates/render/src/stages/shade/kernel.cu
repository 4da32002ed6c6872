// Formula (1) on a CUDA device: twin of cpu.rs, one thread per ray.
#include "cuda/prelude.cuh"

#include "shading/shading.cuh"

// Formula (1) without its last term.
DEVICE Vec3 surface_radiance(const Shade &args, unsigned ray, const Surface &surface) {
    Vec3 radiance = args.scene.ambient * surface.material->ka + surface.material->emission;
    const float reach = scene_reach(args.scene, surface.point.origin);
    for (unsigned light = 0; light < args.scene.light_count; ++light) {
        const float share = __ldg(args.share + (unsigned long long)light * args.rays.count + ray);
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
    for (unsigned light = 0; light < args.scene.light_count; ++light)
        args.visibility[light * args.film_pixels + place] = args.share[(unsigned long long)light * args.rays.count + ray];
}

KERNEL(shade, Shade, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray))
        return;
    const unsigned long long place = pixel_of(args.rays, ray) - args.film_pixel;
    Vec3 radiance = args.scene.background;
    if (load_hit(args.hits, ray).triangle != Hit::NONE) {
        Material own;
        const Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
        radiance = surface_radiance(args, ray, surface);
        if (args.depth != nullptr)
            fill_layers(args, ray, surface, place);
    }
    args.color[place] = args.color[place] + weight_of(args.rays, ray) * radiance;
}
