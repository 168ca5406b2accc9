// Embree 3 or 4 behind the path tracer's own interface (Wald, Woop, Benthin, Johnson and Ernst, Embree: a kernel
// framework for efficient CPU ray tracing, 2014): the baseline that builds and traversal are measured against.
#pragma once

#include <memory>

#include "tracer/accel/ray_tracer.h"

namespace copse {

enum class EmbreeQuality { low, medium, high };  ///< Morton; binned surface area; the same with spatial splits.

/// Triangles in an Embree scene, traced ray by ray with its default kernels: these are not the robust ones, so a ray
/// may slip between two triangles.
class EmbreeTracer final : public TreeTracer {
 public:
  /// Copies the triangles, which are in host memory. Throws DeviceError with Embree's own message.
  EmbreeTracer(const TrianglesView& triangles, EmbreeQuality quality, int threads);
  ~EmbreeTracer() override;

  /// Phase "embree": from the copied triangles to what rays traverse, like a builder and a format together.
  void build(const Device& device, const Bvh&, const TrianglesView&) override;
  const char* name() const override { return "embree"; }
  /// What Embree allocated for its build and kept.
  std::size_t bytes() const override;
  std::size_t foreignPeakBytes() const override;

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded) const override;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace copse
