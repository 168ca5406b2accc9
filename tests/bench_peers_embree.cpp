// Embree 3 as a ray tracer: one query a ray, shared out among threads as traceClosest() does.
#include "tests/bench_peers_embree.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "builder/parallel/error.h"
#include "builder/parallel/timeline.h"

namespace copse::peers {

namespace {

constexpr int64_t raysAtATime = 256;  // As in traceClosest.

void check(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw DeviceError(fmt::format("Embree: error {}", static_cast<int>(error)));
}

RTCRay embreeRay(const Ray& ray) {
  RTCRay r;
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.tMin, r.tfar = ray.tMax;
  r.time = 0, r.mask = ~0u, r.id = 0, r.flags = 0;
  return r;
}

}  // namespace

struct EmbreeTracer::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~Handles() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

EmbreeTracer::EmbreeTracer(const Scene& scene, Quality quality, int threads) : handles_(std::make_unique<Handles>()) {
  Handles& h = *handles_;
  h.device = rtcNewDevice(fmt::format("threads={}", threads).c_str());
  check(h.device);
  const RTCBuildQuality how = quality == Quality::low      ? RTC_BUILD_QUALITY_LOW
                              : quality == Quality::medium ? RTC_BUILD_QUALITY_MEDIUM
                                                           : RTC_BUILD_QUALITY_HIGH;
  h.scene = rtcNewScene(h.device);
  rtcSetSceneBuildQuality(h.scene, how);
  const RTCGeometry mesh = rtcNewGeometry(h.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(mesh, how);
  void* positions =
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), scene.positions.size());
  void* indices =
      rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3), scene.triangles.size());
  check(h.device);
  std::memcpy(positions, scene.positions.data(), scene.positions.size() * sizeof(vec3));
  std::memcpy(indices, scene.triangles.data(), scene.triangles.size() * sizeof(uvec3));
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(h.scene, mesh);
  rtcReleaseGeometry(mesh);
  const auto start = std::chrono::steady_clock::now();
  rtcCommitScene(h.scene);
  buildMs_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  check(h.device);
}

EmbreeTracer::~EmbreeTracer() = default;

void EmbreeTracer::closest(const Device& device, const char* name, uint32_t most, const uint32_t* count,
                           const Ray* rays, Hit* hits) const {
  const Phase phase(device, name);
  const int64_t n = count ? std::min(most, *count) : most;
#pragma omp parallel for schedule(dynamic, raysAtATime) num_threads(device.threads) if (n > raysAtATime)
  for (int64_t i = 0; i < n; ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = embreeRay(rays[i]);
    query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(handles_->scene, &context, &query);
    const bool missed = query.hit.geomID == RTC_INVALID_GEOMETRY_ID;
    hits[i] = {query.ray.tfar, query.hit.u, query.hit.v, missed ? Hit::none : query.hit.primID};
  }
}

void EmbreeTracer::any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
                       uint32_t* occluded) const {
  const Phase phase(device, name);
  const int64_t n = count ? std::min(most, *count) : most;
#pragma omp parallel for schedule(dynamic, raysAtATime) num_threads(device.threads) if (n > raysAtATime)
  for (int64_t i = 0; i < n; ++i) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = embreeRay(rays[i]);
    rtcOccluded1(handles_->scene, &context, &ray);
    occluded[i] = ray.tfar < 0;
  }
}

}  // namespace copse::peers
