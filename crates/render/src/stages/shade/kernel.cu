// Formula (1) on a CUDA device: twin of cpu.rs, one thread per ray.
#include "cuda/prelude.cuh"

#include "cuda/warp.cuh"
#include "shading/environment.cuh"
#include "shading/ids.cuh"
#include "shading/seen_lights.cuh"
#include "shading/shading.cuh"

// The share of a light for a ray.
DEVICE float share_of(const Shade &args, unsigned light, unsigned ray) {
    return __ldg(args.share + (unsigned long long)light * args.rays.count + ray);
}

// What is left of a light for a ray.
DEVICE Vec3 color_of(const Shade &args, unsigned light, unsigned ray) {
    if (args.passed == nullptr)
        return splat(share_of(args, light, ray));
    return args.passed[(unsigned long long)light * args.rays.count + ray];
}

// The root of the number of samples that are shaded with a ray.
DEVICE float root_of_samples(const Shade &args, unsigned ray) {
    unsigned samples = 1;
    if (args.rays.list != nullptr)
        samples = max(__popc(__ldg(&args.rays.list[ray].shared)), 1);
    else if (args.rays.list == nullptr && args.samples != nullptr)
        samples = args.sample_count;
    return sqrtf((float)samples);
}

// The angle of the cone around a ray; of those of all samples that are shaded with it, if there are several.
DEVICE float spread_of(const Shade &args, unsigned ray) { return fabsf(cone_of(args.rays, ray).spread) * root_of_samples(args, ray); }

// What is in front of what a ray sees.
DEVICE InFront in_front(const Shade &args, unsigned ray) {
    return in_front(args.scene, args.rays, args.hits, ray, root_of_samples(args, ray));
}

// The mean of three channels.
DEVICE float mean(Vec3 color) { return (color.x + color.y + color.z) / 3.0f; }

// The share of a ray's radiance that reaches its pixel. What is behind everything is seen on shadow catchers, and by rays that went through all
// surfaces: where the image keeps how much of it there is, for it to be taken out again, filters do not colour it, unless a light is in front.
DEVICE Vec3 weight_in_film(const Shade &args, unsigned ray) {
    const Vec3 weight = weight_of(args.rays, ray);
    if (args.caught == nullptr || throughs_of(args.rays, ray) == 0 || is_mirrored(args.rays, ray))
        return weight;
    const unsigned triangle = load_hit(args.hits, ray).triangle;
    const bool sees = triangle != Hit::NONE;
    const bool catches = sees && args.scene.materials[material_index(args.scene, triangle)].catcher;
    return (!sees || catches) && in_front(args, ray).left == 1.0f ? splat(mean(weight)) : weight;
}

// What a ray that hits nothing sees: the background or the environment.
DEVICE Vec3 missed(const Shade &args, unsigned ray) {
    const Environment &environment = args.scene.environment;
    if (environment.levels == nullptr || (environment.hidden && !is_mirrored(args.rays, ray)))
        return args.scene.background;
    return environment_radiance(&environment, ray_at(args.rays, ray).direction, spread_of(args, ray), lights_share(args.rays, ray));
}

// Whether a ray gets anything from the lights of this group.
DEVICE bool sees_any(const Shade &args, unsigned ray) {
    for (unsigned light = args.first_light; light < args.end_light; ++light)
        if (share_of(args, light, ray) > 0.0f)
            return true;
    return false;
}

// What a surface shows without lights: ambient, or gathered, and emitted light.
DEVICE Vec3 unlit(const Shade &args, unsigned ray, const Surface &surface) {
    // Highlights show the rest of the light that stands for what it emits.
    const float shown = lights_share(args.rays, ray);
    Vec3 emission = surface.material->emission;
    if (surface.material->lamp && shown < 1.0f)
        emission = shown * emission;
    if (args.gathered == nullptr)
        return alone(args.scene, surface, surface.material->ka, emission);
    const float *gathered = &args.gathered[ray].x;
    return Vec3{__ldg(gathered), __ldg(gathered + 1), __ldg(gathered + 2)} * surface.material->all + emission;
}

// Formula (1) without its last term: the terms of a group of lights are added to those before.
DEVICE Vec3 add_group(const Shade &args, unsigned ray, const Surface &surface, Vec3 radiance) {
    if (args.first_light == 0)
        radiance = unlit(args, ray, surface);
    const float reach = scene_reach(args.scene, surface.point.origin);
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        if (share_of(args, light, ray) > 0.0f)
            radiance = radiance + shown(surface, args.scene, light, reach, color_of(args, light, ray), args.weighed);
    }
    return radiance;
}

