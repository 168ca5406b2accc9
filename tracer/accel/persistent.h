// Batches of rays by persistent warps: Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs (2009),
// with their later kernels' postponed leaf and dynamic fetch (2012). For CUDA; on the CPU 32 fibers, for tests.
#pragma once

#include <vector>

#include "builder/parallel/buffer.h"
#include "builder/parameters.h"
#include "tracer/accel/ray.h"

namespace copse {

/// How warps share rays: the parameters trace.leave, trace.fetch and trace.blocks. Hits do not depend on them.
struct PersistentSettings {
  uint32_t leave;   ///< A warp tests leaves once at most this many lanes still look for one, if another has one.
  uint32_t fetch;   ///< Idle lanes fetch rays where fewer lanes than this have one.
  uint32_t blocks;  ///< Blocks of four warps per multiprocessor; 0: as many as it has registers for.

  explicit PersistentSettings(const Parameters& parameters = {});
};

/// trace.leave, trace.fetch and trace.blocks, and the CPU's trace.simd.
std::vector<ParameterSpec> traceParameters();

/// Traces on any device, through any Format of tracer/accel. Launches share their counters: not for two streams at a
/// time.
template <class Format>
class PersistentTracer {
 public:
  using View = typename Format::View;
  explicit PersistentTracer(const Device& device, const PersistentSettings& settings = PersistentSettings());

  /// As in RayTracer.
  void closest(const Device& device, const char* name, const View& view, uint32_t count, const Ray* rays,
               Hit* hits) const;
  void any(const Device& device, const char* name, const View& view, uint32_t count, const Ray* rays,
           uint32_t* occluded) const;

 private:
  PersistentSettings settings_;
  uint32_t closestWarps_, anyWarps_;  ///< Resident on the device at a time.
  Buffer<uint32_t> counters_;         ///< 0 between launches.
};

}  // namespace copse
