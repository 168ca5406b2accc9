// What integrators trace rays with.
#pragma once

#include <optional>

#include "builder/bvh.h"
#include "builder/parallel/device.h"
#include "tracer/accel/ray.h"

namespace copse {

/// Batches of `count` rays. All arrays are in the device's memory. `name` is the launch's name and phase. No call waits
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
/// each time. 32 bits are enough: a ray of 2^32 steps would take minutes.
struct RaySteps {
  uint32_t nodes, triangles;
};

/// Traces as a RayTracer does and counts what each ray visits: steps[i] for rays[i]. On every device it visits one node
/// at a time, for one ray at a time, the nearer child first, so that the counts depend on the tree and the rays alone.
/// Slower than a RayTracer.
class StepTracer {
 public:
  virtual ~StepTracer() = default;
  virtual void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits,
                       RaySteps* steps) const = 0;
  virtual void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded,
                   RaySteps* steps) const = 0;
};

/// A ray tracer of the registry (tracers.h), made for a scene's triangles. build() comes before any query.
class TreeTracer : public RayTracer {
 public:
  /// Makes what rays read: `bvh` in the tracer's format, or a tree of its own over the triangles alone. On `device`;
  /// phases in its timeline.
  virtual void build(const Device& device, const Bvh& bvh, const TrianglesView& triangles) = 0;
  /// Its row of the registry; for auto the one that it chose, which may depend on the tree.
  virtual const char* name() const = 0;
  /// The size of what rays read.
  virtual std::size_t bytes() const = 0;
  /// Peak memory of build() that the device's allocator does not see.
  virtual std::size_t foreignPeakBytes() const { return 0; }
  /// The expected cost of a ray through wide nodes, as WideRule weighs them; none where nodes are not wide. Waits for
  /// the device.
  virtual std::optional<double> wideCost(const Device&) const { return std::nullopt; }
  /// Null where it cannot count what rays visit.
  virtual const StepTracer* stepTracer() const { return nullptr; }
};

}  // namespace copse
