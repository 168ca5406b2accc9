// What is to be measured: scenes × views × builders × tracers × samples per pixel, read from a TOML file and checked as
// a whole before anything runs. The keys are in docs/bench.md.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "builder/parallel/device.h"
#include "tracer/accel/tracers.h"
#include "tracer/integrators/parameters.h"
#include "tracer/integrators/settings.h"
#include "tracer/scene/scene.h"

namespace copse {

/// Either from a file or from a generator.
struct ExperimentScene {
  std::string name;
  std::string file;       ///< As the program opens it: relative paths start at the experiment's file.
  std::string generator;  ///< "" for a file.
  uint32_t triangles = 0;
  uint64_t seed = 1;
  uint64_t expected = 0;           ///< Triangles, where that is known before the scene is read.
  uint64_t bytes = 0;              ///< The size of its mesh files.
  std::vector<std::string> views;  ///< Those to render; empty where nothing is rendered.
  LoadOptions options = {};

  /// Throws InputError as loadScene does. Carries `name`.
  Scene read() const;
};

/// A row of the table: a builder with its parameters, and the tracer of its trees.
struct ExperimentBuilder {
  std::string label;  ///< No two rows have the same.
  TreeSource source;
  TracerChoice tracer = {};
  Parameters parameters = Parameters(tracerParameters());
  OptimiserNames optimisers = {};  ///< Run after the builder's own.
};

/// Runs that are discarded when a scene has been loaded: the first row's, of the first view at the lowest spp, until
/// the median of the last three is within `within` of the median of the three that ended one before, but from `min` to
/// `max` of them; then `builds` trees of every row.
struct WarmUp {
  int min = 4, max = 10;
  double within = 0.03;
  int builds = 1;
};

/// Whose trees are checked by validate(), which runs on one thread of the host and takes longer than most builds.
enum class Checked {
  rows,    ///< The first tree of every row, in every scene.
  scenes,  ///< A scene's first tree: enough for a device whose trees are compared with the CPU's elsewhere.
  none,
};

/// What was requested and cannot be measured here, and why.
struct LeftOut {
  std::string kind, name, why;  ///< kind: "scene" or "builder".
};

struct Experiment {
  std::string file, text;  ///< The TOML, whole.
  std::string name, title, description;
  std::vector<std::string> report;
  std::vector<ExperimentScene> scenes;
  std::vector<ExperimentBuilder> builders;
  std::vector<int> spp;     ///< Ascending; empty where trees are built and nothing is rendered.
  RenderSettings settings;  ///< Its spp is not used.
  std::string tracer;       ///< Replaces the rows' own; "" keeps them.
  std::string device = "auto";
  int threads = 0;
  std::vector<int> repetitions;  ///< One for each of `spp`; a single one where nothing is rendered.
  WarmUp warmUp;
  Checked validated = Checked::rows;
  bool countTraversal = false, endPointOverlap = false;  ///< As the options of `copse render`; once per row.
  std::vector<LeftOut> leftOut;

  bool renders() const { return !spp.empty(); }
};

/// Throws InputError "FILE:LINE: what" for any error, and where no scene or no builder is left. A scene whose files are
/// missing is replaced by its `instead`; without that it is left out, or is an error where `missing_scenes` is "fail".
/// `tracer`, unless "", replaces all tracers in the file for builders' trees.
Experiment readExperiment(const std::string& file, const std::string& tracer = "");

/// Removes the rows that this device cannot run. Throws InputError where none is left.
void leaveOutBaselines(Experiment& experiment, const Device& device);

/// Every row that `set` stands for: the product of the values of its keys, the last key fastest.
/// Each is the list of (name, value) in the order of the keys.
using ParameterRow = std::vector<std::pair<std::string, ParameterValue>>;
std::vector<ParameterRow> crossProduct(const std::vector<std::pair<std::string, std::vector<ParameterValue>>>& keys);

}  // namespace copse
