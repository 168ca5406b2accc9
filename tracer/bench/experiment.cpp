// The top level of the TOML and its scenes; the rows of builders are in experiment_rows.cpp.
#include "tracer/bench/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "builder/base/toml_keys.h"
#include "builder/parallel/device.h"
#include "tracer/bench/experiment_rows.h"
#include "tracer/generators/generators.h"
#include "tracer/scene/io/assemble.h"
#include "tracer/scene/io/outline.h"

namespace copse {

namespace {

constexpr int64_t maxSeed = std::numeric_limits<int64_t>::max();
constexpr int standardViews = 3;

/// "all", how many from the first on, or names.
struct ViewChoice {
  bool all = false;
  int64_t count = standardViews;
  std::vector<std::string> names;
};

ViewChoice readViews(const TomlKeys& keys, const toml::table& table, const ViewChoice& standard) {
  const toml::node* node = table.get("views");
  if (!node) return standard;
  ViewChoice choice;
  if (node->is_integer()) {
    choice.count = keys.integer("views", 1, 1000);
  } else if (node->is_string()) {
    choice.all = keys.text("views") == "all";
    if (!choice.all) choice.names = {keys.text("views")};
  } else {
    choice.names = keys.texts("views");
    if (choice.names.empty()) keys.fail("views", "'views' is empty (expected \"all\", a number, or names)");
  }
  return choice;
}

std::vector<std::string> chosen(const ViewChoice& choice, const std::vector<std::string>& there, const TomlKeys& keys) {
  if (choice.all) return there;
  if (choice.names.empty())
    return {there.begin(), there.begin() + std::min<std::ptrdiff_t>(choice.count, std::ssize(there))};
  for (const std::string& name : choice.names) {
    if (std::find(there.begin(), there.end(), name) == there.end())
      keys.fail("views", fmt::format("unknown view '{}' (available: {})", name, fmt::join(there, ", ")));
    if (std::count(choice.names.begin(), choice.names.end(), name) > 1)
      keys.fail("views", fmt::format("view '{}' is named twice", name));
  }
  return choice.names;
}

class SceneReader {
 public:
  SceneReader(Experiment& experiment, const TomlKeys& root, const ViewChoice& views)
      : experiment_(experiment), root_(root), views_(views) {
    const std::string choice = root.text("missing_scenes", "skip");
    if (choice != "skip" && choice != "fail")
      root.fail("missing_scenes", fmt::format("'missing_scenes': expected skip or fail, got '{}'", choice));
    skip_ = choice == "skip";
  }

  void read(const toml::node& node) {
    if (const auto* file = node.as_string()) {
      toml::table table;
      table.insert("file", *file);
      read(TomlKeys(experiment_.file, table, "a scene", {"file"}), table, node);
    } else if (const toml::table* table = node.as_table()) {
      read(TomlKeys(experiment_.file, *table, "a scene",
                    {"file", "instead", "generator", "triangles", "seed", "name", "views"}),
           *table, node);
    } else {
      root_.failAt(node, "expected a scene: a file name in quotes, { file = … } or { generator = … }");
    }
  }

 private:
  void read(const TomlKeys& keys, const toml::table& table, const toml::node& node) {
    if (keys.has("file") == keys.has("generator")) root_.failAt(node, "a scene needs either a file or a generator");
    for (const auto& [key, other] : {std::pair("triangles", "file"), {"seed", "file"}, {"instead", "generator"}})
      if (keys.has(key) && keys.has(other)) keys.fail(key, fmt::format("'{}' does not go with '{}'", key, other));
    ExperimentScene scene;
    SceneOutline outline;
    if (keys.has("generator")) {
      outline = generated(scene, keys, node);
    } else {
      outline = inFile(scene, keys, "file", node);
      if (!outline.missing.empty() && keys.has("instead")) {
        leaveOut(keys.text("name", outline.name), outline.missing);
        outline = inFile(scene, keys, "instead", node);
      }
    }
    scene.expected = outline.triangles;
    scene.bytes = outline.bytes;
    scene.name = keys.text("name", outline.name);
    checkName(scene.name, node);
    if (!outline.missing.empty()) {
      if (!skip_) root_.failAt(node, outline.missing);
      leaveOut(scene.name, outline.missing);
      return;
    }
    const bool ownViews = table.contains("views");
    if (experiment_.renders())
      scene.views = chosen(readViews(keys, table, views_), outline.views, ownViews ? keys : root_);
    experiment_.scenes.push_back(scene);
  }

