// Transmittance on a CUDA device: twin of cpu.rs, one thread per surface point. Whatever lets light through has entries among the triangles
// that are cut out.
#define ALPHA_TEST 1
#include "cuda/prelude.cuh"

#include "accel/nearest.cuh"
#include "data/rays.cuh"
#include "shading/dielectric.cuh"
#include "shadow/seen.cuh"
#include "shadow/shadow.cuh"
#include "shadow/terminator.cuh"
#include "stages/transmittance/shown.cuh"

// The structure of this type in a scene.
DEVICE const Bvh &structure_of(const Scene &scene, const Bvh &) { return scene.bvh; }
DEVICE const BruteForce &structure_of(const Scene &scene, const BruteForce &) { return scene.brute_force; }
DEVICE const InstancedBvh &structure_of(const Scene &scene, const InstancedBvh &) { return scene.instanced; }

// What a dielectric leaves of light. A function of its own, so that its callers keep their registers.
COLD Vec3 left_by_glass(Triangles triangles, const Vec3 *normals, const Indices *indices, const Material *material, Ray ray, Hit hit) {
    return left_straight_on(boundary_met(triangles, normals, indices, *material, ray, hit), *material);
}

// What is left of light that goes through a surface.
DEVICE Vec3 transmittance_at(const Transmittance &args, const Ray &ray, const Hit &hit) {
    const Scene &scene = args.shadows.scene;
    const Triangle *triangle = stored_triangle(args.triangles, hit.triangle);
    const Material &material = scene.materials[material_index(scene, args.triangles, hit.triangle)];
    const Vec3 through = (1.0f - opacity_at(scene.alpha_mask, triangle, hit.u, hit.v)) * material.transmittance;
    if (material.ior == 0.0f)
        return through;
    return left_by_glass(args.triangles, args.normals, scene.indices, &material, ray, hit) * through;
}

// Follows a ray through all surfaces that it meets: what is left of the light.
template <class Structure>
DEVICE Vec3 pass(const Transmittance &args, const Structure &transmissive, Vec3 from, Vec3 target) {
    const Ray ray = long_segment(from, target);
    Vec3 left = splat(1.0f);
    float last = 0.0f, next = 0.0f;
    unsigned met = 0;
    NearestHits hits;
    do {
        find_nearest(transmissive, args.shadows.tally, ray, next, hits);
        for (unsigned number = 0; number < hits.count && met < MAX_THROUGHS; ++number) {
            Hit hit = nearest_hit(hits, transmissive, number);
            const float t = hit.t;
            if (t <= next)
                continue;
            // Bodies absorb light from one surface to the next.
            hit.t = t - last;
            left = left * transmittance_at(args, ray, hit);
            next = t + gap_behind(ray, hit, corners_at(args.triangles, hit.triangle));
            last = t;
            ++met;
        }
    } while (hits.count == HITS_AT_ONCE && met < MAX_THROUGHS);
    return left;
}

// The level of what a ray sees: how small a share of what it shows reaches the pixel.
DEVICE unsigned level_of(const Transmittance &args, unsigned ray) {
    const Rays &rays = args.shadows.rays;
    if (rays.depth == 0 || args.middle)
        return 0;
    const float shown = max_element(splat(1.0f) - transmittance_at(args, ray_at(rays, ray), load_hit(args.shadows.hits, ray)));
    const float share = (float)args.parts * max_element(weight_of(rays, ray)) * shown;
    unsigned level = 0;
    for (float most = PART_OF_LEVEL; level + 1 < TRANSMITTANCE_LEVELS && share <= most; most *= PART_OF_LEVEL)
        ++level;
    return level;
}

// Calls `take` with each sample of a set.
template <class Take>
DEVICE void each_target(const Transmittance &args, const SurfacePoint &point, unsigned ray, Shape shape, Take take) {
    const Shadows &shadows = args.shadows;
    const Light &light = shadows.scene.lights[shadows.first_light];
    if (shape == SHAPE_POINT) {
        take(seen_center(light, point.origin, scene_reach(shadows.scene, point.origin)));
        return;
    }
    const SampleRows &set = shadows.sets[shape];
    const Sight projected =
        projected_light_of(shadows.scene, shadows.sampling, shadows.first_light, shape, set.lines, point,
                           ray_key(shadows.rays, ray));
    for (unsigned row = 0; row < set.rows; ++row)
        for (unsigned rest = valid_samples(projected, set, row); rest != 0; rest &= rest - 1)
            take(point.origin + sample_at(projected, set, row, __ffs(rest) - 1, light.scale));
}

