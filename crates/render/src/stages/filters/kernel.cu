// Filtered light on a CUDA device: twin of cpu.rs, one thread per surface point. Whatever lets light through has entries among the triangles
// that are cut out.
#define CUT_OUTS 1
#include "cuda/prelude.cuh"

#include "cuda/rays.cuh"
#include "shading/dielectric.cuh"
#include "shadow/seen.cuh"
#include "shadow/shadow.cuh"
#include "shadow/terminator.cuh"

// The structure of this type in a scene.
DEVICE const Bvh &structure_of(const Scene &scene, const Bvh &) { return scene.bvh; }
DEVICE const BruteForce &structure_of(const Scene &scene, const BruteForce &) { return scene.brute_force; }
DEVICE const InstancedBvh &structure_of(const Scene &scene, const InstancedBvh &) { return scene.instanced; }

// What a dielectric leaves of light. A function of its own, so that its callers keep their registers.
COLD Vec3 left_by_glass(Triangles triangles, const Vec3 *normals, const Indices *indices, const Material *material, Ray ray, Hit hit) {
    return left_straight_on(boundary_met(triangles, normals, indices, *material, ray, hit), *material);
}

// What is left of light that goes through a surface.
DEVICE Vec3 transmittance_at(const Filters &args, const Ray &ray, const Hit &hit) {
    const Scene &scene = args.shadows.scene;
    const Triangle *triangle = stored_triangle(args.triangles, hit.triangle);
    const Material &material = scene.materials[material_index(scene, args.triangles, hit.triangle)];
    const Vec3 through = (1.0f - opacity_at(scene.coverage, triangle, hit.u, hit.v)) * material.transmittance;
    if (material.ior == 0.0f)
        return through;
    return left_by_glass(args.triangles, args.normals, scene.indices, &material, ray, hit) * through;
}

// Follows a ray through all surfaces that it meets: what is left of the light.
template <class Structure>
DEVICE Vec3 pass(const Filters &args, const Structure &panes, Vec3 from, Vec3 target) {
    Vec3 left = splat(1.0f);
    for (unsigned met = 0; met < MOST_THROUGHS; ++met) {
        const Ray ray = long_segment(from, target);
        const Hit hit = closest_hit(panes, args.shadows.tally, ray);
        if (hit.triangle == Hit::NONE)
            break;
        left = left * transmittance_at(args, ray, hit);
        from = behind(surface_point(ray, hit, corners_at(args.triangles, hit.triangle)));
    }
    return left;
}

// What is lost on the way to a sample, if nothing opaque hides it.
template <class Structure>
DEVICE Vec3 lost_of(const Filters &args, const Structure &blockers, const SurfacePoint &point, Vec3 target, unsigned &cast) {
    const Vec3 none = splat(0.0f);
    if (!(dot(point.normal, target - point.origin) > 0.0f))
        return none;
    const Vec3 left = pass(args, structure_of(args.shadows.scene, blockers), point.origin, target);
    if (left == splat(1.0f))
        return none;
    ++cast;
    return hidden(blockers, args.shadows.tally, point.origin, target) ? none : splat(1.0f) - left;
}

// The sum of that over the samples of a set.
template <class Structure>
DEVICE Vec3 lost_of_set(const Filters &args, const Structure &blockers, const SurfacePoint &point, unsigned ray, Shape shape,
                        unsigned &cast) {
    const Shadows &shadows = args.shadows;
    const Light &light = shadows.scene.lights[shadows.first_light];
    if (shape == SHAPE_POINT) {
        const Vec3 middle = light_center(light, point.origin, scene_reach(shadows.scene, point.origin));
        return lost_of(args, blockers, point, middle, cast);
    }
    const SampleRows &set = shadows.sets[shape];
    const Sight sight =
        sight_of(shadows.scene, shadows.sampling, shadows.first_light, shape, set.lines, point, ray_key(shadows.rays, ray));
    Vec3 sum = splat(0.0f);
    for (unsigned row = 0; row < set.rows; ++row)
        for (unsigned rest = valid_samples(sight, set, row); rest != 0; rest &= rest - 1) {
            const Vec3 target = point.origin + sample_at(sight, set, row, __ffs(rest) - 1, light.scale);
            sum = sum + lost_of(args, blockers, point, target, cast);
        }
    return sum;
}

// Adds what a set of samples loses; after the last one, what is left takes its place.
DEVICE void add_lost(const Filters &args, Shape shape, unsigned ray, Vec3 lost) {
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

template <class Structure>
DEVICE void filters(const Filters &args, const Structure &blockers) {
    const Shadows &shadows = args.shadows;
    unsigned ray, cast = 0;
    const Light &light = shadows.scene.lights[shadows.first_light];
    const Shape shape = args.middle ? SHAPE_POINT : shape_of(shadows.sampling, light);
    const bool has = !(shape == SHAPE_POINT && shadows.set != 0) &&
                     ray_of_thread(shadows.rays, shadows.first + blockIdx.x, threadIdx.x, ray);
    if (has) {
        Vec3 lost = splat(0.0f);
        if (load_hit(shadows.hits, ray).triangle != Hit::NONE &&
            shadows.share[(unsigned long long)shadows.first_light * shadows.rays.count + ray] > 0.0f) {
            const SurfacePoint point = shadow_point_of(shadows.scene, shadows.rays, shadows.hits, ray, light);
            lost = lost_of_set(args, blockers, point, ray, shape, cast);
        }
        add_lost(args, shape, ray, lost);
    }
    count(tally_shard(shadows.tally).shadow_rays, cast);
}

KERNEL_PER_STRUCTURE(filters, Filters, BLOCK, 2)
