// What one run was and what it cost: the record that `--stats` writes, an EXR carries and results are made of.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "builder/build.h"
#include "builder/parallel/timeline.h"
#include "tracer/integrators/settings.h"
#include "tracer/scene/scene.h"

namespace copse {

struct TreeRecord {
  std::optional<TreeStatistics> statistics;  ///< None for a tracer's own tree.
  std::size_t bytes = 0;                     ///< The size of the nodes and triangles that rays read.
  std::optional<double> endPointOverlap;
  std::optional<double> wideCost = {};  ///< Of the tree that rays read; none where its nodes are not wide.
};

struct ImageRecord {
  std::string file, view, integrator;
  RenderSettings settings;
  double samplesDone = 0;                                    ///< Less than settings.spp where the render was stopped.
  std::vector<std::pair<std::string, double>> figures = {};  ///< Further figures of the picture, by name.
  Camera camera = {};  ///< In the coordinates of the scene's files: see inFiles().
};

/// The runs that a render goes on from, together: their figures are kept apart from those of the run itself.
struct EarlierRuns {
  int runs = 0;
  double samplesDone = 0;  ///< Per pixel, by all of them.
  double loadMs = 0, buildMs = 0, renderMs = 0;
  RayCounts rays;
};

/// Which run of an experiment this is.
struct RunIdentity {
  std::string key;    ///< "SCENE/VIEW/LABEL/SPP"; without the view and the spp where nothing was rendered.
  std::string label;  ///< The builder's name, or the experiment's own for a row with parameters.
  int repetition = 1;
  std::string experiment;
  int warmUp = 0;     ///< Runs that were discarded before this one.
  std::string error;  ///< Why the run failed; "" where it is done.
};

/// Times in milliseconds. `tree`, `image` and `rays` are left out where the run had none. A run that failed has no tree
/// and no times; its `image` is what was requested.
struct RunRecord {
  std::optional<RunIdentity> run;
  std::string sceneName, sceneFile;
  bool sceneGenerated = false;  ///< Some of its triangles come from a generator.
  LoadOptions sceneOptions;
  uint64_t sceneHash = 0;  ///< 0 where nothing was rendered.
  uint64_t triangles = 0;
  uint32_t emitters = 0;
  Device device;
  std::string builder;
  OptimiserNames optimisers;  ///< Those requested in addition to the builder's own.
  std::string tracer;         ///< A row of the registry; "" for the reference integrator and where it is not known.
  std::optional<Parameters> parameters;  ///< None for the reference integrator and for a tracer's own tree.
  std::optional<TreeRecord> tree;
  std::optional<ImageRecord> image;
  std::optional<EarlierRuns> earlier;  ///< If the image goes on from another.
  double loadMs = 0, buildMs = 0;
  uint64_t buildPeakBytes = 0;  ///< Peak device memory of the build; 0 where it was not measured.
  std::vector<PhaseTime> buildPhases;
  int buildRepeats = 1;  ///< Times are medians over this many builds.
  double renderMs = 0;
  std::vector<PhaseTime> renderPhases;
  std::optional<RayCounts> rays;
  std::optional<TraversalRecord> traversal;

  bool failed() const { return run && !run->error.empty(); }
  /// The time to image.
  double totalMs() const { return buildMs + renderMs; }
};

/// Millions of rays per second, over the time of the kernels that trace them; negative where nothing was traced or
/// timed.
struct RayRates {
  double primary = -1, bounce = -1, shadow = -1, all = -1;
};
RayRates rayRates(const RunRecord& record);

/// The record as JSON of schema 1, with the machine, the compiler and the process's memory at the time of the call.
/// Ends in a newline, its only one where it is `compact`.
std::string toJson(const RunRecord& record, bool compact = false);

/// The parts of a record that say where it was made: copse, machine, device and compiler, as one JSON object.
std::string environmentJson(const Device& device);

/// A scene's hash as the record has it: 16 hexadecimal digits.
std::string hashText(uint64_t hash);

/// "2026-01-31T12:00:00Z", now.
std::string timeNow();

}  // namespace copse
