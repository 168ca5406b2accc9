// Load, warm up, measure, write down.
#include "tracer/bench/run_loop.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "builder/base/statistics.h"
#include "builder/build.h"

namespace copse {

namespace {

class Loop {
 public:
  Loop(const Experiment& experiment, const Device& device, const std::vector<PlannedRun>& plan, Journal& journal,
       Runner& runner, const LoopEvents& events)
      : experiment_(experiment),
        device_(device),
        plan_(plan),
        journal_(journal),
        runner_(runner),
        events_(events),
        estimate_(experiment, device) {
    watch_.stop = events.stop;
    if (events.during) watch_.progress = events.during;
  }

  bool all() {
    for (next_ = 0; next_ < plan_.size(); ++next_) {
      const PlannedRun& run = plan_[next_];
      if (journal_.holds(run.key, run.repetition)) continue;
      if (run.scene != loaded_) load(run);
      if (stopped()) return false;
      if (events_.before) events_.before(run, next_ + 1, left());
      if (!one(run)) return false;
    }
    return true;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  bool stopped() const { return events_.stop && *events_.stop; }

  /// Calls `work` and returns the message of what it throws, "" for nothing.
  template <class Work>
  static std::string errorOf(Work work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      return "out of memory";
    } catch (const std::exception& error) {
      return *error.what() ? error.what() : "an error without a text";
    }
    return "";
  }

  void load(const PlannedRun& run) {
    loaded_ = run.scene;
    discarded_ = 0;
    if (events_.loading) events_.loading(run.scene);
    sceneError_ = errorOf([&] { runner_.load(run.scene); });
    if (!sceneError_.empty()) return;
    // A run that fails here fails when it is measured, and is recorded then.
    errorOf([&] { warmUp(run.scene); });
    if (events_.warm && !stopped()) events_.warm(run.scene, discarded_, left(), estimate_.measured());
  }

  void warmUp(std::size_t scene) {
    const WarmUp& rule = experiment_.warmUp;
    const PlannedRun first{scene, 0, 0, experiment_.renders() ? experiment_.spp.front() : 0, 0, ""};
    std::vector<double> times;
    while (static_cast<int>(times.size()) < rule.max && !stopped() &&
           (static_cast<int>(times.size()) < rule.min || !isSteady(times, rule.within)))
      times.push_back(discard(first));
    for (std::size_t builder = 0; builder < experiment_.builders.size(); ++builder)
      for (int i = 0; i < rule.builds && !stopped(); ++i) errorOf([&] { discard({scene, 0, builder, 0, 0, ""}); });
  }

  double discard(const PlannedRun& run) {
    const Runner::Outcome outcome = runner_.run(run, {{}, events_.stop});
    if (!outcome.complete) return 0;
    ++discarded_;
    estimate_.learn(run, outcome.record.buildMs, outcome.record.renderMs);
    return outcome.record.totalMs();
  }

  /// False where it was stopped.
  bool one(const PlannedRun& run) {
    Runner::Outcome outcome;
    const std::string error = !sceneError_.empty() ? sceneError_ : errorOf([&] {
      outcome = runner_.run(run, watch_);
      if (outcome.complete) runner_.keep(run);
    });
    if (error.empty() && !outcome.complete) return false;
    RunRecord& record = outcome.record;
    if (!error.empty()) record = asked(run);
    const std::string& label = experiment_.builders[run.builder].label;
    record.run = RunIdentity{run.key, label, run.repetition, experiment_.name, discarded_, error};
    journal_.append(toJson(record, true));
    if (error.empty()) estimate_.learn(run, record.buildMs, record.renderMs);
    if (!error.empty() && events_.failed) events_.failed(run, error);
    return true;
  }

  /// The record of a run that has failed: what was requested.
  RunRecord asked(const PlannedRun& run) const {
    const ExperimentScene& scene = experiment_.scenes[run.scene];
    const ExperimentBuilder& row = experiment_.builders[run.builder];
    RunRecord record;
    record.sceneName = scene.name;
    record.sceneFile = scene.file;
    record.sceneGenerated = !scene.generator.empty();
    record.triangles = scene.triangles;
    record.device = device_;
    record.builder = row.source.name();
    if (!row.tracer.isAuto()) record.tracer = row.tracer.name();
    if (!row.source.isOwnTree()) record.parameters = withPreset(row.source.builder(), row.parameters);
    if (run.spp == 0) return record;
    RenderSettings settings = experiment_.settings;
    settings.spp = run.spp;
    record.image = ImageRecord{"", scene.views[run.view], measuredIntegrator().name, settings, 0};
    return record;
  }

  double left() const {
    double ms = 0;
    for (std::size_t i = next_; i < plan_.size(); ++i)
      if (!journal_.holds(plan_[i].key, plan_[i].repetition)) ms += estimate_.of(plan_[i]);
    return ms;
  }

  const Experiment& experiment_;
  const Device& device_;
  const std::vector<PlannedRun>& plan_;
  Journal& journal_;
  Runner& runner_;
  const LoopEvents& events_;
  Estimate estimate_;
  Watch watch_;
  std::size_t next_ = 0, loaded_ = none;
  std::string sceneError_;
  int discarded_ = 0;
};

}  // namespace

bool isSteady(const std::vector<double>& times, double within) {
  if (times.size() < 4) return false;
  const auto medianOfThree = [&](auto end) { return median(std::vector<double>(end - 3, end)); };
  const double last = medianOfThree(times.end()), before = medianOfThree(times.end() - 1);
  return std::abs(last - before) <= within * before;
}

bool runAll(const Experiment& experiment, const Device& device, const std::vector<PlannedRun>& plan, Journal& journal,
            Runner& runner, const LoopEvents& events) {
  return Loop(experiment, device, plan, journal, runner, events).all();
}

}  // namespace copse
