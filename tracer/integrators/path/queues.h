// The arrays that a batch of paths lives in: structures of arrays of fixed size, allocated once per render.
#pragma once

#include <algorithm>

#include "builder/parallel/buffer.h"
#include "tracer/integrators/path/shade.h"

namespace copse {

struct PathQueueBuffers {
  Buffer<Ray> rays;
  Buffer<vec4> throughput;
  Buffer<uint32_t> slots;

  PathQueueBuffers(const Device& device, uint32_t paths)
      : rays(device, paths), throughput(device, paths), slots(device, paths) {}
  PathQueue view() const { return {rays.data(), throughput.data(), slots.data()}; }
};

/// 168 + 84 lightSamples bytes per path in flight.
struct Queues {
  uint32_t capacity;
  PathQueueBuffers paths, packed;
  Buffer<Hit> hits;
  Buffer<uint64_t> keys;  ///< Per slot, as is radiance.
  Buffer<vec3> radiance;
  Buffer<uint64_t> onward;  ///< Per hit (see Onward); then their prefix sums, followed by the total.
  Buffer<Ray> shadowRays, shadowPacked;
  Buffer<vec3> shadowLight;
  Buffer<uint32_t> occluded;

  Queues(const Device& device, uint32_t capacity, uint32_t lightSamples)
      : capacity(capacity),
        paths(device, capacity),
        packed(device, capacity),
        hits(device, capacity),
        keys(device, capacity),
        radiance(device, capacity),
        onward(device, std::size_t{capacity} + 1),
        shadowRays(device, std::size_t{capacity} * lightSamples),
        shadowPacked(device, std::size_t{capacity} * lightSamples),
        shadowLight(device, std::size_t{capacity} * lightSamples),
        occluded(device, std::size_t{capacity} * lightSamples) {}
};

/// Paths in flight where `asked` is 0: on CUDA enough for a whole picture of 1024x768 at 8 spp, as each batch ends with
/// launches that do not fill the card; the CPU's speed does not depend on it between 2^12 and 2^18. Fewer where each
/// has many light samples, so that memory is bounded.
inline uint32_t queueCapacity(const Device& device, uint64_t work, int lightSamples, uint32_t asked) {
  uint64_t paths = asked ? asked : device.isCuda() ? 7u << 20 : std::clamp(device.threads << 15, 1 << 16, 1 << 18);
  const uint64_t samples = static_cast<uint64_t>(lightSamples);
  paths = std::min(paths, std::max<uint64_t>(1, (device.isCuda() ? 1u << 24 : 1u << 21) / samples));
  return static_cast<uint32_t>(std::min(paths, work));
}

}  // namespace copse
