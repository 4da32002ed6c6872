// The part of Embree 4's interface that trace.cpp uses. Python wheels contain the library without its headers; names, values and
// layouts are those of https://github.com/RenderKit/embree, include/embree4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <sys/types.h>

using RTCDevice = struct RTCDeviceTy*;
using RTCScene = struct RTCSceneTy*;
using RTCGeometry = struct RTCGeometryTy*;

constexpr int RTC_DEVICE_PROPERTY_VERSION_MAJOR = 1, RTC_DEVICE_PROPERTY_VERSION_MINOR = 2, RTC_DEVICE_PROPERTY_VERSION_PATCH = 3;
constexpr int RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED = 33, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED = 34;
constexpr int RTC_GEOMETRY_TYPE_TRIANGLE = 0;
constexpr int RTC_BUFFER_TYPE_INDEX = 0, RTC_BUFFER_TYPE_VERTEX = 1;
constexpr int RTC_FORMAT_UINT3 = 0x5003, RTC_FORMAT_FLOAT3 = 0x9003;
constexpr int RTC_BUILD_QUALITY_HIGH = 2;
constexpr int RTC_SCENE_FLAG_NONE = 0, RTC_SCENE_FLAG_ROBUST = 1 << 2;
constexpr int RTC_RAY_QUERY_FLAG_COHERENT = 1 << 16;
constexpr uint32_t RTC_FEATURE_FLAG_TRIANGLE = 1 << 1;

constexpr size_t packet_alignment(int width) { return width < 4 ? 16 : 4 * width; }

// RTCRay, RTCRay8, RTCRay16.
template <int N>
struct alignas(packet_alignment(N)) Rays {
    float org_x[N], org_y[N], org_z[N], tnear[N];
    float dir_x[N], dir_y[N], dir_z[N], time[N];
    float tfar[N];
    uint32_t mask[N], id[N], flags[N];
};

// RTCHit, RTCHit8, RTCHit16.
template <int N>
struct alignas(packet_alignment(N)) Hits {
    float ng_x[N], ng_y[N], ng_z[N], u[N], v[N];
    uint32_t prim_id[N], geom_id[N];
    // How many instances can be nested is decided when the library is built. Room for more does no harm: this is the end.
    uint32_t instances[16][N];
};

// RTCRayHit, RTCRayHit8, RTCRayHit16.
template <int N>
struct RaysAndHits {
    Rays<N> rays;
    Hits<N> hits;
};

// RTCIntersectArguments and RTCOccludedArguments.
struct Arguments {
    int flags = RTC_RAY_QUERY_FLAG_COHERENT;
    uint32_t feature_mask = RTC_FEATURE_FLAG_TRIANGLE;
    void* context = nullptr;
    void* filter = nullptr;
    void* geometry = nullptr;
    float min_width_distance_factor = 0;
};

extern "C" {
RTCDevice rtcNewDevice(const char* config);
ssize_t rtcGetDeviceProperty(RTCDevice, int property);
int rtcGetDeviceError(RTCDevice);
RTCGeometry rtcNewGeometry(RTCDevice, int type);
void* rtcSetNewGeometryBuffer(RTCGeometry, int type, unsigned slot, int format, size_t stride, size_t count);
void rtcSetGeometryBuildQuality(RTCGeometry, int quality);
void rtcCommitGeometry(RTCGeometry);
RTCScene rtcNewScene(RTCDevice);
void rtcSetSceneFlags(RTCScene, int flags);
void rtcSetSceneBuildQuality(RTCScene, int quality);
unsigned rtcAttachGeometry(RTCScene, RTCGeometry);
void rtcCommitScene(RTCScene);
void rtcIntersect1(RTCScene, RaysAndHits<1>*, Arguments*);
void rtcIntersect8(const int* valid, RTCScene, RaysAndHits<8>*, Arguments*);
void rtcIntersect16(const int* valid, RTCScene, RaysAndHits<16>*, Arguments*);
void rtcOccluded1(RTCScene, Rays<1>*, Arguments*);
void rtcOccluded8(const int* valid, RTCScene, Rays<8>*, Arguments*);
void rtcOccluded16(const int* valid, RTCScene, Rays<16>*, Arguments*);
}
