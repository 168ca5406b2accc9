// Who answers rays for the path tracer: the tree of this project, or a peer that is measured against it.
#pragma once

#include <optional>

#include "builder/parallel/device.h"
#include "tracer/accel/persistent.h"
#include "tracer/accel/ray.h"
#include "tracer/accel/traversal_bvh.h"

namespace copse {

/// Batches of rays. All arrays are in the device's memory. Of the `most` rays the first min(most, *count) are traced;
/// `count` is in the device's memory as well, or null for all of them. `name` is the launch's name and phase.
class RayTracer {
 public:
  virtual ~RayTracer() = default;
  virtual void closest(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
                       Hit* hits) const = 0;
  /// occluded[i] is 1 where anything is hit, otherwise 0.
  virtual void any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
                   uint32_t* occluded) const = 0;
};

/// Rays through a TraversalBvh, which must outlive it. On the CPU ray by ray, through wide nodes where it has them; on
/// CUDA by persistent warps through the binary ones, whose loads are shorter. Batches are to be on `device`.
class BvhRayTracer final : public RayTracer {
 public:
  BvhRayTracer(const Device& device, const TraversalView& view,
               const PersistentSettings& settings = PersistentSettings());
  void closest(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
               Hit* hits) const override;
  void any(const Device& device, const char* name, uint32_t most, const uint32_t* count, const Ray* rays,
           uint32_t* occluded) const override;

 private:
  TraversalView view_;
  std::optional<PersistentTracer> persistent_;  ///< On CUDA.
};

}  // namespace copse
