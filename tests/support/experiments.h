// Experiments that a test writes, and a runner that takes no time.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "builder/base/error.h"
#include "tests/support/files.h"
#include "tests/support/small_scene.h"
#include "tracer/bench/run_loop.h"

namespace copse::test {

/// What a TOML says as an experiment; `more` comes before its [[builder]] tables.
struct ExperimentFolder : Folder {
  ExperimentFolder() { putSmallScene(*this); }

  std::string write(const std::string& text) const {
    putBytes(*this / "x.toml", text);
    return *this / "x.toml";
  }
  Experiment read(const std::string& text) const { return readExperiment(write(text)); }
  /// The message without the folder; "" if there is no error.
  std::string errorOf(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      std::string what = error.what();
      const std::string folder = *this / "";
      for (std::size_t at; (at = what.find(folder)) != std::string::npos;) what.erase(at, folder.size());
      return what;
    }
    return "";
  }
};

inline const std::string lbvhRow = "[[builder]]\nname = \"lbvh\"\n";

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

inline const char* const smallExperiment =
    "name = \"small\"\n"
    "scenes = [\"small.toml\", { generator = \"cornell\", views = 1 }]\n"
    "spp = [1, 4]\n"
    "size = [16, 12]\n"
    "repetitions = 2\n"
    "[[builder]]\nname = \"lbvh\"\n"
    "[[builder]]\nname = \"sah\"\n"
    "[[builder]]\nname = \"kmeans-q1\"\n";

/// Records its calls; `fails` may throw in place of a run.
class FakeRunner : public Runner {
 public:
  explicit FakeRunner(const Experiment& experiment) : experiment_(experiment) {}

  std::function<void(const PlannedRun&)> before;
  std::vector<std::string> calls;  ///< "load NAME", "warm KEY…", "KEY".

  void load(std::size_t scene) override {
    loaded_ = scene;
    calls.push_back("load " + experiment_.scenes[scene].name);
  }
  Outcome run(const PlannedRun& run, const Watch&) override {
    calls.push_back(run.repetition == 0 ? "warm " + experiment_.builders[run.builder].label : run.key);
    if (before) before(run);
    RunRecord record;
    record.sceneName = experiment_.scenes[loaded_].name;
    record.builder = experiment_.builders[run.builder].source.name();
    record.parameters = experiment_.builders[run.builder].parameters;
    TreeStatistics tree;
    tree.sahCost = 10.0 + static_cast<double>(run.builder);
    record.tree = TreeRecord{tree, 100, {}};
    record.buildMs = 2.0 * static_cast<double>(run.builder + 1);
    if (run.spp > 0) {
      RenderSettings settings = experiment_.settings;
      settings.spp = run.spp;
      record.renderMs = 100.0 * run.spp + run.repetition;
      record.image = ImageRecord{"", experiment_.scenes[loaded_].views[run.view], "path", settings, 1.0 * run.spp};
      record.rays = RayCounts{1000, 2000, 3000};
    }
    return {record, true};
  }

 private:
  const Experiment& experiment_;
  std::size_t loaded_ = 0;
};

}  // namespace copse::test
