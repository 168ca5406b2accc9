// What one run was and what it took: the record that `--stats` writes, that an EXR carries and that results are made
// of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/build.h"
#include "builder/parallel/timeline.h"
#include "tracer/path/path_tracer.h"
#include "tracer/scene/settings.h"

namespace copse {

struct TreeRecord {
  TreeStatistics statistics;
  std::size_t bytes = 0;  ///< Of the nodes and triangles that rays read.
};

struct ImageRecord {
  std::string file, view, integrator;
  RenderSettings settings;
  double samplesDone = 0;  ///< Less than settings.spp where the render was stopped.
};

/// Times in milliseconds. `tree`, `image` and `rays` are left out where the run had none.
struct RunRecord {
  std::string sceneName;
  uint64_t triangles = 0;
  uint32_t emitters = 0;
  Device device;
  std::string builder;
  std::optional<Parameters> parameters;  ///< None for the reference integrator, which has a tree of its own.
  std::optional<TreeRecord> tree;
  std::optional<ImageRecord> image;
  double loadMs = 0, buildMs = 0;
  std::vector<PhaseTime> buildPhases;
  int buildRepeats = 1;  ///< Times are medians over so many builds.
  double renderMs = 0;
  std::vector<PhaseTime> renderPhases;
  std::optional<RayCounts> rays;

  /// The time to image.
  double totalMs() const { return buildMs + renderMs; }
};

/// Millions of rays a second of the kernels that trace them; negative where nothing was traced or nothing was timed.
struct RayRates {
  double primary = -1, bounce = -1, shadow = -1, all = -1;
};
RayRates rayRates(const RunRecord& record);

/// The record as JSON of schema 1, at the time of the call.
std::string toJson(const RunRecord& record);

}  // namespace copse
