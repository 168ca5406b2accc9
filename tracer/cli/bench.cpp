// copse bench: the runs of an experiment, one after the other, and a folder with their results.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "builder/base/error.h"
#include "builder/base/text.h"
#include "tracer/bench/results.h"
#include "tracer/bench/runner.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/image/image_io.h"
#include "tracer/report/report.h"

namespace copse::cli {

namespace {

struct Options {
  std::string config, folder, device, tracer;
  SceneOptions scene;
  int threads = -1;
  bool resume = false;
};

/// Counts the runs of a plan that a journal holds.
Progressed progressOf(const std::vector<PlannedRun>& plan, const Journal& journal, Progressed progressed) {
  progressed.planned = plan.size();
  progressed.done = progressed.failed = 0;
  for (const Journal::Entry& entry : journal.entries()) ++(entry.failed ? progressed.failed : progressed.done);
  return progressed;
}

void printPlan(const Experiment& experiment, const Device& device, const std::vector<PlannedRun>& plan,
               const std::string& folder) {
  print("{}\n", experiment.title);
  for (const LeftOut& left : experiment.leftOut) say("note: {} {} is left out: {}\n", left.kind, left.name, left.why);
  print("device   {}: {}, {} threads\n", device.kindName(), device.name, device.threads);
  std::string names;
  for (const ExperimentScene& scene : experiment.scenes) names += (names.empty() ? "" : ", ") + scene.name;
  print("scenes   {}\n", names);
  names.clear();
  for (const ExperimentBuilder& row : experiment.builders) names += (names.empty() ? "" : ", ") + row.label;
  print("builders {}\n", experiment.builders.size() > 24 ? fmt::format("{} rows", experiment.builders.size()) : names);
  std::size_t views = 0;
  for (const ExperimentScene& scene : experiment.scenes) views += scene.views.size();
  const std::size_t rows = experiment.builders.size(), scenes = experiment.scenes.size();
  if (experiment.renders()) {
    std::string samples;
    for (std::size_t i = 0; i < experiment.spp.size(); ++i)
      samples += fmt::format("{}{} × {} spp", i ? " + " : "", experiment.repetitions[i], experiment.spp[i]);
    print("runs     {} views of {} scenes × {} builders × ({}) = {} runs, {}x{}\n", views, scenes, rows, samples,
          grouped(plan.size()), experiment.settings.width, experiment.settings.height);
  } else {
    print("runs     {} scenes × {} builders × {} repetitions = {} runs, trees alone\n", scenes, rows,
          experiment.repetitions.front(), grouped(plan.size()));
  }
  print("folder   {}\n", folder);
}

/// What the terminal shows: progress and the time left.
class TerminalProgress {
 public:
  TerminalProgress(const Experiment& experiment, std::size_t runs) : experiment_(experiment), runs_(runs) {}

  LoopEvents events(const std::atomic<bool>& stop) {
    LoopEvents events;
    events.stop = &stop;
    events.loading = [this](std::size_t scene) {
      bar_.emplace(fmt::format("loading {} and warming up", experiment_.scenes[scene].name), false);
    };
    events.warm = [this](std::size_t scene, int discarded, double left, bool measured) {
      bar_.reset();
      say("{}: {} warm-up runs; about {} left{}\n", experiment_.scenes[scene].name, discarded,
          durationText(left / 1000), measured ? "" : " (rough estimate)");
    };
    events.before = [this](const PlannedRun& run, std::size_t number, double left) {
      bar_.reset();  // The previous bar is erased before the next is drawn.
      bar_.emplace(fmt::format("{} of {}, {} left: {}", number, runs_, durationText(left / 1000), run.key), false);
    };
    events.during = [this](double done) {
      if (bar_) bar_->report(done);
    };
    events.failed = [this](const PlannedRun& run, const std::string& error) {
      bar_.reset();
      say("failed: {}, repetition {}: {}\n", run.key, run.repetition, error);
    };
    return events;
  }

