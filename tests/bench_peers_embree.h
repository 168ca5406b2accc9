// Embree 3 behind the path tracer's own interface: the peer that traversal is measured against.
#pragma once

#include <memory>
#include <string>

#include "tracer/scene/scene.h"
#include "tracer/traversal/ray_tracer.h"

namespace copse::peers {

enum class Quality { low, medium, high };  ///< Morton; binned surface area; the same with spatial splits.

/// A scene in Embree, on a number of threads; traced ray by ray. CPU memory only.
class EmbreeTracer final : public RayTracer {
 public:
  /// Throws DeviceError with Embree's own message.
  EmbreeTracer(const Scene& scene, Quality quality, int threads);
  ~EmbreeTracer() override;

  /// Of committing the scene; copying the triangles is left out.
  double buildMs() const { return buildMs_; }

  void closest(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
               Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
           uint32_t* occluded) const override;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  double buildMs_ = 0;
};

}  // namespace copse::peers
