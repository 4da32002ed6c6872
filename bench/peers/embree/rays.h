// The rays of a camera and of square lights, as Lightmesh forms them: the same pixels, offsets and samples, in the same order of
// operations. A number is a `float`, or a vector of them that the compiler maps to the processor's.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

template <typename T>
T load(const void* from) {
    T lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

template <typename T>
void store(void* to, T lanes) {
    std::memcpy(to, &lanes, sizeof lanes);
}

// One number for each of N rays.
template <int N>
struct Lanes {
    typedef float Floats __attribute__((vector_size(4 * N)));
    typedef uint32_t Words __attribute__((vector_size(4 * N)));
    // 0 or −1, as in comparisons.
    typedef int Mask __attribute__((vector_size(4 * N)));

    static Words count_from(uint32_t first) {
        uint32_t words[N];
        std::iota(words, words + N, first);
        return load<Words>(words);
    }
};

template <typename T>
T maximum(T a, T b) {
    return a > b ? a : b;
}

template <typename T>
T magnitude(T a) {
    return maximum(a, -a);
}

template <typename T>
T root(T a) {
    float numbers[sizeof a / sizeof(float)];
    store(numbers, a);
    for (float& number : numbers)
        number = std::sqrt(number);
    return load<T>(numbers);
}

template <typename T>
struct Vec {
    T x, y, z;
};
using Vec3 = Vec<float>;

template <typename A, typename B>
auto operator+(Vec<A> a, Vec<B> b) {
    return Vec<decltype(a.x + b.x)>{a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename A, typename B>
auto operator-(Vec<A> a, Vec<B> b) {
    return Vec<decltype(a.x - b.x)>{a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename A, typename B>
auto operator*(A s, Vec<B> a) {
    return Vec<decltype(s * a.x)>{s * a.x, s * a.y, s * a.z};
}

template <typename A, typename B>
auto dot(Vec<A> a, Vec<B> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
Vec<T> cross(Vec<T> a, Vec<T> b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}

template <typename T>
Vec<T> magnitudes(Vec<T> a) {
    return {magnitude(a.x), magnitude(a.y), magnitude(a.z)};
}

template <typename T>
T largest(Vec<T> a) {
    return maximum(a.x, maximum(a.y, a.z));
}

// The vector of one ray.
template <typename T>
Vec3 lane_of(const Vec<T>& a, int lane) {
    return {a.x[lane], a.y[lane], a.z[lane]};
}

struct Camera {
    Vec3 position, forward;
    // From one pixel's centre to the next, on the plane one unit away.
    Vec3 right, down;

    // The direction through the centre of a pixel, of unit length.
    Vec3 direction(uint32_t x, uint32_t y, uint32_t size) const {
        const float middle = 0.5f - 0.5f * float(size);
        const Vec3 aside = (float(x) + middle) * right + (float(y) + middle) * down;
        return 1 / root(dot(forward + aside, forward + aside)) * (forward + aside);
    }
};

// A rectangle with the edges 2 half_u and 2 half_v.
struct Light {
    Vec3 position, half_u, half_v;

    // Makes half_u the longer one.
    void order() {
        // Of equal edges, rounding makes one longer. Volatile products are not fused with sums, which would round differently.
        const auto squared = [](Vec3 a) {
            volatile float x = a.x * a.x, y = a.y * a.y, z = a.z * a.z, sum = x + y;
            return sum + z;
        };
        if (squared(half_u) < squared(half_v))
            std::swap(half_u, half_v);
    }
};

// γ(32), the bound on rounding that keeps a segment off the surfaces at its ends.
constexpr float GAMMA_32 = 32 * 0x1p-24f / (1 - 32 * 0x1p-24f);

// A surface point, or one for each ray.
template <typename T>
struct SurfacePoint {
    // Slightly in front of the surface.
    Vec<T> origin;
    // On the viewer's side.
    Vec<T> normal;

    SurfacePoint(Vec<T> a, Vec<T> b, Vec<T> c, T u, T v, Vec<T> direction) {
        const Vec<T> position = (1 - u - v) * a + u * b + v * c, outward = cross(b - a, c - a);
        const T length = root(dot(outward, outward));
        normal = (dot(outward, direction) > 0 ? -1 / length : 1 / length) * outward;
        origin = position + GAMMA_32 * largest(magnitudes(a) + magnitudes(b) + magnitudes(c)) * normal;
    }
};

// Where segments end, as a fraction: before a surface that the light may lie in.
template <typename T>
T segment_end(Vec<T> origin, Vec<T> target) {
    const T length = largest(magnitudes(target - origin));
    const T error = GAMMA_32 * maximum(largest(magnitudes(origin)), largest(magnitudes(target)));
    return 1 - (error < 0.5f * length ? error / length : 0.5f + 0 * length);
}

inline uint64_t mix(uint64_t value) {
    value += 0x9e3779b97f4a7c15;
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9;
    value = (value ^ value >> 27) * 0x94d049bb133111eb;
    return value ^ value >> 31;
}

// The samples of a rectangle that do not depend on the pixel: rows along its longer side, n rows of n samples for n² in all. The last row
// is cut in two: what leaves the rectangle at one side enters it at the other.
class Rows {
    static constexpr float SHIFTS = 0x1p16f;
    static constexpr double GOLDEN = 0.6180339887498949;

public:
    uint32_t lines;
    // For each sample its place in its row, by how much of their distance the row is shifted, and the height of the row; the last row
    // has two.
    std::vector<float> places, shifts, heights, entering;

    explicit Rows(uint32_t samples) : lines(uint32_t(std::lround(std::sqrt(samples)))) {
        if (lines * lines != samples)
            throw std::runtime_error("the number of samples is no square");
        const auto height = [&](uint32_t line) { return float((2.0 * line - 1) / lines - 1); };
        for (uint32_t sample = 0; sample < samples; sample++) {
            const uint32_t row = sample / lines;
            const double share = row * GOLDEN;
            places.push_back(float(sample % lines));
            shifts.push_back(float(std::floor((share - std::floor(share)) * SHIFTS)) / SHIFTS);
            heights.push_back(height(row + 1));
            entering.push_back(row + 1 == lines ? height(0) : height(row + 1));
        }
        // Room for a packet that is not full.
        for (std::vector<float>* numbers : {&places, &shifts, &heights, &entering})
            numbers->resize(samples + 16);
    }
};

// The samples of one light from one pixel.
class Pattern {
    static constexpr float SHIFTS = 0x1p16f;

    const Rows& rows;
    Vec3 center, along, across;
    float shift, inside, half;

public:
    Pattern(const Rows& rows, const Light& light, Vec3 origin, uint64_t pixel, uint64_t number)
        : rows(rows), half(0.5f * float(rows.lines)) {
        const uint64_t random = mix(mix(pixel << 1 ^ mix(number + 1)));
        const float aside = float(random >> 16 & 0xffff) / SHIFTS;
        across = light.half_v;
        const Vec3 step = 1 / float(rows.lines) * across;
        shift = float(random & 0xffff) / SHIFTS;
        inside = (1 - aside) * float(rows.lines);
        center = light.position - origin + 2 * aside * step;
        along = light.half_u + step;
    }

    // Where N samples are, from `first`, seen from the surface point.
    template <int N>
    auto ways(uint32_t first) const {
        using Floats = typename Lanes<N>::Floats;
        const Floats place = load<Floats>(&rows.places[first]), moved = shift + load<Floats>(&rows.shifts[first]);
        const Floats shifted = moved >= 1 ? moved - 1 : moved;
        const Floats x = (place - (half - shifted)) / half;
        const Floats y = place < inside - shifted ? load<Floats>(&rows.heights[first]) : load<Floats>(&rows.entering[first]);
        return center + x * along + y * across;
    }
};
