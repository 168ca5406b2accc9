// What is to be measured: scenes × views × builders × tracers × samples a pixel, read from a TOML file and checked as a
// whole before anything runs. The keys are in docs/bench.md.
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

/// Either a file or a generator's.
struct ExperimentScene {
  std::string name;
  std::string file;       ///< As the program opens it: beside the experiment's file.
  std::string generator;  ///< "" where it is a file.
  uint32_t triangles = 0;
  uint64_t seed = 1;
  uint64_t expected = 0;           ///< Triangles, where that is known before the scene is read.
  uint64_t bytes = 0;              ///< Of the files of its meshes.
  std::vector<std::string> views;  ///< Those to be rendered; empty where nothing is.

  /// Throws InputError as loadScene does. Carries `name`.
  Scene read() const;
};

/// A row of the table: a builder with its parameters, and what rays through its trees go through.
struct ExperimentBuilder {
  std::string label;  ///< No two rows have the same.
  TreeSource source;
  TracerChoice tracer = {};
  Parameters parameters = Parameters(tracerParameters());
  OptimiserNames optimisers = {};  ///< Run after the builder's own.
};

/// Runs that are thrown away when a scene is loaded: the first row's, of the first view at the fewest samples, until
/// the median of the last three is within `within` of the median of the three that ended one before; then `builds`
/// trees of every row.
struct WarmUp {
  int least = 4, most = 10;
  double within = 0.03;
  int builds = 1;
};

/// Whose trees are checked by validate(), which runs on one thread of the host and takes longer than most builds.
enum class Checked {
  rows,    ///< The first tree of every row, in every scene.
  scenes,  ///< A scene's first tree: for a device whose trees are compared with the CPU's elsewhere.
  none,
};

/// What was asked for and cannot be measured here, and why.
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
  std::string tracer;       ///< In place of the rows' own; "" for these.
  std::string device = "auto";
  int threads = 0;
  std::vector<int> repetitions;  ///< One for each of `spp`; a single one where nothing is rendered.
  WarmUp warmUp;
  Checked validated = Checked::rows;
  bool countTraversal = false, endPointOverlap = false;  ///< As the options of `copse render`; once a row.
  std::vector<LeftOut> leftOut;

  bool renders() const { return !spp.empty(); }
};

/// Throws InputError "FILE:LINE: what" for whatever is wrong, and where no scene or no builder is left. Where a scene's
/// files are not there the scene that it names as `instead` takes its place; one without is left out, or is an error
/// where `missing_scenes` is "fail". `tracer` takes the place of all that the file says of tracers for builders' trees,
/// where it is not "".
Experiment readExperiment(const std::string& file, const std::string& tracer = "");

/// Takes the rows that this device cannot run out of the table. Throws InputError where none is left.
void leaveOutBaselines(Experiment& experiment, const Device& device);

/// Every row that `set` stands for: the product of the values of its keys, the last key fastest.
/// Each is the list of (name, value) in the order of the keys.
using ParameterRow = std::vector<std::pair<std::string, ParameterValue>>;
std::vector<ParameterRow> crossProduct(const std::vector<std::pair<std::string, std::vector<ParameterValue>>>& keys);

}  // namespace copse
