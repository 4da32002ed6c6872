// The rays of a camera and of square lights, as Lightmesh forms them: the same pixels, offsets and samples, in the same order of
// operations. A number is a `float`, or a vector of them that the compiler maps to the processor's.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>

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

template <typename W>
W reversed(W x) {
    x = x >> 16 | x << 16;
    x = (x & 0xff00ff00) >> 8 | (x & 0x00ff00ff) << 8;
    x = (x & 0xf0f0f0f0) >> 4 | (x & 0x0f0f0f0f) << 4;
    x = (x & 0xcccccccc) >> 2 | (x & 0x33333333) << 2;
    return (x & 0xaaaaaaaa) >> 1 | (x & 0x55555555) << 1;
}

// Owen scrambling, the first binary digit being the least significant bit.
template <typename W>
W scramble(W x, uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47c;
    x ^= x * 0xb82f1e52;
    x ^= x * 0xc7afe638;
    return x ^ x * 0x8d22f6e6;
}

// The second dimension of Sobol's sequence; the first is the index itself.
template <typename W>
W sobol_1(W x) {
    x ^= x >> 16;
    x ^= (x & 0xff00ff00) >> 8;
    x ^= (x & 0xf0f0f0f0) >> 4;
    x ^= (x & 0xcccccccc) >> 2;
    return x ^ (x & 0xaaaaaaaa) >> 1;
}

// The samples of one light from one pixel.
class Pattern {
    uint32_t seeds[3];

public:
    Pattern(uint64_t pixel, uint64_t light) {
        const uint64_t base = mix(mix(pixel << 1 ^ mix(light + 1)));
        for (int i = 0; i < 3; i++)
            seeds[i] = uint32_t(mix(base + i));
    }

    // The points of a light that N samples select, from `first`.
    template <int N>
    auto targets(const Light& light, uint32_t first) const {
        const auto index = reversed(scramble(reversed(Lanes<N>::count_from(first)), seeds[0]));
        const auto u = 2 * axis<N>(index, seeds[1]) - 1, v = 2 * axis<N>(sobol_1(index), seeds[2]) - 1;
        return light.position + u * light.half_u + v * light.half_v;
    }

private:
    // 24 digits, the first one most significant, as a number in [0, 1).
    template <int N>
    static auto axis(typename Lanes<N>::Words digits, uint32_t seed) {
        const typename Lanes<N>::Mask whole = typename Lanes<N>::Mask(reversed(scramble(digits, seed)) >> 8);
        return __builtin_convertvector(whole, typename Lanes<N>::Floats) * 0x1p-24f;
    }
};