// Stores what a pixel sees. The layers of a pixel that sees nothing stay as they are.
DEVICE void fill_layers(const Shade &args, unsigned ray, const Surface &surface, unsigned long long place) {
    // With several samples, these are the nearest one's.
    if (args.depth != nullptr) {
        args.depth[place] = load_hit(args.hits, ray).t;
        args.normal[place] = surface.point.normal;
        args.position[place] = surface.point.position;
        if (args.ids != nullptr) {
            const unsigned triangle = load_hit(args.hits, ray).triangle;
            args.ids[place] = object_of(args.scene, triangle);
            args.ids[args.film_pixels + place] = material_of(args.scene, triangle);
        }
    }
    args.light_points[place] = args.used != nullptr ? args.used[ray] : 0;
    for (unsigned light = args.first_light; light < args.end_light; ++light)
        args.visibility[light * args.film_pixels + place] = share_of(args, light, ray);
}

// What the samples of the camera's pixels see.
DEVICE Samples samples_of(const Shade &args) { return Samples{args.samples, args.first_sampled, args.sampled_pixels, args.sample_count}; }

// Gives a surface the mean colour of the samples of its pixel that are shaded with it.
DEVICE void share_tint(const Shade &args, unsigned ray, Material &own) {
    const SharedHits shared = shared_hits(args.rays, ray, samples_of(args));
    const Hit hit = load_hit(args.hits, ray);
    const Material *material = args.scene.materials + material_index(args.scene, hit.triangle);
    if (shared.shared != 0 && material->tinted)
        tint_by_all(tint_sources(args.scene), material, sighting_of(args.rays, ray), shared, hit, mirrors(args.rays, ray), &own);
}

// The light that a surface gets as a share of what it would get alone.
DEVICE float lit_share(const Shade &args, const Surface &surface, Vec3 lit) {
    const float reach = scene_reach(args.scene, surface.point.origin);
    // Where nothing surrounds the scene, there is nothing to gather.
    const Vec3 reflected = args.gathered == nullptr ? surface.material->ka : args.scene.environment.lights ? surface.material->all : splat(0.0f);
    Vec3 sum = alone(args.scene, surface, reflected, surface.material->emission);
    for (unsigned light = 0; light < args.scene.light_count; ++light)
        sum = sum + unshadowed(surface, args.scene, light, reach);
    const float alone = luminance(sum);
    return alone > 0.0f ? fminf(luminance(lit) / alone, 1.0f) : 1.0f;
}

// Shows what is behind a shadow catcher, as far as it gets light.
COLD Vec3 catch_shadow(const Shade &args, unsigned ray, unsigned long long place, const Surface &surface, Vec3 lit) {
    const float share = lit_share(args, surface, lit);
    const bool mirrored = is_mirrored(args.rays, ray);
    if (args.several && args.ray_caught != nullptr)
        args.ray_caught[ray] = mirrored ? 0.0f : share;
    else if (!args.several && args.caught != nullptr && !mirrored)
        args.caught[place] = share;
    return share * missed(args, ray);
}

// Puts the lights in front of what a ray sees: they leave a share of it, also of what is behind everything.
DEVICE Vec3 put_in_front(const Shade &args, unsigned ray, unsigned long long place, Vec3 radiance) {
    const InFront front = in_front(args, ray);
    if (!(front.left < 1.0f))
        return radiance;
    if (args.several && args.ray_caught != nullptr)
        args.ray_caught[ray] *= front.left;
    else if (!args.several && args.caught != nullptr && !is_mirrored(args.rays, ray))
        args.caught[place] *= front.left;
    return front.left * radiance + front.radiance;
}

KERNEL(shade, Shade, BLOCK, 4) {
    unsigned ray;
    if (!ray_of_thread(args.rays, args.first_block + blockIdx.x, threadIdx.x, ray))
        return;
    const unsigned long long place = pixel_of(args.rays, ray) - args.film_pixel;
    // Without a place of its own, the sum of a ray is its pixel's until it is complete.
    const bool first = args.first_light == 0, last = args.end_light == args.scene.light_count;
    const bool fills = args.visibility != nullptr && !args.several;
    Vec3 &sum = args.sums != nullptr ? args.sums[ray] : args.color[place];
    const bool sees = load_hit(args.hits, ray).triangle != Hit::NONE;
    Vec3 radiance = first ? sees ? Vec3{} : missed(args, ray) : sum;
    // What is behind everything is seen on shadow catchers, and by rays that went through all surfaces.
    if (last && args.several && args.ray_caught != nullptr)
        args.ray_caught[ray] = !sees && throughs_of(args.rays, ray) > 0 && !is_mirrored(args.rays, ray) ? 1.0f : 0.0f;
    if (sees && (first || fills || (last && args.catches) || sees_any(args, ray))) {
        Material own;
        Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
        if (args.samples != nullptr) {
            share_tint(args, ray, own);
            share_normal(args.scene, args.rays, ray, samples_of(args), surface);
        }
        radiance = add_group(args, ray, surface, radiance);
        if (last && args.catches && surface.material->catcher)
            radiance = catch_shadow(args, ray, place, surface, radiance);
        if (fills)
            fill_layers(args, ray, surface, place);
    }
    if (last && args.scene.seen_lights)
        radiance = put_in_front(args, ray, place, radiance);
    if (!last || args.several) {
        sum = radiance;
        return;
    }
    // For its light group.
    if (args.sums != nullptr)
        sum = radiance;
    const Vec3 before = first || args.sums != nullptr ? args.color[place] : Vec3{};
    args.color[place] = before + weight_of(args.rays, ray) * radiance;
}

