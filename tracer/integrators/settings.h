// The settings and the counts of a render, by any integrator.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace copse {

struct RenderSettings {
  int width = 1024, height = 768;
  int spp = 8;
  /// Surface hits that are lit, the camera ray's being the first; 0 shows only what emits.
  int maxDepth = 8;
  int lightSamples = 2;  ///< Shadow rays per hit.
  uint64_t seed = 1;
};

/// How a long job is watched and stopped.
struct Watch {
  std::function<void(double done)> progress;  ///< 0 … 1; may be empty. Called from one thread.
  const std::atomic<bool>* stop = nullptr;    ///< Polled between batches; the image so far is returned.
};

struct RayCounts {
  uint64_t primary = 0, bounce = 0, shadow = 0;
};

/// Nodes visited and triangles tested, each per ray.
struct TraversalCounts {
  double nodes = 0, triangles = 0;
};

/// Per kind of ray; none where there was no ray of the kind.
struct TraversalRecord {
  std::optional<TraversalCounts> primary, bounce, shadow;
  std::string countedBy;  ///< How, in words.
};

}  // namespace copse