  SceneOutline generated(ExperimentScene& scene, const TomlKeys& keys, const toml::node& node) {
    scene.generator = keys.text("generator");
    return located(node, [&] {
      const uint32_t standard = findGenerator(scene.generator).defaultTriangles;
      scene.triangles =
          static_cast<uint32_t>(keys.integer("triangles", 1, static_cast<int64_t>(maxTriangles), standard));
      scene.seed = static_cast<uint64_t>(keys.integer("seed", 0, maxSeed, 1));
      return SceneOutline{scene.generator, generatorViews(scene.generator), scene.triangles, 0, ""};
    });
  }

  SceneOutline inFile(ExperimentScene& scene, const TomlKeys& keys, const char* key, const toml::node& node) {
    const std::filesystem::path folder = std::filesystem::path(experiment_.file).parent_path();
    scene.file = (folder / keys.text(key)).lexically_normal().string();
    return located(node, [&] { return outlineOf(scene.file); });
  }

  /// Errors in a scene get the line that names it, unless they name a line already.
  template <class Work>
  SceneOutline located(const toml::node& node, Work work) const {
    try {
      return work();
    } catch (const InputError& error) {
      if (std::string_view(error.what()).starts_with(experiment_.file)) throw;
      root_.failAt(node, error.what());
    }
  }

  void leaveOut(const std::string& name, const std::string& missing) {
    experiment_.leftOut.push_back({"scene", name, missing.substr(0, missing.find('\n'))});
  }

  void checkName(const std::string& name, const toml::node& node) {
    checkKeyPart(name, "scene", [&](const std::string& what) { root_.failAt(node, what); });
    if (std::find(names_.begin(), names_.end(), name) != names_.end())
      root_.failAt(node, fmt::format("duplicate scene '{}'; give it a name of its own", name));
    names_.push_back(name);
  }

