// Embree 3 or 4 behind the path tracer's own interface (Wald, Woop, Benthin, Johnson and Ernst, Embree: a kernel
// framework for efficient CPU ray tracing, 2014): the peer that builds and traversal are measured against.
#pragma once

#include "tracer/accel/peers.h"

namespace copse::peers {

enum class Quality { low, medium, high };  ///< Morton; binned surface area; the same with spatial splits.

/// Triangles in Embree's hands, traced ray by ray and with the kernels that it takes unasked: not the robust ones, so
/// that a ray may slip between two triangles.
class EmbreeTracer final : public PeerTracer {
 public:
  /// Copies the triangles. Throws DeviceError with Embree's own message.
  EmbreeTracer(const TrianglesView& triangles, Quality quality, int threads);
  ~EmbreeTracer() override;

  /// Phase "embree": from triangles in memory to what rays are traced with, as buildBvh() and traversalBvh() together.
  void build(const Device& device) override;
  /// What Embree allocated for its build and kept.
  std::size_t bytes() const override;
  std::size_t peakBytes() const override;

  void closest(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
               Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
           uint32_t* occluded) const override;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace copse::peers
