// Who answers rays for the integrators.
#pragma once

#include "builder/bvh.h"
#include "builder/parallel/device.h"
#include "tracer/accel/ray.h"

namespace copse {

/// Batches of `count` rays. All arrays are in the device's memory. `name` is the launch's name and phase. Nothing waits
/// for the device.
class RayTracer {
 public:
  virtual ~RayTracer() = default;
  /// hits[i] is the closest hit of rays[i].
  virtual void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const = 0;
  /// occluded[i] is 1 where anything is hit, otherwise 0.
  virtual void any(const Device& device, const char* name, uint32_t count, const Ray* rays,
                   uint32_t* occluded) const = 0;
};

/// What a ray visited. A node is one whose children's boxes were tested; a triangle is one that was tested, and counts
/// each time. A ray of 2^32 steps would take minutes by itself.
struct RaySteps {
  uint32_t nodes, triangles;
};

/// Answers as a RayTracer does and says what each ray visited: steps[i] of rays[i]. It takes one node at a time on
/// every device and each ray by itself, the nearer child first, so that the counts depend on the tree and the rays
/// alone. Slower than a RayTracer.
class StepTracer {
 public:
  virtual ~StepTracer() = default;
  virtual void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits,
                       RaySteps* steps) const = 0;
  virtual void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded,
                   RaySteps* steps) const = 0;
};

/// A ray tracer of the registry (tracers.h), made for a scene's triangles, and to be built before it is asked.
class TreeTracer : public RayTracer {
 public:
  /// Makes what rays read: out of `bvh`, in a format of its own, or by a tracer that builds its own tree out of the
  /// triangles alone. On `device`; phases in its timeline.
  virtual void build(const Device& device, const Bvh& bvh, const TrianglesView& triangles) = 0;
  /// Its row of the registry, or the one that auto has come to, which may depend on what was built.
  virtual const char* name() const = 0;
  /// Of what rays read.
  virtual std::size_t bytes() const = 0;
  /// Memory that build() held at a time beside the device's own, which counts for itself.
  virtual std::size_t foreignPeakBytes() const { return 0; }
  /// Null where it does not say what rays visit.
  virtual const StepTracer* stepTracer() const { return nullptr; }
};

}  // namespace copse