  Experiment& experiment_;
  const TomlKeys& root_;
  const ViewChoice& views_;
  bool skip_ = true;
  std::vector<std::string> names_;
};

WarmUp readWarmUp(const std::string& file, const toml::table& root, const TomlKeys& rootKeys) {
  WarmUp warmUp;
  const toml::node* node = root.get("warm_up");
  if (!node) return warmUp;
  if (!node->is_table()) rootKeys.fail("warm_up", "'warm_up': expected a table: { least, most, within, builds }");
  const TomlKeys keys(file, *node->as_table(), "warm_up", {"least", "most", "within", "builds"});
  warmUp.min = static_cast<int>(keys.integer("least", 0, 1000, warmUp.min));
  warmUp.max = static_cast<int>(keys.integer("most", 0, 1000, std::max(warmUp.min, warmUp.max)));
  if (warmUp.max < warmUp.min) keys.fail("most", "'most' is less than 'least'");
  warmUp.within = keys.number("within", warmUp.within);
  if (!(warmUp.within > 0 && warmUp.within < 1))
    keys.fail("within", fmt::format("'within': expected a number between 0 and 1, got {}", warmUp.within));
  warmUp.builds = static_cast<int>(keys.integer("builds", 0, 100, warmUp.builds));
  return warmUp;
}

/// Numbers of samples in ascending order, each once.
std::vector<int> readSpp(const TomlKeys& keys) {
  if (!keys.has("spp")) keys.fail({}, "an experiment lacks the key 'spp'; spp = [] builds trees and renders nothing");
  std::vector<int> spp;
  for (const int64_t samples : keys.integers("spp", 1, 1 << 20)) {
    if (!spp.empty() && samples <= spp.back())
      keys.fail("spp", fmt::format("'spp': expected ascending numbers, got {} after {}", samples, spp.back()));
    spp.push_back(static_cast<int>(samples));
  }
  return spp;
}

/// One number for all of `spp`, or one for each.
std::vector<int> readRepetitions(const TomlKeys& keys, std::size_t count) {
  std::vector<int> repetitions(count, 3);
  if (!keys.has("repetitions")) return repetitions;
  const std::vector<int64_t> given = keys.integers("repetitions", 1, 100'000);
  if (given.size() != 1 && given.size() != count)
    keys.fail("repetitions", fmt::format("'repetitions': expected one number, or {}, one for each of 'spp'", count));
  for (std::size_t i = 0; i < count; ++i) repetitions[i] = static_cast<int>(given[given.size() == 1 ? 0 : i]);
  return repetitions;
}

Checked readValidated(const TomlKeys& keys) {
  const std::string name = keys.text("validate", "rows");
  if (name == "rows") return Checked::rows;
  if (name == "scenes") return Checked::scenes;
  if (name == "none") return Checked::none;
  keys.fail("validate", fmt::format("'validate': expected rows, scenes or none, got '{}'", name));
}

RenderSettings readSettings(const TomlKeys& keys) {
  RenderSettings settings;
  if (keys.has("size")) {
    const std::vector<int64_t> size = keys.integers("size", 1, 8192);
    if (size.size() != 2) keys.fail("size", "'size': expected [width, height]");
    settings.width = static_cast<int>(size[0]);
    settings.height = static_cast<int>(size[1]);
  }
  settings.maxDepth = static_cast<int>(keys.integer("max_depth", 0, 1000, settings.maxDepth));
  settings.lightSamples = static_cast<int>(keys.integer("light_samples", 1, 4096, settings.lightSamples));
  settings.seed = static_cast<uint64_t>(keys.integer("seed", 0, maxSeed, 1));
  return settings;
}

std::vector<std::string> readReport(const TomlKeys& keys) {
  static const char* const known[] = {"table", "total", "iterations", "phases", "parameters", "scaling", "scatter"};
  const std::vector<std::string> names = keys.texts("report");
  for (const std::string& name : names)
    if (std::find(std::begin(known), std::end(known), name) == std::end(known))
      keys.fail("report", fmt::format("unknown figure '{}' (available: {})", name, fmt::join(known, ", ")));
  return names;
}

}  // namespace

Scene ExperimentScene::read() const {
  Scene scene;
  if (generator.empty()) {
    scene = loadScene(file, options);
  } else {
    scene = findGenerator(generator).generate(triangles, seed);
    scene.file = fmt::format("{} of {} triangles, seed {}", generator, triangles, seed);
    scene.generated = true;
  }
  scene.name = name;
  return scene;
}

Experiment readExperiment(const std::string& file, const std::string& tracer) {
  Experiment experiment;
  experiment.tracer = tracer;
  experiment.file = file;
  experiment.text = readFile(file);
  const toml::table root = parseToml(experiment.text, file);
  const TomlKeys keys(
      experiment.file, root, "an experiment",
      {"name",    "title",  "description", "report",      "scenes",    "missing_scenes",  "views",
       "builder", "set",    "spp",         "size",        "max_depth", "light_samples",   "seed",
       "tracers", "device", "threads",     "repetitions", "warm_up",   "count_traversal", "end_point_overlap",
       "validate"});
  experiment.name = keys.text("name", std::filesystem::path(file).stem().string());
  checkKeyPart(experiment.name, "experiment", [&](const std::string& what) { keys.fail("name", what); });
  experiment.title = keys.text("title", experiment.name);
  experiment.description = keys.text("description", "");
  experiment.report = readReport(keys);
  experiment.spp = readSpp(keys);
  experiment.settings = readSettings(keys);
  experiment.device = keys.text("device", "auto");
  if (!deviceChoice(experiment.device))
    keys.fail("device", fmt::format("'device': expected {}, got '{}'", deviceChoices, experiment.device));
  experiment.threads = static_cast<int>(keys.integer("threads", 0, 1024, 0));
  experiment.repetitions = readRepetitions(keys, std::max<std::size_t>(1, experiment.spp.size()));
  experiment.warmUp = readWarmUp(experiment.file, root, keys);
  experiment.validated = readValidated(keys);
  experiment.countTraversal = keys.flag("count_traversal", false);
  experiment.endPointOverlap = keys.flag("end_point_overlap", false);

  readRows(experiment, root, keys);

  const ViewChoice views = readViews(keys, root, {});
  SceneReader scenes(experiment, keys, views);
  const toml::array* list = root["scenes"].as_array();
  if (!list || list->empty()) keys.fail("scenes", "'scenes': expected an array of scenes: file names, or tables");
  for (const toml::node& node : *list) scenes.read(node);
  if (experiment.scenes.empty())
    throw InputError(fmt::format("{}: found none of its scenes: {}", file, experiment.leftOut.back().why));
  return experiment;
}

}  // namespace copse
