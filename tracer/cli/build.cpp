// copse build: the tree alone. Its phases (medians over --repeat), its cost, and its validation.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "builder/base/error.h"
#include "builder/base/statistics.h"
#include "builder/base/whole_file.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/summary.h"
#include "tracer/session/render.h"

namespace copse::cli {

namespace {

struct Options {
  std::string scene, stats;
  int repeat = 1;
  bool endPointOverlap = false;
  SceneOptions sceneOptions;
  BuilderOptions builder;
  DeviceOptions device;
};

/// Each phase's median over the builds; a phase counts as 0 in builds that lack it.
std::vector<PhaseTime> medianPhases(const std::vector<std::vector<PhaseTime>>& builds) {
  std::vector<PhaseTime> phases = builds.front();
  for (PhaseTime& phase : phases) {
    std::vector<double> times;
    for (const std::vector<PhaseTime>& build : builds) {
      const auto same = std::find_if(build.begin(), build.end(), [&](const auto& p) { return p.name == phase.name; });
      times.push_back(same == build.end() ? 0 : same->ms);
    }
    phase.ms = median(times);
  }
  return phases;
}

int run(const Options& options) {
  if (options.repeat < 1 || options.repeat > 100000)
    throw InputError(fmt::format("--repeat: expected an integer from 1 to 100000, got {}", options.repeat));
  const LoadOptions loadOptions = options.sceneOptions.load();
  const TreeSource source = options.builder.source();
  const Parameters parameters = options.builder.parameters();
  const OptimiserNames optimisers = options.builder.optimisers();
  if (options.endPointOverlap && source.isOwnTree())
    throw InputError(fmt::format("--end-point-overlap: the tree of {} cannot be inspected", options.builder.name));
  const Device device = options.builder.deviceFor(options.device);
  checkApart({{"--stats", options.stats}}, {{"SCENE", options.scene}});
  checkWritable(options.stats);
  const std::atomic<bool>& stop = stopOnSignal();

  const LoadedScene loaded = [&] {
    Progress progress("loading " + options.scene, false);
    return load(device, options.scene, LoadFor::builds, loadOptions);
  }();
  for (const std::string& note : loaded.scene.notes) say("note: {}\n", note);

  BuiltTree tree;
  std::vector<double> times;
  std::vector<std::vector<PhaseTime>> phases;
  {
    Progress progress("building " + options.builder.name, false);
    for (int i = 0; i < options.repeat; ++i) {
      if (stop) return interrupted;
      tree = BuiltTree{};  // The last tree's memory is free before the next one is built.
      tree = buildTree(device, loaded.triangles(), source, parameters, optimisers, options.builder.tracer());
      times.push_back(tree.ms);
      phases.push_back(tree.phases);
      progress.report(static_cast<double>(i + 1) / options.repeat);
    }
  }
  if (!source.isOwnTree())
    validate(device, tree.bvh, loaded.triangles(), static_cast<uint32_t>(tree.parameters->integer("leaf.max")));

  RunRecord record = recordOf(device, loaded);
  describe(device, tree, record);
  if (options.endPointOverlap) {
    Progress progress("end-point overlap", false);
    record.tree->endPointOverlap = endPointOverlapOf(device, loaded.triangles(), tree);
  }
  record.buildMs = median(times);
  record.buildPhases = medianPhases(phases);
  record.buildRepeats = options.repeat;
  printHead(record);
  print("checks   {}\n\n", source.isOwnTree()
                               ? "none: a baseline's tree cannot be inspected"
                               : "passed: every triangle in one leaf, every box around what is below it");
  printBuildPhases(record);
  if (options.repeat > 1) print("medians of {} builds\n", options.repeat);
  if (!options.stats.empty()) writeWholeFile(options.stats, toJson(record));
  return done;
}

}  // namespace

Command addBuild(CommandLine& program) {
  CommandLine command = program.addCommand("build", "Build the tree only: phases, cost and checks");
  auto options = std::make_shared<Options>();
  options->builder.name = defaultBuilder();
  command.option("SCENE", options->scene, "Scene TOML, or a bare mesh (.obj, .ply)").required();
  options->sceneOptions.add(command);
  options->builder.add(command);
  options->device.add(command);
  command.option("--repeat", options->repeat, "Number of builds; times are their medians").showDefault();
  command.flag("--end-point-overlap", options->endPointOverlap,
               "End-point overlap (Aila, Karras and Laine 2013); not timed");
  command.option("--stats", options->stats, "FILE.json: the record of the run").notEmpty();
  return [options] { return run(*options); };
}

}  // namespace copse::cli
