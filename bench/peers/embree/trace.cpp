// Casts the rays of one scene with Embree, natively: packets of 16, 8 or single rays, drawn tile by tile by several threads.
//
//     trace SCENE SIZE SAMPLES fast|robust [CONFIG]
//
// SCENE is written by native.py, SAMPLES is a square, CONFIG is Embree's own, such as isa=avx2. Reads commands from standard input, and
// answers each with a line of JSON:
//
//     primary|hard|soft WIDTH THREADS     casts all rays of a kind: seconds, rays, hits of primary or occluded of shadow rays
//     form WIDTH THREADS hard|soft        the same without tracing: what it takes to form the shadow rays
//     save FILE                           saves, for each light and pixel, how many rays of the last kind reached it: 16 bits each
//
// Like Lightmesh, primary rays are formed before the clock starts, and shadow rays while it runs.

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>
#include <xmmintrin.h>

#include "caster.h"
#include "embree4.h"
#include "scene.h"

namespace {

// Runs a kind of rays on some threads; the clock runs from the moment when all have started.
template <int WIDTH>
void cast(const Scene& scene, Image& image, const Rows& rows, const std::string& kind, bool tracing, int threads) {
    std::atomic<uint32_t> next = 0;
    std::atomic<uint64_t> rays = 0, found = 0;
    std::barrier together(threads);
    double start = 0, end = 0;
    const auto work = [&](int thread) {
        // Embree's manual recommends both for speed: flush to zero, denormals are zero.
        _mm_setcsr(_mm_getcsr() | 0x8040);
        Caster<WIDTH> caster(scene, image, rows, tracing);
        together.arrive_and_wait();
        if (thread == 0)
            start = seconds();
        for (uint32_t first; (first = next.fetch_add(TILE_RAYS)) < image.pixels.size();) {
            if (kind == "primary")
                caster.primary(first);
            else if (kind == "hard")
                caster.hard(first);
            else
                caster.soft(first);
        }
        rays += caster.counts.rays;
        found += caster.counts.found;
        together.arrive_and_wait();
        if (thread == 0)
            end = seconds();
    };
    std::vector<std::thread> others;
    for (int thread = 1; thread < threads; thread++)
        others.emplace_back(work, thread);
    work(0);
    for (std::thread& other : others)
        other.join();
    const char* what = kind == "primary" ? "hits" : "occluded";
    std::cout << "{\"seconds\": " << end - start << ", \"rays\": " << rays << ", \"" << what << "\": " << found << "}" << std::endl;
}

void save(const Scene& scene, const Image& image, const std::string& path) {
    const size_t pixels = size_t(image.size) * image.size;
    std::vector<uint16_t> reached(scene.lights.size() * pixels);
    for (size_t light = 0; light < scene.lights.size(); light++)
        for (size_t ray = 0; ray < image.pixels.size(); ray++)
            if (image.triangles[ray] != NONE)
                reached[light * pixels + image.pixels[ray]] = image.lit[light * image.pixels.size() + ray];
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(reached.data()), std::streamsize(reached.size() * sizeof reached[0]));
    file.close();
    std::cout << "{}" << std::endl;
}

void introduce(RTCDevice device, const Scene& scene) {
    const auto property = [&](int number) { return rtcGetDeviceProperty(device, number); };
    const bool sixteen = property(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
    const bool eight = property(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
    std::cout.precision(9);
    std::cout << "{\"version\": \"" << property(RTC_DEVICE_PROPERTY_VERSION_MAJOR) << '.'
              << property(RTC_DEVICE_PROPERTY_VERSION_MINOR) << '.' << property(RTC_DEVICE_PROPERTY_VERSION_PATCH)
              << "\", \"native_width\": " << (sixteen ? 16 : eight ? 8 : 4) << ", \"build_seconds\": " << scene.build_seconds << "}"
              << std::endl;
}

}  // namespace

int main(int count, char** words) {
    if (count < 5) {
        std::cerr << "usage: trace SCENE SIZE SAMPLES fast|robust [CONFIG]\n";
        return 2;
    }
    const RTCDevice device = rtcNewDevice(count > 5 ? words[5] : nullptr);
    const int flags = std::string(words[4]) == "robust" ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE;
    const Scene scene(device, words[1], flags);
    Image image(scene, std::stoul(words[2]));
    const Rows rows(std::stoul(words[3]));
    if (const int error = rtcGetDeviceError(device)) {
        std::cerr << "Embree's error " << error << "\n";
        return 1;
    }
    introduce(device, scene);
    for (std::string kind; std::cin >> kind;) {
        if (kind == "save") {
            std::string path;
            std::getline(std::cin >> std::ws, path);
            save(scene, image, path);
            continue;
        }
        int width = 0, threads = 0;
        std::cin >> width >> threads;
        const bool tracing = kind != "form";
        if (!tracing)
            std::cin >> kind;
        const auto run = width == 16 ? cast<16> : width == 8 ? cast<8> : cast<1>;
        run(scene, image, rows, kind, tracing, threads);
    }
}
