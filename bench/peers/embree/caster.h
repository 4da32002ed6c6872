// Casts the rays of a tile: forms them, hands them to Embree, and keeps the results in the image.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "embree4.h"
#include "rays.h"
#include "scene.h"

struct Counts {
    uint64_t rays = 0, found = 0;
};

// Packets with a width of their own, or one of 8 ray by ray.
template <int WIDTH>
struct Packets {
    static constexpr int N = WIDTH == 1 ? 8 : WIDTH;

    static void intersect(RTCScene scene, const int* valid, RaysAndHits<N>& packet, Arguments* arguments) {
        if constexpr (WIDTH == 16)
            return rtcIntersect16(valid, scene, &packet, arguments);
        if constexpr (WIDTH == 8)
            return rtcIntersect8(valid, scene, &packet, arguments);
        for (int lane = 0; WIDTH == 1 && lane < N; lane++) {
            if (!valid[lane])
                continue;
            RaysAndHits<1> single = {alone(packet.rays, lane), {}};
            single.hits.prim_id[0] = single.hits.geom_id[0] = NONE;
            rtcIntersect1(scene, &single, arguments);
            packet.hits.prim_id[lane] = single.hits.prim_id[0];
            packet.hits.u[lane] = single.hits.u[0];
            packet.hits.v[lane] = single.hits.v[0];
        }
    }

    static void occluded(RTCScene scene, const int* valid, Rays<N>& rays, Arguments* arguments) {
        if constexpr (WIDTH == 16)
            return rtcOccluded16(valid, scene, &rays, arguments);
        if constexpr (WIDTH == 8)
            return rtcOccluded8(valid, scene, &rays, arguments);
        for (int lane = 0; WIDTH == 1 && lane < N; lane++) {
            if (!valid[lane])
                continue;
            Rays<1> single = alone(rays, lane);
            rtcOccluded1(scene, &single, arguments);
            rays.tfar[lane] = single.tfar[0];
        }
    }

    static Rays<1> alone(const Rays<N>& rays, int lane) {
        return {{rays.org_x[lane]}, {rays.org_y[lane]}, {rays.org_z[lane]}, {0}, {rays.dir_x[lane]}, {rays.dir_y[lane]},
                {rays.dir_z[lane]}, {0}, {rays.tfar[lane]}, {~0u}, {0}, {0}};
    }
};

// Casts rays in packets of a width.
template <int WIDTH>
class Caster {
    static constexpr int N = Packets<WIDTH>::N;
    using Floats = typename Lanes<N>::Floats;
    using Words = typename Lanes<N>::Words;
    using Mask = typename Lanes<N>::Mask;

    const Scene& scene;
    Image& image;
    const Rows& rows;
    bool tracing;
    Arguments arguments = {};
    RaysAndHits<N> packet = {};

public:
    Counts counts;

    Caster(const Scene& scene, Image& image, const Rows& rows, bool tracing)
        : scene(scene), image(image), rows(rows), tracing(tracing) {
        std::fill_n(packet.rays.mask, N, ~0u);
    }

    // One ray per pixel.
    void primary(uint32_t first) {
        start_at(spread(scene.camera.position));
        for (uint32_t start = first; start < first + TILE_RAYS; start += N) {
            const Mask valid = load<Words>(&image.pixels[start]) != NONE;
            aim(image.directions<N>(start), Floats{} + INFINITY);
            std::fill_n(packet.hits.prim_id, N, NONE);
            std::fill_n(packet.hits.geom_id, N, NONE);
            Packets<WIDTH>::intersect(scene.embree, reinterpret_cast<const int*>(&valid), packet, &arguments);
            std::copy_n(packet.hits.prim_id, N, &image.triangles[start]);
            std::copy_n(packet.hits.u, N, &image.u[start]);
            std::copy_n(packet.hits.v, N, &image.v[start]);
            counts.rays += lanes(valid);
            counts.found += lanes(load<Words>(packet.hits.prim_id) != NONE);
        }
    }

    // One ray per pixel and light: pixels side by side.
    void hard(uint32_t first) {
        for (uint32_t start = first; start < first + TILE_RAYS; start += N) {
            const auto point = surface_points<N>(scene, image, start);
            const Mask seen = load<Words>(&image.triangles[start]) != NONE;
            start_at(point.origin);
            for (size_t light = 0; light < scene.lights.size(); light++) {
                const Mask lit = trace(point.origin, point.normal, spread(scene.lights[light].position), seen);
                for (int lane = 0; lane < N; lane++)
                    image.lit[light * image.pixels.size() + start + lane] = uint16_t(-lit[lane]);
            }
        }
    }

    // Several rays per pixel and light: samples side by side.
    void soft(uint32_t first) {
        for (uint32_t start = first; start < first + TILE_RAYS; start += N) {
            const auto points = surface_points<N>(scene, image, start);
            for (int lane = 0; lane < N; lane++)
                if (image.triangles[start + lane] != NONE)
                    soft(start + lane, lane_of(points.origin, lane), lane_of(points.normal, lane));
        }
    }

private:
    void soft(uint32_t ray, Vec3 origin, Vec3 normal) {
        const Vec<Floats> start = spread(origin);
        const uint32_t samples = rows.lines * rows.lines;
        start_at(start);
        for (size_t light = 0; light < scene.lights.size(); light++) {
            const Pattern pattern(rows, scene.lights[light], origin, image.pixels[ray], light);
            int lit = 0;
            for (uint32_t sample = 0; sample < samples; sample += N) {
                const Mask some = Lanes<N>::count_from(sample) < samples;
                lit += lanes(trace(start, spread(normal), start + pattern.template ways<N>(sample), some));
            }
            image.lit[light * image.pixels.size() + ray] = uint16_t(lit);
        }
    }

    static Vec<Floats> spread(Vec3 v) { return {Floats{} + v.x, Floats{} + v.y, Floats{} + v.z}; }

    static int lanes(Mask mask) {
        int sum = 0;
        for (int lane = 0; lane < N; lane++)
            sum -= mask[lane];
        return sum;
    }

    void start_at(Vec<Floats> origin) {
        store(packet.rays.org_x, origin.x);
        store(packet.rays.org_y, origin.y);
        store(packet.rays.org_z, origin.z);
    }

    void aim(Vec<Floats> direction, Floats end) {
        store(packet.rays.dir_x, direction.x);
        store(packet.rays.dir_y, direction.y);
        store(packet.rays.dir_z, direction.z);
        store(packet.rays.tfar, end);
    }

    // Casts rays to the targets that are in front of the surface; those that nothing stops.
    Mask trace(Vec<Floats> origin, Vec<Floats> normal, Vec<Floats> target, Mask some) {
        const Vec<Floats> direction = target - origin;
        const Mask valid = some & (dot(normal, direction) > 0);
        const int cast = lanes(valid);
        if (cast == 0)
            return valid;
        aim(direction, segment_end(origin, target));
        if (tracing)
            Packets<WIDTH>::occluded(scene.embree, reinterpret_cast<const int*>(&valid), packet.rays, &arguments);
        else
            asm volatile("" : : "r"(&packet), "r"(&valid) : "memory");
        const Mask lit = valid & (load<Floats>(packet.rays.tfar) >= 0);
        counts.rays += cast;
        counts.found += cast - lanes(lit);
        return lit;
    }
};