// What is left of a light on the way to the samples of a set.
struct Followed {
    // What is lost of those that nothing opaque hides, and what is left of them.
    Vec3 lost, seen;
    // What is left of all above the horizon.
    Vec3 all;
    float seen_count, all_count;
};

template <class Structure>
DEVICE Followed follow(const Transmittance &args, const Structure &blockers, const SurfacePoint &point, unsigned ray, Shape shape,
                       unsigned &cast) {
    const Vec3 none = splat(0.0f);
    Followed sums{none, none, none, 0.0f, 0.0f};
    each_target(args, point, ray, shape, [&](Vec3 target) {
        if (!(dot(point.normal, target - point.origin) > 0.0f))
            return;
        const Vec3 left = pass(args, structure_of(args.shadows.scene, blockers), point.origin, target);
        sums.all = sums.all + left;
        sums.all_count += 1.0f;
        if (left != splat(1.0f)) {
            ++cast;
            if (occluded(blockers, args.shadows.tally, long_segment(point.origin, target)))
                return;
        }
        sums.lost = sums.lost + (splat(1.0f) - left);
        sums.seen = sums.seen + left;
        sums.seen_count += 1.0f;
    });
    return sums;
}

// The mean of what is left, by few samples that are all in one set.
DEVICE Vec3 mean_left(const Followed &few) {
    if (few.all_count == 0.0f)
        return splat(1.0f);
    return few.seen_count > 0.0f ? few.seen / few.seen_count : few.all / few.all_count;
}

// Adds what a set of samples loses; after the last one, what is left takes its place.
DEVICE void add_lost(const Transmittance &args, Shape shape, unsigned ray, Vec3 lost) {
    const Shadows &shadows = args.shadows;
    const unsigned long long place = (unsigned long long)shadows.first_light * shadows.rays.count + ray;
    Vec3 &passed = args.passed[place];
    float &share = shadows.share[place];
    const Vec3 all = shadows.set == 0 ? lost : passed + lost;
    if (shape != SHAPE_POINT && shadows.set + 1 < shadows.set_count) {
        passed = all;
        return;
    }
    if (all == splat(0.0f)) {
        passed = splat(share);
        return;
    }
    const float samples = shape == SHAPE_POINT ? 1.0f : (float)shadows.sampling.samples;
    const Vec3 left = splat(share) - all / samples;
    passed = Vec3{fmaxf(left.x, 0.0f), fmaxf(left.y, 0.0f), fmaxf(left.z, 0.0f)};
    share = (passed.x + passed.y + passed.z) / 3.0f;
}

// What few samples leave of a light takes the place of its share.
DEVICE void put_left(const Transmittance &args, unsigned ray, Vec3 left) {
    const Shadows &shadows = args.shadows;
    const unsigned long long place = (unsigned long long)shadows.first_light * shadows.rays.count + ray;
    float &share = shadows.share[place];
    if (left == splat(1.0f)) {
        args.passed[place] = splat(share);
        return;
    }
    const Vec3 passed = share * left;
    args.passed[place] = passed;
    share = (passed.x + passed.y + passed.z) / 3.0f;
}

template <class Structure>
DEVICE void transmittance(const Transmittance &args, const Structure &blockers) {
    const Shadows &shadows = args.shadows;
    unsigned ray, cast = 0;
    const Light &light = shadows.scene.lights[shadows.first_light];
    const Shape shape = args.middle ? SHAPE_POINT : shape_of(shadows.sampling, light);
    const bool has = !(shape == SHAPE_POINT && shadows.set != 0) &&
                     ray_of_thread(shadows.rays, shadows.first + blockIdx.x, threadIdx.x, ray);
    if (has) {
        const bool sees = load_hit(shadows.hits, ray).triangle != Hit::NONE &&
                          shadows.share[(unsigned long long)shadows.first_light * shadows.rays.count + ray] > 0.0f;
        const unsigned level = sees ? level_of(args, ray) : 0;
        if (level == args.level) {
            Followed followed{};
            if (sees) {
                const SurfacePoint point = shadow_point_of(shadows.scene, shadows.rays, shadows.hits, ray, light);
                if (may_show(args, ray, point, light))
                    followed = follow(args, blockers, point, ray, shape, cast);
            }
            if (level > 0)
                put_left(args, ray, mean_left(followed));
            else
                add_lost(args, shape, ray, followed.lost);
        }
    }
    count(tally_shard(shadows.tally).shadow_rays, cast);
}

KERNEL_PER_STRUCTURE(transmittance, Transmittance, BLOCK, 2)
