// One query per ray; threads share the rays as in HostTracer.
// The triangles are copied before the clock starts: Embree reads 4 bytes beyond the last vertex, so it is given memory
// of its own. The other builders read the triangles where they lie, and so would Embree in a buffer that is padded.
#include "tracer/accel/embree.h"

#include <fmt/format.h>
#if COPSE_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "builder/base/error.h"
#include "builder/parallel/timeline.h"
#include "tracer/accel/phases.h"

namespace copse {

namespace {

constexpr int64_t raysAtATime = 256;  // As in HostTracer.

RTCBuildQuality qualityOf(EmbreeQuality quality) {
  return quality == EmbreeQuality::low      ? RTC_BUILD_QUALITY_LOW
         : quality == EmbreeQuality::medium ? RTC_BUILD_QUALITY_MEDIUM
                                            : RTC_BUILD_QUALITY_HIGH;
}

/// Embree's own limit on coordinates. Beyond it, and for NaN, its results are undefined, and a build with assertions,
/// such as Debian's, aborts the program.
bool canTrace(const Ray& ray) {
  const auto within = [](const vec3& v) {
    constexpr float max = 1.844e18f;
    return std::abs(v.x) < max && std::abs(v.y) < max && std::abs(v.z) < max;
  };
  return within(ray.origin) && within(ray.direction) && ray.tMin < ray.tMax;
}

RTCRay embreeRay(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = std::max(ray.tMin, 0.0f), r.tfar = ray.tMax;
  r.time = 0, r.mask = ~0u, r.id = 0, r.flags = 0;
  return r;
}

// Queries of a single ray in each version's API.
#if COPSE_EMBREE == 4
void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
void occlude(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
#else
void intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}
void occlude(RTCScene scene, RTCRay& ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
#endif

}  // namespace

struct EmbreeTracer::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::atomic<int64_t> allocated{0}, peak{0};  ///< Bytes, as Embree reports them.
  int64_t builtBytes = 0, peakBytes = 0;
  std::string message;  ///< The text of the last error.

  ~Handles() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void check() {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw DeviceError(fmt::format("Embree: error {}: {}", static_cast<int>(error), message));
  }
};

EmbreeTracer::EmbreeTracer(const TrianglesView& triangles, EmbreeQuality quality, int threads)
    : handles_(std::make_unique<Handles>()) {
  Handles& h = *handles_;
  h.device = rtcNewDevice(fmt::format("threads={}", threads).c_str());
  h.check();
  rtcSetDeviceErrorFunction(
      h.device, [](void* to, RTCError, const char* text) { static_cast<Handles*>(to)->message = text; }, &h);
  rtcSetDeviceMemoryMonitorFunction(
      h.device,
      [](void* to, ssize_t bytes, bool) {
        Handles& handles = *static_cast<Handles*>(to);
        const int64_t now = handles.allocated += bytes;
        int64_t peak = handles.peak;
        while (now > peak && !handles.peak.compare_exchange_weak(peak, now)) {
        }
        return true;
      },
      &h);
  h.scene = rtcNewScene(h.device);
  rtcSetSceneBuildQuality(h.scene, qualityOf(quality));
  if (triangles.count > 0) {
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < triangles.count; ++i) {
      const uvec3 t = triangles.indices[i];
      vertices = std::max({vertices, t.x + 1, t.y + 1, t.z + 1});
    }
    const RTCGeometry mesh = rtcNewGeometry(h.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(mesh, qualityOf(quality));
    void* positions =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), vertices);
    void* indices =
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), triangles.count);
    if (positions && indices) {
      std::memcpy(positions, triangles.positions, vertices * sizeof(vec3));
      std::memcpy(indices, triangles.indices, triangles.count * sizeof(uvec3));
      rtcCommitGeometry(mesh);
      rtcAttachGeometry(h.scene, mesh);
    }
    rtcReleaseGeometry(mesh);
  }
  h.check();
}

EmbreeTracer::~EmbreeTracer() = default;

void EmbreeTracer::build(const Device& device, const Bvh&, const TrianglesView&) {
  Handles& h = *handles_;
  const int64_t before = h.allocated;
  h.peak = before;
  {
    const Phase phase(device, phases::embree);
    rtcCommitScene(h.scene);
  }
  h.check();
  h.builtBytes = std::max<int64_t>(h.allocated - before, 0);
  h.peakBytes = h.peak - before;
}

std::size_t EmbreeTracer::bytes() const { return static_cast<std::size_t>(handles_->builtBytes); }
std::size_t EmbreeTracer::foreignPeakBytes() const { return static_cast<std::size_t>(handles_->peakBytes); }

void EmbreeTracer::closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const {
  const Phase phase(device, name);
  const int64_t n = count;
#pragma omp parallel for schedule(dynamic, raysAtATime) num_threads(device.threads) if (n > raysAtATime)
  for (int64_t i = 0; i < n; ++i) {
    hits[i] = {rays[i].tMax, 0, 0, Hit::none};
    if (!canTrace(rays[i])) continue;
    RTCRayHit query;
    query.ray = embreeRay(rays[i]);
    query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(handles_->scene, query);
    if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID)
      hits[i] = {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
  }
}

void EmbreeTracer::any(const Device& device, const char* name, uint32_t count, const Ray* rays,
                       uint32_t* occluded) const {
  const Phase phase(device, name);
  const int64_t n = count;
#pragma omp parallel for schedule(dynamic, raysAtATime) num_threads(device.threads) if (n > raysAtATime)
  for (int64_t i = 0; i < n; ++i) {
    occluded[i] = 0;
    if (!canTrace(rays[i])) continue;
    RTCRay ray = embreeRay(rays[i]);
    occlude(handles_->scene, ray);
    occluded[i] = ray.tfar == -std::numeric_limits<float>::infinity();  // Embree's sign of a hit.
  }
}

}  // namespace copse