// The ray of a thread and its pixel; false unless it is the pixel's first one.
DEVICE bool first_of_pixel(const Shade &args, unsigned &ray, unsigned &pixel) {
    const unsigned long long number = (args.first_block + blockIdx.x) * BLOCK + threadIdx.x;
    if (number >= args.rays.count)
        return false;
    ray = (unsigned)number;
    pixel = pixel_of(args.rays, ray);
    return ray == 0 || pixel_of(args.rays, ray - 1) != pixel;
}

// Adds the sums of the rays of a pixel, which follow each other in their list, in their order: the first one's thread adds all. What
// fragments see is added to layers.
KERNEL(add_rays, Shade, BLOCK, 4) {
    unsigned ray, pixel;
    if (!first_of_pixel(args, ray, pixel))
        return;
    const unsigned long long place = pixel - args.film_pixel;
    const bool last = args.end_light == args.scene.light_count;
    for (unsigned next = ray; next < args.rays.count && pixel_of(args.rays, next) == pixel; ++next) {
        const Vec3 weight = weight_in_film(args, next);
        if (last)
            args.color[place] = args.color[place] + weight * args.sums[next];
        if (last && args.caught != nullptr)
            args.caught[place] += mean(weight_of(args.rays, next)) * args.ray_caught[next];
        if (args.visibility == nullptr || load_hit(args.hits, next).triangle == Hit::NONE)
            continue;
        if (args.used != nullptr)
            args.light_points[place] = max(args.light_points[place], args.used[next]);
        for (unsigned light = args.first_light; light < args.end_light; ++light)
            args.visibility[light * args.film_pixels + place] += weight.x * share_of(args, light, next);
    }
}

// Adds to a plane of light groups: that of a light, or after them what belongs to none.
DEVICE void add_to_group(const Shade &args, unsigned group, unsigned long long place, Vec3 radiance) {
    Vec3 &sum = args.light_groups[group * args.film_pixels + place];
    sum = sum + radiance;
}

// Adds what a ray sees of each light of this group in front of all else.
DEVICE void add_in_front(const Shade &args, unsigned ray, unsigned long long place) {
    if (!args.scene.seen_lights)
        return;
    const Vec3 weight = weight_in_film(args, ray);
    const Beam beam = beam_of(args.rays, args.hits, ray, root_of_samples(args, ray));
    LightsInFront walk = in_front_of_all();
    unsigned light;
    Vec3 radiance;
    while (next_in_front(args.scene, beam, walk, light, radiance))
        if (light >= args.first_light && light < args.end_light)
            add_to_group(args, light, place, weight * radiance);
}

// Adds what a ray gets from each light of this group by itself, and what belongs to no light.
DEVICE void add_by_light(const Shade &args, unsigned ray, unsigned long long place) {
    const unsigned rest = args.scene.light_count;
    const bool first = args.first_light == 0, last = args.end_light == args.scene.light_count;
    const Vec3 weight = weight_in_film(args, ray);
    const float left = in_front(args, ray).left;
    if (load_hit(args.hits, ray).triangle == Hit::NONE) {
        if (first)
            add_to_group(args, rest, place, weight * (left * missed(args, ray)));
        add_in_front(args, ray, place);
        return;
    }
    Material own;
    Surface surface = surface_at(args.scene, args.rays, args.hits, ray, own);
    if (args.samples != nullptr) {
        share_tint(args, ray, own);
        share_normal(args.scene, args.rays, ray, samples_of(args), surface);
    }
    // A shadow catcher shows what is behind it; its sum also has what is in front of it.
    if (args.catches && surface.material->catcher) {
        if (last)
            add_to_group(args, rest, place, weight * args.sums[ray]);
        return;
    }
    if (first)
        add_to_group(args, rest, place, weight * (left * unlit(args, ray, surface)));
    const float reach = scene_reach(args.scene, surface.point.origin);
    for (unsigned light = args.first_light; light < args.end_light; ++light) {
        if (share_of(args, light, ray) > 0.0f)
            add_to_group(args, light, place, weight * (left * shown(surface, args.scene, light, reach, color_of(args, light, ray), args.weighed)));
    }
    add_in_front(args, ray, place);
}

// The radiance of each light by itself: rays of a pixel in their order, as above.
KERNEL(add_light_groups, Shade, BLOCK, 4) {
    unsigned ray, pixel;
    if (!first_of_pixel(args, ray, pixel))
        return;
    for (unsigned next = ray; next < args.rays.count && pixel_of(args.rays, next) == pixel; ++next)
        add_by_light(args, next, pixel - args.film_pixel);
}
