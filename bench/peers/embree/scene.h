// A scene in Embree, and an image of it: what is known of each ray, by its number.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "embree4.h"
#include "rays.h"

// Pixels along a tile and a block. Rays are numbered tile by tile, in a tile block by block: each packet is a part of a block.
constexpr uint32_t TILE = 16, BLOCK = 4, TILE_RAYS = TILE * TILE;
constexpr uint32_t NONE = ~0u;

inline double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <typename T>
std::vector<T> read(std::istream& file, size_t count) {
    std::vector<T> values(count);
    file.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T)));
    return values;
}

struct Scene {
    Camera camera;
    std::vector<Light> lights;
    // The corners of triangles, nine numbers each.
    std::vector<float> corners;
    RTCScene embree;
    double build_seconds;

    Scene(RTCDevice device, const char* path, int flags) {
        std::ifstream file(path, std::ios::binary);
        const auto counts = read<uint32_t>(file, 3);
        camera = read<Camera>(file, 1)[0];
        lights = read<Light>(file, counts[0]);
        std::for_each(lights.begin(), lights.end(), [](Light& light) { light.order(); });
        const auto vertices = read<Vec3>(file, counts[1]);
        const auto triangles = read<uint32_t>(file, 3 * size_t(counts[2]));
        if (!file || triangles.empty())
            throw std::runtime_error("the scene cannot be read");
        for (const uint32_t vertex : triangles)
            corners.insert(corners.end(), {vertices[vertex].x, vertices[vertex].y, vertices[vertex].z});

        const double start = seconds();
        const RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
        void* points = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices.size());
        std::memcpy(points, vertices.data(), 12 * vertices.size());
        void* indices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size() / 3);
        std::memcpy(indices, triangles.data(), 4 * triangles.size());
        rtcCommitGeometry(mesh);
        embree = rtcNewScene(device);
        rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_HIGH);
        rtcSetSceneFlags(embree, flags);
        rtcAttachGeometry(embree, mesh);
        rtcCommitScene(embree);
        build_seconds = seconds() - start;
    }
};

struct Image {
    uint32_t size;
    std::vector<uint32_t> pixels;
    // Its direction.
    std::vector<float> x, y, z;
    // Its hit.
    std::vector<uint32_t> triangles;
    std::vector<float> u, v;
    // Unoccluded shadow rays, light by light.
    std::vector<uint16_t> lit;

    Image(const Scene& scene, uint32_t size) : size(size) {
        const uint32_t tiles = (size + TILE - 1) / TILE;
        for (uint32_t number = 0; number < tiles * tiles * TILE_RAYS; number++) {
            const uint32_t tile = number / TILE_RAYS, block = number / (BLOCK * BLOCK) % (TILE_RAYS / (BLOCK * BLOCK));
            const uint32_t in_block = number % (BLOCK * BLOCK), blocks = TILE / BLOCK;
            const uint32_t column = tile % tiles * TILE + block % blocks * BLOCK + in_block % BLOCK;
            const uint32_t row = tile / tiles * TILE + block / blocks * BLOCK + in_block / BLOCK;
            const Vec3 direction = scene.camera.direction(column, row, size);
            pixels.push_back(column < size && row < size ? row * size + column : NONE);
            x.push_back(direction.x);
            y.push_back(direction.y);
            z.push_back(direction.z);
        }
        triangles.assign(pixels.size(), NONE);
        u.resize(pixels.size());
        v.resize(pixels.size());
        lit.resize(pixels.size() * scene.lights.size());
    }

    template <int N>
    Vec<typename Lanes<N>::Floats> directions(uint32_t first) const {
        using Floats = typename Lanes<N>::Floats;
        return {load<Floats>(&x[first]), load<Floats>(&y[first]), load<Floats>(&z[first])};
    }
};

// The surface points of some rays, from `first`. Where nothing is hit, any point.
template <int N>
SurfacePoint<typename Lanes<N>::Floats> surface_points(const Scene& scene, const Image& image, uint32_t first) {
    using Floats = typename Lanes<N>::Floats;
    // Arrays: lanes of a vector are slow to set one by one.
    float corners[9][N];
    for (int lane = 0; lane < N; lane++) {
        const uint32_t triangle = image.triangles[first + lane];
        const float* own = &scene.corners[9 * size_t(triangle == NONE ? 0 : triangle)];
        for (int i = 0; i < 9; i++)
            corners[i][lane] = own[i];
    }
    const auto row = [&](int i) { return load<Floats>(corners[i]); };
    const Vec<Floats> a = {row(0), row(1), row(2)}, b = {row(3), row(4), row(5)}, c = {row(6), row(7), row(8)};
    return {a, b, c, load<Floats>(&image.u[first]), load<Floats>(&image.v[first]), image.directions<N>(first)};
}