 private:
  const Experiment& experiment_;
  std::size_t runs_;
  std::optional<Progress> bar_;
};

/// A failure to make the page loses no results: `copse report` can make it from them.
void report(const std::string& folder) {
  try {
    const ReportFiles files = writeReport(folder);
    print("report   {}\n", files.page);
    if (!files.note.empty()) say("note: {}\n", files.note);
  } catch (const std::exception& error) {
    say("warning: no report was made: {}\n", error.what());
  }
}

int finish(const std::string& folder, const Experiment& experiment, const Device& device, const Journal& journal,
           Progressed progressed, bool complete) {
  if (complete && progressed.finished.empty()) progressed.finished = timeNow();
  writeResults(folder, journal.entries());
  writeExperimentJson(folder, experiment, device, progressed);
  if (!journal.entries().empty()) print("{}", resultsTable(journal.entries()));
  const std::size_t made = progressed.done + progressed.failed;
  print("\n{} of {} runs done{}\n", progressed.done, progressed.planned,
        progressed.failed ? fmt::format(", {} failed", progressed.failed) : "");
  print("results  {0}/results.json, {0}/results.csv\n", folder);
  if (!complete) {
    say("interrupted: {} runs are left; continue with --resume\n", progressed.planned - made);
    return interrupted;
  }
  report(folder);
  return progressed.failed ? failedCheck : done;
}

int run(const Options& options) {
  const LoadOptions sceneOptions = options.scene.load();
  Experiment experiment = readExperiment(options.config, options.tracer);
  for (ExperimentScene& scene : experiment.scenes) scene.options = sceneOptions;
  DeviceOptions chosen;
  chosen.device = options.device.empty() ? experiment.device : options.device;
  chosen.threads = options.threads < 0 ? experiment.threads : options.threads;
  const Device device = chosen.open();
  leaveOutBaselines(experiment, device);
  const std::vector<PlannedRun> plan = planOf(experiment);
  const std::string folder = options.folder.empty() ? "out/" + experiment.name : options.folder;

  Progressed progressed;
  const bool begun = holdsExperiment(folder);
  if (begun && !options.resume)
    throw InputError(
        fmt::format("{}: already holds results; continue with --resume, or name another folder with -o", folder));
  if (begun) progressed = checkSameExperiment(folder, experiment, device);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: {}", folder, error.message()));
  if (!begun) {
    progressed.planned = plan.size();
    progressed.started = timeNow();
    writeExperimentJson(folder, experiment, device, progressed);
  }
  Journal journal(folder + "/results.jsonl");
  progressed = progressOf(plan, journal, progressed);
  if (!progressed.finished.empty() && progressed.done + progressed.failed == plan.size()) {
    print("{}: all of its {} runs are done{}; nothing is left to do\n", folder, plan.size(),
          progressed.failed ? fmt::format(", {} of them failed", progressed.failed) : "");
    if (!std::filesystem::exists(folder + "/report.html", error)) report(folder);  // Killed before its page was made.
    return progressed.failed ? failedCheck : done;
  }

  const std::atomic<bool>& stop = stopOnSignal();
  printPlan(experiment, device, plan, folder);
  if (begun) print("resumed  {} runs are done, {} failed\n", progressed.done, progressed.failed);
  print("time     about {} (rough estimate without loading; improves with the first runs)\n",
        durationText(Estimate(experiment, device).of(plan) / 1000 *
                     (1 - static_cast<double>(journal.entries().size()) / static_cast<double>(plan.size()))));
  if (experiment.renders() && !hasOpenImageIO()) say("note: no images are written: {}\n", whyNoOpenImageIO());
  std::fflush(stdout);

  bool complete = false;
  {
    MeasuringRunner runner(experiment, device, folder + "/images");
    TerminalProgress shown(experiment, plan.size());
    complete = runAll(experiment, device, plan, journal, runner, shown.events(stop));
  }
  return finish(folder, experiment, device, journal, progressOf(plan, journal, progressed), complete);
}

}  // namespace

Command addBench(CommandLine& program) {
  CommandLine command = program.addCommand("bench", "Run an experiment: scenes × views × builders × spp");
  auto options = std::make_shared<Options>();
  command.option("CONFIG", options->config, "The experiment's TOML, such as configs/quick.toml").required();
  command.option("-o,--output", options->folder, "Folder for the results; out/NAME by default").notEmpty();
  command.option("--device", options->device, "auto, cuda or cpu; replaces CONFIG's").notEmpty();
  command.option("--tracer", options->tracer, "Tracer, see `copse list tracers`; replaces CONFIG's").notEmpty();
  options->scene.add(command);
  command.option("--threads", options->threads, "CPU threads, 0 for all; replaces CONFIG's").range(0, 1024);
  command.flag("--resume", options->resume, "Continue with the runs that the folder lacks");
  return [options] { return run(*options); };
}

}  // namespace copse::cli
